// The program's command line.

#include <cstdio>
#include <exception>
#include <new>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "calot/base/error.h"
#include "calot/validation/case.h"
#include "commands.h"
#include "training_commands.h"

namespace calot::app {
namespace {

constexpr const char* kExamples = R"(
Examples:
  calot simulate scenes/calot.toml                      dissect the standard patient into out/calot/
  calot simulate scenes/calot.toml --seed 7 --out p7    another patient
  calot simulate scenes/block.toml --duration 1 --frames none
  calot simulate scenes/block.toml --set electric.voltage_limit_V=200 --set materials.fat.youngs_modulus_kPa=8
  calot inspect scenes/calot.toml                       what the scene is made of
  calot inspect --devices                               GPUs that there are
  calot view                                            operate on the standard patient, in a window
  calot replay out/calot/recording.calot --verify       run it again and compare bit for bit
  calot bench --suite kernels                           how fast each part is on this machine
  calot haptics --list                                  haptic devices that there are
  calot validate --report out/validation                compare with closed forms and experiments
  calot scene --defaults                                every key that a scene may have

Exit codes: 0 done, 2 bad input or usage, 130 interrupted, 1 anything else.)";

/// CLI::Range lets nan through.
CLI::Validator seconds_between(double low, double high) {
    return CLI::Validator(
        [=](const std::string& text) {
            double value = 0.0;
            if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
            return fmt::format("'{}' is no number of seconds from {:g} to {:g}", text, low, high);
        },
        "");
}

/// An option that is one of several words; `values` are in the order of `words`.
template <class T>
void add_word(CLI::App& command, const char* option, T& target, const std::vector<std::string>& words,
              const std::vector<T>& values, const char* help) {
    command
        .add_option_function<std::string>(
            option,
            [&target, words, values](const std::string& word) {
                for (std::size_t k = 0; k < words.size(); ++k)
                    if (words[k] == word) target = values[k];
            },
            help)
        ->type_name("KIND ")
        ->check(CLI::IsMember(words));
}

void add_scene_options(CLI::App& command, SceneChoice& choice) {
    command.add_option("scene", choice.path, "Scene file (TOML)")->required()->type_name("SCENE");
    command.add_option("--duration", choice.duration_s, "Simulated time, instead of the scene's run.duration_s")
        ->type_name("SECONDS")
        ->check(seconds_between(0.001, 3600.0));
    command.add_option("--seed", choice.seed, "Another patient, instead of the scene's anatomy.seed")
        ->type_name("N")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{9'000'000'000'000'000'000}));
    command.add_option("--set", choice.assignments, "Change a value of the scene; may be repeated")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
}

void add_output_options(CLI::App& command, OutputChoice& output) {
    const auto not_empty = [](const std::string& text) {
        return text.empty() ? std::string("'' cannot be an output directory") : std::string();
    };
    command.add_option("--out", output.directory, "Where to write")->type_name("DIR")->check(not_empty);
    add_word<FrameKind>(command, "--frames", output.frames, {"none", "png", "video"},
                        {FrameKind::none, FrameKind::png, FrameKind::video},
                        "Pictures: none, png (stills), video (stills and an MP4)");
    command.add_option("--export-every", output.export_every_s, "Write the surface (VTK) so often; 0: never")
        ->type_name("SECONDS")
        ->check(seconds_between(0.0, 3600.0));
    add_word<ProgressKind>(command, "--progress", output.progress, {"auto", "plain", "none"},
                           {ProgressKind::automatic, ProgressKind::plain, ProgressKind::none},
                           "auto (a bar on a terminal, lines otherwise), plain or none");
    command
        .add_option("--threads", output.threads, "Threads to compute with; 0: all cores. Results do not depend on it")
        ->type_name("N")
        ->check(CLI::Range(0, 1024));
    command.add_flag("--force", output.force,
                     "Replace the output directory if it exists, once the new one is complete");
}

void add_backend_options(CLI::App& command, gpu::BackendWish& wish) {
    add_word<gpu::BackendKind>(command, "--backend", wish.kind, {"cpu", "gpu", "auto"},
                               {gpu::BackendKind::cpu, gpu::BackendKind::gpu, gpu::BackendKind::automatic},
                               "Who computes: cpu (unless said), gpu, or auto, which says what it took and why (docs/gpu.md)");
    command.add_option("--device", wish.device, "Which GPU, as `calot inspect --devices` counts them")
        ->type_name("N")
        ->check(CLI::Range(0, 1024));
}

