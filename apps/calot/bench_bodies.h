#pragma once
// Bodies and scenes that benchmarks run on.

#include <cstdint>
#include <memory>
#include <string>

#include "calot/scene/scene.h"
#include "calot/simulation/setup.h"
#include "calot/tissue/model.h"

namespace calot::app {

/// A block of fat of exactly so many cells, held below: whole layers, then whole rows, then part of one. `height` is
/// its height over its width.
anatomy::Anatomy exact_block(std::int64_t cells, double cell_m, double height = 1.0);

/// exact_block() of so many phyxels of 4^3 hexels each, 2.4 mm apart.
tissue::Model phyxel_block(std::int64_t phyxels);
/// exact_block() of so many hexels, 0.6 mm apart, 4^3 to a phyxel: a little flat, as operating fields are.
tissue::Model hexel_block(std::int64_t hexels);

/// A scene that comes with Calot, by the name of its file: beside the working directory, or where the program was
/// built. Throws InputError when it is in neither.
scene::Scene shipped_scene(const std::string& name);

/// Scene `name` with the hexel spacing changed until it has as nearly so many hexels as the lattice allows.
std::shared_ptr<simulation::Setup> scene_of_hexels(const std::string& name, std::int64_t hexels);

/// A scene written here: a block of 147,456 hexels under the hook. `script` holds its keyframes and bursts.
std::shared_ptr<simulation::Setup> block_scene(const std::string& name, const std::string& script);

}  // namespace calot::app
