#pragma once
// The trainer's window: its screens, the session that runs behind them, and the loop that draws both.

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calot/viewer/language.h"
#include "calot/viewer/lens.h"
#include "calot/viewer/loader.h"
#include "calot/viewer/replay.h"
#include "calot/window/backdrop.h"
#include "calot/window/glfw_window.h"
#include "calot/window/gui.h"
#include "calot/window/hud.h"
#include "calot/window/picture_thread.h"
#include "calot/window/questionnaire_screen.h"
#include "calot/window/rewind_screen.h"
#include "calot/window/screens.h"
#include "calot/window/settings.h"
#include "calot/window/sound.h"
#include "calot/window/start_screen.h"
#include "calot/window/trainer.h"

namespace calot::window {

enum class Screen { start, loading, practice, paused, debrief, questions, opening, rewind, trouble };

class Trainer {
  public:
    explicit Trainer(const TrainerOptions& options);
    void run();

  private:
    void turn();
    void draw_window();
    void obey_commands();
    void load(int exercise);
    void finish_loading();
    void practise(double dt_s);
    void begin_practice();
    void end_session();
    void ask_for_picture();
    void draw_picture(int width, int height);
    void play_sound();
    void draw_screens();
    void draw_practice();
    void draw_start_screen();
    void draw_rewind_screen();
    void draw_questions();
    void look_about();
    void obey_timeline_keys();
    void take_marks();
    int picture_height(int height) const;
    void handle(PauseChoice choice);
    void handle(DebriefChoice choice);
    void handle(RewindChoice choice);
    void open_rewind(const viewer::Past& past, Screen back, double from_end_s);
    void close_rewind();
    void rewind(double dt_s);
    void take_over();
    void apply_settings();
    void take_picture(int width, int height);
    bool counting_down() const { return now_s_ < hands_free_s_; }
    bool has_pause() const { return screen_ == Screen::practice || screen_ == Screen::paused; }
    PictureFigures figures();
    HapticsFigures haptics_figures();

    TrainerOptions options_;
    std::string data_;
    std::string settings_path_;
    Settings settings_;
    viewer::Language text_;
    std::vector<std::string> languages_;
    GlfwWindow window_;
    Gui gui_;
    Backdrop backdrop_;
    PictureThread pictures_;
    Sound sound_;

    Screen screen_ = Screen::start;
    bool help_ = false, settings_open_ = false, quit_ = false, settings_changed_ = false, picture_wanted_ = false;
    int exercise_ = 0, pictures_taken_ = 0;
    StartSelection selection_;
    std::string trouble_;
    std::unique_ptr<viewer::Loader> loader_;
    double loading_since_s_ = 0.0;
    viewer::Loader::Step loading_step_ = viewer::Loader::Step::scene;
    std::shared_ptr<viewer::Attempt> attempt_;
    std::unique_ptr<viewer::Session> session_;
    std::optional<viewer::Mapping> mapping_;
    std::optional<viewer::Scope> scope_;
    std::shared_ptr<const simulation::Setup> setup_;  ///< of the last session
    viewer::LensState lens_;
    PictureWish wished_;
    viewer::Debrief debrief_;
    Answers answers_;
    std::shared_ptr<haptics::Session> device_;
    viewer::RateMeter device_rate_;
    std::int64_t device_steps_ = 0;

    // Rewinding.
    std::unique_ptr<viewer::Replay> replay_;
    viewer::Past past_;
    std::future<std::vector<viewer::Mark>> marks_;  ///< being found
    RewindState rewind_;
    Screen rewind_back_ = Screen::debrief;
    double rewind_from_end_s_ = 0.0;
    bool resumed_ = false;       ///< the session being loaded goes on from a moment
    double hands_free_s_ = 0.0;  ///< when the hands move again after a rewind

    double now_s_ = viewer::steady_s(), last_s_ = now_s_, drawn_s_ = 0.0;
    viewer::RateMeter picture_rate_;
    double latency_s_ = 0.0;
    std::int64_t answered_ = 0;
    bool focused_ = true;
    struct Seen {
        Screen screen = Screen::start;
        bool help = false, settings = false;
        bool operator==(const Seen& other) const = default;
    };
    std::optional<Seen> seen_;  ///< what the last frame showed
};

}  // namespace calot::window