void add_view_options(CLI::App& command, ViewOptions& options) {
    add_scene_options(command, options.scene);
    command.get_option("scene")->required(false);
    command.add_option("--start", options.start, "Begin with this exercise instead of the start screen")
        ->type_name("ID");
    command.add_option("--language", options.language, "Language of the texts, as in data/lang")->type_name("NAME");
    command.add_option("--pictures", options.pictures, "Where F12 puts pictures of the window")->type_name("DIR");
    command.add_option("--width", options.width, "Of the window, pixels")
        ->type_name("N")
        ->check(CLI::Range(640, 16384));
    command.add_option("--height", options.height, "Of the window, pixels")
        ->type_name("N")
        ->check(CLI::Range(420, 16384));
    command.add_flag("--fullscreen", options.fullscreen, "Over the whole screen");
    command.add_option("--threads", options.threads, "Threads for the physics; 0: as fits the machine")
        ->type_name("N")
        ->check(CLI::Range(0, 1024));
    command.add_option("--trainee", options.trainee, "Label of who trains; any text, no name needed")->type_name("LABEL");
    command.add_option("--data", options.data, "Where sessions are kept; otherwise $XDG_DATA_HOME/calot")->type_name("DIR");
    command
        .add_option("--haptics", options.haptics,
                    "Haptic device for the right hand: auto, openhaptics, simulated or network (docs/haptics.md)")
        ->type_name("DEVICE ")
        ->check(CLI::IsMember({"auto", "openhaptics", "simulated", "network"}));
    command.add_option("--haptics-gain", options.haptics_gain, "Force on the hand over the true one")
        ->check(CLI::Range(0.0, 100.0));
    add_backend_options(command, options.backend);
    command.footer("\nWithout SCENE it opens the standard patient. F1 in the window shows the controls.");
}

void add_bench_options(CLI::App& command, BenchOptions& options) {
    command.add_option("--suite", options.suites, "Only these: paper, kernels, tick, scale, surface; may be repeated")
        ->type_name("SUITE")
        ->check(CLI::IsMember({"paper", "kernels", "tick", "scale", "surface"}));
    command.add_option("--json", options.json, "Write the figures there")->type_name("FILE");
    command.add_option("--html", options.html, "Write a page with plots there")->type_name("FILE");
    command
        .add_option("--compare", options.compare, "Say what moved against an earlier --json FILE, and how sure it is")
        ->type_name("FILE");
    command.add_option("--threads", options.threads, "The most threads to use; 0: all cores")
        ->type_name("N")
        ->check(CLI::Range(0, 1024));
    command.add_option("--seconds", options.seconds, "Simulated time of each scene")
        ->type_name("S")
        ->check(seconds_between(0.1, 3600.0));
    command
        .add_option("--passes", options.passes,
                    "Run each scene so often: what a tick takes at least is the program's, the rest the machine's")
        ->type_name("N")
        ->check(CLI::Range(1, 100));
    command.add_flag("--quick", options.quick, "A short look: fewer sizes, fewer repetitions");
    command.add_flag("--real-time", options.real_time,
                     "Ask for a real-time scheduling policy and lock memory, as a program with a haptic device does");
    add_word<ProgressKind>(command, "--progress", options.progress, {"auto", "plain", "none"},
                           {ProgressKind::automatic, ProgressKind::plain, ProgressKind::none},
                           "auto (a bar on a terminal, lines otherwise), plain or none");
    add_backend_options(command, options.backend);
    command.footer(
        "\nWithout --json and --html it writes out/bench/bench.json and out/bench/bench.html.\n"
        "What the figures mean: docs/performance.md.");
}

