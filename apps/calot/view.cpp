// `calot view`: the trainer's window.

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "calot/base/parallel.h"
#include "calot/haptics/choose.h"
#include "calot/haptics/session.h"
#include "calot/viewer/data_files.h"
#include "calot/window/trainer.h"
#include "commands.h"
#include "training_exercises.h"

namespace calot::app {

namespace {

/// Scenes draw smoke off as an assistant would who never tires. Here the trainee has the suction.
constexpr const char* kLingeringSmoke = "smoke.suction_per_s=0.25";

/// Physics has a core of its own and drawing another; more than a few threads do not help a tick this short.
int physics_threads(int wanted) {
    if (wanted > 0) return wanted;
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    return std::max(1, std::min(4, cores - 2));
}

/// Whether threads may have real-time priority here: tries it.
bool may_be_real_time() {
    sched_param ordinary{}, urgent{};
    int policy = 0;
    if (::pthread_getschedparam(::pthread_self(), &policy, &ordinary) != 0) return false;
    urgent.sched_priority = ::sched_get_priority_min(SCHED_FIFO);
    if (::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &urgent) != 0) return false;
    ::pthread_setschedparam(::pthread_self(), policy, &ordinary);
    return true;
}

/// Mesa's software renderer would take every core; one stays with the physics, unless that goes first in any case.
/// Graphics processors ignore this.
void leave_a_core() {
    const unsigned cores = std::thread::hardware_concurrency(), drawing = may_be_real_time() ? cores : cores - 1;
    if (drawing > 0) ::setenv("LP_NUM_THREADS", std::to_string(std::min(16u, drawing)).c_str(), 0);
}

/// A device for the right hand, whose directions are those of the picture as it is at first.
std::shared_ptr<haptics::Session> make_device(const ViewOptions& options, const simulation::Setup& setup) {
    haptics::SessionOptions session;
    session.hook = setup.hook;
    session.tick_s = setup.model.tick_s;
    session.mapping.trocar_m = setup.script.trocar_m();
    session.mapping.device_to_world =
        haptics::device_to_world(setup.camera.eye_m, setup.camera.target_m, Vec3(0.0, 1.0, 0.0));
    session.servo.gain = options.haptics_gain;
    haptics::DeviceChoice choice;
    choice.kind = options.haptics;
    return std::make_shared<haptics::Session>(haptics::make_device(choice), session);
}

}  // namespace

int view(const ViewOptions& options) {
    const std::string path = options.scene.path.empty() ? viewer::scene_file("calot.toml") : options.scene.path;
    SceneChoice standard = options.scene;
    standard.path = path;
    const scene::Scene checked = load_scene(standard);  // a bad scene is told before a window opens

    window::TrainerOptions trainer;
    trainer.patients = checked.kind == scene::AnatomyKind::calots_triangle && !options.scene.seed;
    trainer.make_scene = [standard, &options](const window::SceneWish& wish) {
        SceneChoice choice = standard;
        if (!wish.scene.empty()) choice.path = viewer::scene_file(wish.scene);
        choice.assignments = {kLingeringSmoke};
        choice.assignments.insert(choice.assignments.end(), wish.assignments.begin(), wish.assignments.end());
        if (wish.scene.empty())  // the command line has the last word
            choice.assignments.insert(choice.assignments.end(), options.scene.assignments.begin(),
                                      options.scene.assignments.end());
        if (wish.any_patient) choice.seed = wish.seed;
        return load_scene(choice);
    };
    trainer.prepare = [&options](simulation::Setup& setup) { use_backend(options.backend, setup); };
    std::string trouble;
    trainer.exercises = training_exercises(options.data, options.trainee, trouble, trainer.cut_off);
    if (!trouble.empty()) fmt::print(stderr, "calot: note: sessions will not be stored: {}\n", trouble);
    if (!options.haptics.empty()) {
        haptics::DeviceChoice choice;
        choice.kind = options.haptics;
        haptics::make_device(choice);  // what is wrong is told before a window opens
        trainer.make_device = [&options](const simulation::Setup& setup) { return make_device(options, setup); };
    }
    trainer.start = options.start;
    trainer.language = options.language;
    trainer.pictures = options.pictures;
    trainer.width = options.width;
    trainer.height = options.height;
    trainer.fullscreen = options.fullscreen;
    leave_a_core();
    const ThreadLimit limit(physics_threads(options.threads));
    window::run_trainer(trainer);
    return kDone;
}

}  // namespace calot::app
