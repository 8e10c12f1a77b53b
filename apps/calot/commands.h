#pragma once
// What the program can do: one function a command, each returns the exit code.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calot/gpu/choose.h"
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

/// Simulations of this setup run where it is wished; says so on the standard error unless nothing was wished. Throws
/// InputError.
void use_backend(const gpu::BackendWish& wish, simulation::Setup& setup);

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
    std::string task;      ///< empty: not scored
    bool session = false;  ///< stored as a session instead of written to a directory
    std::string trainee, data;
    gpu::BackendWish backend;
};
int simulate(const SimulateOptions& options);

struct InspectOptions {
    SceneChoice scene;
    bool json = false;
    bool devices = false;  ///< list these instead
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
    double from_s = 0.0;  ///< begin there, from the checkpoint before
    OutputChoice output;
    gpu::BackendWish backend;
};
int replay(const ReplayOptions& options);

struct ViewOptions {
    SceneChoice scene;     ///< path empty: the standard patient
    std::string start;     ///< exercise to begin with at once
    std::string language;  ///< empty: as in the settings
    std::string pictures = ".";
    int width = 1280, height = 800;
    bool fullscreen = false;
    int threads = 0;            ///< for the physics; 0: as fits the machine
    std::string data, trainee;  ///< of the sessions, see SessionOptions
    std::string haptics;        ///< haptic device for the right hand; empty: none
    double haptics_gain = 1.0;  ///< of its force
    gpu::BackendWish backend;
};
int view(const ViewOptions& options);

struct BenchOptions {
    std::vector<std::string> suites;  ///< empty: all
    std::string json, html;           ///< files to write; both empty: into out/bench/
    std::string compare;              ///< an earlier JSON file
    int threads = 0;                  ///< 0: all cores
    double seconds = 0.0;             ///< simulated, of each scene; 0: 30 s, quick 1.8 s
    int passes = 0;                   ///< over each scene; 0: 3, quick 1
    bool quick = false;
    bool real_time = false;
    ProgressKind progress = ProgressKind::automatic;
    gpu::BackendWish backend;
};
int bench(const BenchOptions& options);

struct ScoreOptions {
    std::string recording;
    std::string task;  ///< empty: the one that lies beside the recording
    bool json = false;
    int threads = 0;
};
int score(const ScoreOptions& options);

/// A stored session of the scene's script, or one that continues another.
struct SessionOptions {
    SceneChoice scene;
    std::string task;     ///< empty: free practice, or that of the session continued
    std::string trainee;  ///< a label
    std::string data;     ///< folder of the store; empty: the user's
    std::optional<std::int64_t> continues;
    double from_s = 0.0;
    int frames = 60;           ///< of the debrief; -1: no debrief
    gpu::BackendWish backend;  ///< of a session that starts anew
    int threads = 0;
    ProgressKind progress = ProgressKind::automatic;
};
int session(const SessionOptions& options);

struct SessionsOptions {
    std::string data, trainee, task;
};
int sessions(const SessionsOptions& options);

struct DebriefOptions {
    std::string subject;  ///< number of a session, or a recording
    std::string data, task, out;
    int frames = 100;
    ProgressKind progress = ProgressKind::automatic;
};
int debrief(const DebriefOptions& options);

struct QuestionnaireOptions {
    std::int64_t session = -1;  ///< -1: print the questions
    std::string answers;        ///< empty: ask
    std::string remark, data;
};
int questionnaire(const QuestionnaireOptions& options);

struct StudyOptions {
    std::string data, trainee, task;
    std::string csv, html;  ///< files to write
};
int study(const StudyOptions& options);

struct TasksOptions {
    bool metrics = false;
};
int tasks(const TasksOptions& options);

struct HapticsOptions {
    bool list = false;
    std::string device = "auto";
    double seconds = 4.0;
    std::string scene;  ///< empty: a block of fat
    double gain = 1.0;
    double scale = 1.0;
    bool cut = false;            ///< the simulated hand presses the pedal as well
    bool virtual_clock = false;  ///< as fast as it goes
    std::string json, report;    ///< files to write, empty: none
    bool force = false;
    std::string network_address = "127.0.0.1";
    int network_port = 5460;
    std::string openhaptics_library;
};
int try_haptics(const HapticsOptions& options);

struct ValidateOptions {
    std::string suite;               ///< empty: all
    std::string json, report;        ///< file and directory to write, empty: none
    std::string scenes;              ///< of the experiments, empty: looked for
    std::vector<std::string> spoil;  ///< NAME=FACTOR
    bool quick = false, force = false;
    ProgressKind progress = ProgressKind::automatic;
    int threads = 0;  ///< 0: all cores
};
int validate(const ValidateOptions& options);

}  // namespace calot::app
