// A long session, with all that goes along: hands, physics in its thread, snapshots, recording, checkpoints, measuring.
// Memory stays what it was. A few seconds by default; CALOT_SOAK_S=1800 makes it half an hour, CALOT_SOAK_SCENE=PATH
// takes a whole scene instead of the small one:
//
//     CALOT_SOAK_S=1800 CALOT_SOAK_SCENE=scenes/calot.toml build/release/bin/test_viewer --gtest_filter='Soak.*'

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "calot/base/parallel.h"
#include "calot/training/session.h"
#include "calot/viewer/mapping.h"
#include "calot/viewer/session.h"
#include "viewer/small_scene.h"

namespace calot::viewer {
namespace {

double environment(const char* name, double otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::atof(text) : otherwise;
}

double resident_MB() {
    std::ifstream file("/proc/self/statm");
    double pages = 0.0, resident = 0.0;
    file >> pages >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

class Recording : public Observer {
  public:
    explicit Recording(training::Store& store) : store_(store) {}
    void begin(const simulation::Simulation& run) override {
        live_.emplace(store_, training::SessionStart{std::nullopt, "soak", "test"}, run);
    }
    void after_tick(const simulation::Simulation& run, const tissue::Input& input) override {
        live_->after_tick(run, input);
    }
    void end(const simulation::Simulation& run) override { row_ = live_->finish(run); }
    const training::SessionRow& row() const { return row_; }

  private:
    training::Store& store_;
    std::optional<training::LiveSession> live_;
    training::SessionRow row_;
};

std::unique_ptr<simulation::Simulation> make_run() {
    const char* path = std::getenv("CALOT_SOAK_SCENE");
    if (path == nullptr) return test::small_run();
    return std::make_unique<simulation::Simulation>(
        std::make_shared<const simulation::Setup>(scene::build(scene::load(path))));
}

TEST(Soak, memory_stays_flat_at_a_thousand_ticks_a_second) {
    const double wall_s = environment("CALOT_SOAK_S", 6.0);
    // As the trainer does on a small machine: others' threads would keep the physics waiting.
    const ThreadLimit limit(1);
    const auto folder = std::filesystem::temp_directory_path() / ("calot_soak." + std::to_string(::getpid()));
    training::Store store(folder.string());
    auto recording = std::make_shared<Recording>(store);
    Session session(make_run(), {.observers = {recording}});
    Mapping mapping(session.theatre());
    Scope scope(session.setup().camera);
    session.start();

    // A hand that wanders over the field, goes down, burns in bursts, draws back; suction now and then.
    const double begun_s = steady_s(), warm_s = begun_s + 0.3 * wall_s;
    double last_s = begun_s, settled_MB = 0.0, told_s = begun_s;
    while (last_s - begun_s < wall_s) {
        const double now_s = steady_s(), t = now_s - begun_s;
        Devices devices;
        devices.mouse_right = 0.05 * std::cos(0.7 * t) * (now_s - last_s);
        devices.mouse_up = 0.05 * std::sin(0.43 * t) * (now_s - last_s);
        devices.hold(Action::deeper, std::fmod(t, 8.0) < 3.0);
        devices.hold(Action::back_out, std::fmod(t, 8.0) > 5.0);
        devices.hold(Action::yellow_pedal, std::fmod(t, 3.0) < 0.8);
        devices.hold(Action::suction, std::fmod(t, 7.0) < 2.0);
        devices.grasp_toggled = std::floor(t / 5.0) != std::floor((last_s - begun_s) / 5.0);
        mapping.apply(devices, now_s - last_s, scope);
        session.set(mapping.controls());
        session.update();
        last_s = now_s;
        if (settled_MB == 0.0 && now_s > warm_s) settled_MB = resident_MB();
        if (now_s - told_s > 60.0) {
            told_s = now_s;
            const Pace& pace = session.snapshot().pace;
            std::printf("%6.0f s: %7.1f s simulated, %4.0f ticks/s, a tick %4.0f us, %lld late, %5.1f MB\n", t,
                        session.snapshot().time_s, pace.ticks_per_s, pace.tick_us,
                        static_cast<long long>(pace.late_ticks), resident_MB());
            std::fflush(stdout);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(16));
    }
    const double grown_MB = resident_MB() - settled_MB;
    session.stop();
    EXPECT_TRUE(session.snapshot().status.ok);
    // Every tick of a session was recorded; what a minute of it may leave in memory are the curves of its debrief.
    const double simulated_s = recording->row().duration_s;
    EXPECT_GT(simulated_s, 0.0);
    EXPECT_LT(grown_MB, 6.0 + 0.1 * simulated_s / 60.0);
    std::printf("%.1f s simulated in %.1f s, memory %.1f MB and %+.1f MB since\n", simulated_s, wall_s, settled_MB,
                grown_MB);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace calot::viewer
