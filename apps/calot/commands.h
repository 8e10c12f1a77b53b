#pragma once
// What the program can do: one function a command, each returns the exit code.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calot/scene/scene.h"

namespace calot::app {

enum class FrameKind { none, png, video };
enum class ProgressKind { automatic, plain, none };

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kBadInput = 2;
inline constexpr int kInterrupted = 130;

/// A scene file with what the command line changes about it.
struct SceneChoice {
    std::string path;
    std::optional<double> duration_s;
    std::optional<std::uint64_t> seed;
    std::vector<std::string> assignments;  ///< key.path=value
};

/// Throws InputError.
scene::Scene load_scene(const SceneChoice& choice);

/// scene::build; tells on the standard error what was mended in meshes, and draws where a refused one is at fault.
simulation::Setup build_setup(const scene::Scene& scene);

struct OutputChoice {
    std::string directory;  ///< empty: none
    FrameKind frames = FrameKind::png;
    double export_every_s = 1.0;  ///< 0: no surfaces
    bool force = false;
    ProgressKind progress = ProgressKind::automatic;
    int threads = 0;  ///< 0: all cores
};

struct SimulateOptions {
    SceneChoice scene;
    OutputChoice output;
};
int simulate(const SimulateOptions& options);

struct InspectOptions {
    SceneChoice scene;
    bool json = false;
};
int inspect(const InspectOptions& options);

struct MaterialsOptions {
    std::string name;  ///< empty: all
    bool json = false;
};
/// Prints tissues with units, ranges and sources.
int materials(const MaterialsOptions& options);

struct ReplayOptions {
    std::string recording;
    bool verify = false;
    OutputChoice output;
};
int replay(const ReplayOptions& options);

struct ViewOptions {
    SceneChoice scene;     ///< path empty: the standard patient
    std::string start;     ///< exercise to begin with at once
    std::string language;  ///< empty: as in the settings
    std::string pictures = ".";
    int width = 1280, height = 800;
    bool fullscreen = false;
    int threads = 0;  ///< for the physics; 0: as fits the machine
};
int view(const ViewOptions& options);

struct BenchOptions {
    std::vector<std::string> suites;  ///< empty: all
    std::string json, html;           ///< files to write; both empty: into out/bench/
    std::string compare;              ///< an earlier JSON file
    int threads = 0;                  ///< 0: all cores
    double seconds = 0.0;             ///< simulated, of each scene; 0: 30 s, quick 1.8 s
    bool quick = false;
    bool real_time = false;
    ProgressKind progress = ProgressKind::automatic;
};
int bench(const BenchOptions& options);

struct ValidateOptions {
    std::string suite;                ///< empty: all
    std::string json, report;         ///< file and directory to write, empty: none
    std::string scenes;               ///< of the experiments, empty: looked for
    std::vector<std::string> spoil;   ///< NAME=FACTOR
    bool quick = false, force = false;
    ProgressKind progress = ProgressKind::automatic;
    int threads = 0;  ///< 0: all cores
};
int validate(const ValidateOptions& options);

}  // namespace calot::app
