#pragma once
// A block of fat small enough that a tick costs next to nothing.

#include <memory>
#include <string>

#include "calot/scene/scene.h"
#include "calot/simulation/simulation.h"

namespace calot::viewer::test {

inline constexpr const char* kSmallScene = R"(
[scene]
name = "small"
[anatomy]
kind = "block"
[block]
size_mm = [9.6, 9.6, 4.8]
[electric]
window_cells = 16
[camera]
eye_offset_mm = [0, -25, 45]
[[script.key]]
t = 0
offset_mm = [0, 0, 6]
)";

inline std::unique_ptr<simulation::Simulation> small_run() {
    auto setup = std::make_shared<const simulation::Setup>(scene::build(scene::parse(kSmallScene, "small.toml", ".")));
    return std::make_unique<simulation::Simulation>(setup);
}

}  // namespace calot::viewer::test
