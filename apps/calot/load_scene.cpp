#include "commands.h"

namespace calot::app {

scene::Scene load_scene(const SceneChoice& choice) {
    scene::Scene scene = scene::load(choice.path);
    for (const std::string& assignment : choice.assignments) scene::override_value(scene, assignment);
    if (choice.duration_s) scene.duration_s = *choice.duration_s;
    if (choice.seed) scene.seed = *choice.seed;
    scene::check(scene);
    return scene;
}

}  // namespace calot::app
