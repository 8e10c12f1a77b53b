#include "haptics_trial.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/base/parallel.h"
#include "calot/instruments/hook.h"
#include "calot/simulation/simulation.h"
#include "interrupt.h"

namespace calot::app {

namespace {

/// What is felt without --scene: 5 kPa fat, thick enough that its bed is not felt at 10 mm.
constexpr const char* kBlock = R"(
[scene]
name = "Block of fat"
[anatomy]
kind = "block"
[block]
size_mm = [36, 36, 28.8]
[[script.key]]
t = 0
offset_mm = [0, 0, 3]
)";

constexpr int kSimulationPriority = 60;   ///< below the servo's
constexpr double kPatience_s = 60.0;      ///< for somebody to take hold
constexpr double kOpenPatience_s = 10.0;  ///< for the device to open
constexpr double kPress_m = 14e-3;        ///< of the simulated hand; the hook starts 3 mm above the block

simulation::Setup make_setup(const HapticsOptions& options) {
    if (options.scene.empty()) return scene::build(scene::parse(kBlock, "the built-in block", "."));
    SceneChoice choice;
    choice.path = options.scene;
    return build_setup(load_scene(choice));
}

haptics::SessionOptions session_options(const HapticsOptions& options, const simulation::Setup& setup) {
    haptics::SessionOptions session;
    session.hook = setup.hook;
    session.tick_s = setup.model.tick_s;
    session.mapping.trocar_m = setup.script.trocar_m();
    session.mapping.scale = options.scale;
    // The device's up is the world's, so that pressing down presses into the block.
    session.mapping.device_to_world = haptics::device_to_world(Vec3(0.0, -1.0, 0.0), Vec3(0.0), Vec3(0.0, 0.0, 1.0));
    session.servo.gain = options.gain;
    session.threads = !options.virtual_clock;
    return session;
}

std::unique_ptr<haptics::HapticDevice> open_choice(const HapticsOptions& options) {
    haptics::DeviceChoice choice;
    choice.kind = options.device;
    choice.openhaptics_library = options.openhaptics_library;
    choice.network.address = options.network_address;
    choice.network.port = options.network_port;
    choice.script = haptics::press_and_release(kPress_m, options.seconds, options.cut);
    return haptics::make_device(choice);
}

/// The simulation with the hand on its hook.
class Bench {
  public:
    Bench(const HapticsOptions& options, HapticTrial& trial, std::shared_ptr<const simulation::Setup> setup)
        : trial_(trial),
          run_(setup),
          session_(open_choice(options), trial.options),
          ticks_(static_cast<std::size_t>(std::lround(options.seconds / setup->model.tick_s))) {
        input_ = setup->script.at(0.0);
        input_.mode = tissue::GeneratorMode::cut;
        input_.power_setting_W = 60.0;
        trial_.rows.reserve(ticks_);
    }

    /// One tick; kept from when the hand takes hold on.
    void tick() {
        input_.pedal = false;
        held_ = session_.drive(input_);
        run_.tick(input_);
        session_.feel(run_.figures());
        if (trial_.rows.empty() && !held_) return;
        if (trial_.rows.size() >= ticks_) return;
        session_.servo_state(servo_);
        HapticRow row;
        row.time_s = static_cast<double>(trial_.rows.size()) * run_.model().tick_s;
        row.tip_m = input_.hook.position_m;
        row.tissue_N = run_.figures().hook_force_N;
        row.device_N = servo_.device_force_N;
        row.absorbed_J = servo_.absorbed_J;
        row.fault = servo_.fault;
        row.pedal = input_.pedal;
        trial_.rows.push_back(row);
        kept_.store(trial_.rows.size(), std::memory_order_release);
    }
    std::size_t kept() const { return kept_.load(std::memory_order_acquire); }
    std::size_t wanted() const { return ticks_; }
    haptics::Session& session() { return session_; }