void add_haptics_options(CLI::App& command, HapticsOptions& options) {
    command.add_flag("--list", options.list, "Say which devices there are, and stop");
    command.add_option("--device", options.device, "auto, openhaptics, simulated or network")
        ->type_name("KIND ")
        ->check(CLI::IsMember({"auto", "openhaptics", "simulated", "network"}));
    command.add_option("--seconds", options.seconds, "How long the hand feels")
        ->type_name("SECONDS")
        ->check(seconds_between(0.1, 3600.0));
    command.add_option("--scene", options.scene, "What it feels, instead of a block of fat")->type_name("SCENE");
    command.add_option("--gain", options.gain, "Force on the hand over the true one")->check(CLI::Range(0.0, 100.0));
    command.add_option("--scale", options.scale, "Movement of the instrument over the hand's")
        ->check(CLI::Range(0.05, 20.0));
    command.add_flag("--cut", options.cut, "The simulated hand presses the pedal while it holds");
    command.add_flag("--virtual", options.virtual_clock,
                     "The simulated hand on a virtual clock: the same figures every time, nothing said of timing");
    command.add_option("--json", options.json, "Write the figures as JSON")->type_name("FILE");
    command.add_option("--report", options.report, "Write a page, a plot and every millisecond")->type_name("DIR");
    command.add_flag("--force", options.force, "Replace the report's directory if it exists");
    command.add_option("--network-address", options.network_address, "Where the network device listens")
        ->type_name("IPV4");
    command.add_option("--network-port", options.network_port, "and on which UDP port")->check(CLI::Range(1, 65535));
    command.add_option("--openhaptics-library", options.openhaptics_library, "libHD.so, if it is not found by itself")
        ->type_name("FILE");
}

void add_validate_options(CLI::App& command, ValidateOptions& options) {
    command.add_option("--suite", options.suite, "Only this part")
        ->type_name("NAME ")
        ->check(CLI::IsMember(validation::suites()));
    command.add_flag("--quick", options.quick, "The short form: coarser, without the experiments");
    command.add_option("--json", options.json, "Write all cases there")->type_name("FILE");
    command.add_option("--report", options.report, "Write a page with plots (report.html) there")->type_name("DIR");
    command.add_flag("--force", options.force, "Replace an earlier report");
    command.add_option("--scenes", options.scenes, "Folder of the experiments' scenes")->type_name("DIR");
    command
        .add_option("--spoil", options.spoil,
                    "Multiply a parameter of the simulation, not of what it is compared with: cases must then fail")
        ->type_name("NAME=FACTOR")
        ->allow_extra_args(false);
    add_word<ProgressKind>(command, "--progress", options.progress, {"auto", "plain", "none"},
                           {ProgressKind::automatic, ProgressKind::plain, ProgressKind::none},
                           "auto (on a terminal), plain (lines) or none");
    command.add_option("--threads", options.threads, "Threads to compute with; 0: all cores")
        ->type_name("N")
        ->check(CLI::Range(0, 1024));
    command.footer("\nExit code 1 when a check fails; values outside published bands fail nothing.\n");
}

