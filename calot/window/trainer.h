#pragma once
// `calot view`: the trainer. Screens, the running session, and the loop that draws both.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calot/haptics/session.h"
#include "calot/scene/scene.h"
#include "calot/viewer/exercise.h"

namespace calot::window {

/// What a session starts from, besides the exercise.
struct SceneWish {
    std::string scene;                     ///< file name of an exercise's own scene; empty: the command line's
    std::vector<std::string> assignments;  ///< values that exercise and patient change
    bool any_patient = true;               ///< `seed` counts
    std::uint64_t seed = 1;
};

struct TrainerOptions {
    /// Called in a thread; throws InputError.
    std::function<scene::Scene(const SceneWish&)> make_scene;
    std::function<void(simulation::Setup&)> prepare;  ///< what a session is set up from, before it is; may be empty
    std::vector<viewer::Exercise> exercises;
    std::optional<viewer::CutOff> cut_off;  ///< offered at the start
    /// A haptic device for a session's right hand; empty: none. Throws InputError.
    std::function<std::shared_ptr<haptics::Session>(const simulation::Setup&)> make_device;
    std::string start;           ///< id of an exercise to start at once; empty: the start screen
    std::string language;        ///< instead of the settings' one; empty: theirs
    std::string pictures = ".";  ///< directory that F12 puts pictures into
    int width = 1280, height = 800;
    bool fullscreen = false;
    bool patients = true;  ///< the scene is a patient that can be another
};

/// Runs until the window is closed. Throws std::runtime_error when there is no window to be had, InputError when data
/// files are missing or wrong.
void run_trainer(const TrainerOptions& options);

}  // namespace calot::window