  private:
    HapticTrial& trial_;
    simulation::Simulation run_;
    haptics::Session session_;
    tissue::Input input_;
    haptics::ServoState servo_;
    std::size_t ticks_;
    std::atomic<std::size_t> kept_{0};
    bool held_ = false;
};

void run_virtually(Bench& bench, const HapticTrial& trial) {
    haptics::Session& session = bench.session();
    session.keep();
    for (double now_s = 1.0; bench.kept() < bench.wanted() && !interrupted(); now_s += trial.options.tick_s) {
        session.servo_step(now_s);
        bench.tick();
    }
}

/// Until the trial is complete. Says what it waits for.
void watch(Bench& bench, const HapticsOptions& options) {
    double waited_s = 0.0;
    bool told = false;
    while (bench.kept() < bench.wanted() && !interrupted()) {
        constexpr double kLook_s = 0.02;
        std::this_thread::sleep_for(std::chrono::duration<double>(kLook_s));
        if (bench.kept() > 0) continue;
        waited_s += kLook_s;
        const haptics::SessionStatus status = bench.session().status();
        if (!status.open && !status.note.empty() && waited_s > 1.0 && options.device != "network")
            throw InputError(fmt::format("the {} device cannot be used: {}", status.device.name, status.note),
                             "`calot haptics --list` shows what there is");
        if ((!status.open && waited_s > kOpenPatience_s) || waited_s > kPatience_s)
            throw InputError(
                fmt::format("nobody took hold of the device within {:.0f} s: {}", waited_s,
                            status.note.empty() ? haptics::describe(status.servo.fault) : status.note.c_str()),
                "start the device's program, or move the stylus");
        if (!told && status.open && waited_s > 0.5) {
            fmt::print(stderr, "calot: waiting for a hand: {}\n", status.device.model);
            told = true;
        }
    }
}

Timing timing(const haptics::Spread& spread) {
    return {spread.count(), spread.mean_s(), spread.quantile_s(0.5), spread.quantile_s(0.99), spread.most_s()};
}

void run_in_real_time(Bench& bench, const HapticsOptions& options, HapticTrial& trial) {
    haptics::Spread periods;
    haptics::PeriodicThread simulation;
    std::string note;
    double last_s = 0.0;
    bench.session().start();
    simulation.start(
        trial.options.tick_s, kSimulationPriority,
        [&](double now_s) {
            if (last_s > 0.0) periods.add(now_s - last_s);
            last_s = now_s;
            bench.tick();
        },
        [&](const std::string& answer) { note = answer; });
    watch(bench, options);
    simulation.stop();
    trial.status = bench.session().status();
    bench.session().stop();
    trial.period = timing(bench.session().period());
    trial.latency = timing(bench.session().latency());
    trial.tick = timing(periods);
    if (!note.empty()) trial.notes.push_back(note);
}

}  // namespace

bool HapticTrial::passive() const {
    return status.servo.least_absorbed_J >= -options.servo.passivity.start_J;
}

HapticTrial run_trial(const HapticsOptions& options) {
    if (options.virtual_clock && options.device != "simulated")
        throw InputError("--virtual needs the simulated device: other hands live in real time",
                         "add --device simulated, or leave --virtual out");
    catch_interrupts();
    // One thread computes: a tick must not wait for another core, on which the servo may be about to wake up.
    const ThreadLimit limit(1);
    HapticTrial trial;
    trial.virtual_clock = options.virtual_clock;
    const auto setup = std::make_shared<const simulation::Setup>(make_setup(options));
    trial.scene = setup->name;
    trial.options = session_options(options, *setup);
    Bench bench(options, trial, setup);
    if (options.virtual_clock) {
        run_virtually(bench, trial);
        trial.status = bench.session().status();
    } else {
        run_in_real_time(bench, options, trial);
    }
    trial.interrupted = interrupted();
    return trial;
}

std::vector<DepthPoint> force_against_depth(const HapticTrial& trial) {
    constexpr double kTouch_N = 1e-3;   // less is friction of nothing
    constexpr double kStill_m = 20e-6;  // within the window: neither pressing nor releasing
    constexpr std::ptrdiff_t kWindow = 25;
    const auto& rows = trial.rows;
    const auto touched = std::find_if(rows.begin(), rows.end(),
                                      [](const HapticRow& row) { return glm::length(row.tissue_N) > kTouch_N; });
    std::vector<DepthPoint> points;
    bool pressing = true;
    for (auto row = touched; row != rows.end(); ++row) {
        const auto before = row - std::min(kWindow, row - rows.begin());
        const auto after = row + std::min(kWindow, rows.end() - row - 1);
        const double down_m = before->tip_m.z - after->tip_m.z;
        if (std::abs(down_m) > kStill_m) pressing = down_m > 0.0;
        points.push_back({touched->tip_m.z - row->tip_m.z, glm::length(row->tissue_N), pressing});
    }
    return points;
}

}  // namespace calot::app