int run(int argc, char** argv) {
    CLI::App app("Calot simulates electrosurgery on soft tissue in real time.", "calot");
    app.footer(kExamples);
    app.require_subcommand(1);
    int code = kDone;

    SimulateOptions simulate_options;
    CLI::App* simulate_command = app.add_subcommand("simulate", "Run a scene and write what happened");
    add_scene_options(*simulate_command, simulate_options.scene);
    add_output_options(*simulate_command, simulate_options.output);
    add_backend_options(*simulate_command, simulate_options.backend);
    simulate_command->footer(
        std::string(
            "\nWithout --out it writes to out/NAME, NAME being that of the scene file: summary.json, timeline.csv,\n"
            "report.html, recording.calot, surface/*.vtp with surface.pvd (ParaView), frames/*.png, "
            "dissection.mp4.\n") +
        kExamples);
    simulate_command->add_option("--task", simulate_options.task, "Score the run against a task (`calot tasks`)")
        ->type_name("TASK");
    CLI::Option* session = simulate_command->add_flag("--session", simulate_options.session,
                                                      "Store the run as a session (`calot sessions`), with a debrief");
    session->excludes("--out");
    simulate_command->add_option("--trainee", simulate_options.trainee, "Label of who did it; any text, no name needed")
        ->type_name("LABEL")
        ->needs(session);
    simulate_command->add_option("--data", simulate_options.data, "Where sessions are kept")
        ->type_name("DIR")
        ->needs(session);
    simulate_command->callback([&] { code = simulate(simulate_options); });

    InspectOptions inspect_options;
    CLI::App* inspect_command = app.add_subcommand("inspect", "Say what a scene is made of, without running it");
    add_scene_options(*inspect_command, inspect_options.scene);
    inspect_command->add_flag("--json", inspect_options.json, "As JSON");
    inspect_command->get_option("scene")->required(false);
    inspect_command
        ->add_flag("--devices", inspect_options.devices, "List what --backend gpu could compute on, instead of a scene")
        ->excludes("scene");
    inspect_command->callback([&] { code = inspect(inspect_options); });

    MaterialsOptions materials_options;
    CLI::App* materials_command =
        app.add_subcommand("materials", "Print what tissues are made of, with units, ranges and sources");
    materials_command->add_option("name", materials_options.name, "One tissue; all without")->type_name("NAME");
    materials_command->add_flag("--json", materials_options.json, "As JSON");
    materials_command->callback([&] { code = materials(materials_options); });

    ReplayOptions replay_options;
    CLI::App* replay_command = app.add_subcommand("replay", "Run a recording again");
    replay_command->add_option("recording", replay_options.recording, "recording.calot of a run")
        ->required()
        ->type_name("RECORDING");
    replay_command
        ->add_option("--from", replay_options.from_s, "Begin at this moment, from the checkpoint before it if there is one")
        ->type_name("SECONDS")
        ->check(CLI::NonNegativeNumber);
    CLI::Option* verify = replay_command->add_flag("--verify", replay_options.verify,
                             "Compare the state with the recording every second; exit code 1 at the first difference");
    add_output_options(*replay_command, replay_options.output);
    add_backend_options(*replay_command, replay_options.backend);
    replay_command->get_option("--backend")->excludes(verify);  // another backend rounds otherwise
    replay_command->footer(std::string("\nWithout --out nothing is written.\n") + kExamples);
    replay_command->callback([&] { code = replay(replay_options); });

    ViewOptions view_options;
    CLI::App* view_command = app.add_subcommand("view", "Open the trainer: operate in a window");
    add_view_options(*view_command, view_options);
    view_command->callback([&] { code = view(view_options); });

    BenchOptions bench_options;
    CLI::App* bench_command = app.add_subcommand("bench", "Measure speed, and compare it with an earlier run");
    add_bench_options(*bench_command, bench_options);
    bench_command->callback([&] { code = bench(bench_options); });
    ValidateOptions validate_options;
    CLI::App* validate_command =
        app.add_subcommand("validate", "Compare with closed forms, references, trends and published measurements");
    add_validate_options(*validate_command, validate_options);
    validate_command->callback([&] { code = validate(validate_options); });

    TrainingCommands training;
    training.add_to(app, code);

    HapticsOptions haptics_options;
    CLI::App* haptics_command =
        app.add_subcommand("haptics", "Try a haptic device: rate, jitter, latency, passivity, force against depth");
    add_haptics_options(*haptics_command, haptics_options);
    haptics_command->footer(
        "\nExamples:\n"
        "  calot haptics --list\n"
        "  calot haptics --report out/touch                  press into fat with the device that there is\n"
        "  calot haptics --device simulated --report out/hand  the same without any hardware\n"
        "\nExit code 1 when the device got energy that it should not have (docs/haptics.md).");
    haptics_command->callback([&] { code = try_haptics(haptics_options); });

    bool defaults = false;
    CLI::App* scene_command = app.add_subcommand("scene", "About scene files");
    scene_command
        ->add_flag("--defaults", defaults, "Print a scene with every key, its default, unit, range and meaning")
        ->required();
    scene_command->callback([&] { fmt::print("{}", scene::defaults_text()); });

    CLI::App* version_command = app.add_subcommand("version", "Print the version");
    version_command->callback([&] { fmt::print("calot {}\n", CALOT_VERSION); });
    app.set_version_flag("--version", "calot " CALOT_VERSION);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
        fmt::print(stderr, "calot: {}\n  hint: `calot --help` and `calot COMMAND --help` show what there is\n",
                   error.what());
        return kBadInput;
    }
    return code;
}

}  // namespace
}  // namespace calot::app

int main(int argc, char** argv) {
    using namespace calot;
    try {
        const int code = app::run(argc, argv);
        if (std::fflush(stdout) != 0) throw std::runtime_error("cannot write to the standard output");
        return code;
    } catch (const InputError& error) {
        fmt::print(stderr, "calot: {}\n", error.describe());
        return app::kBadInput;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "calot: there is not enough memory\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "calot: {}\n", error.what());
    }
    return app::kFailed;
}
