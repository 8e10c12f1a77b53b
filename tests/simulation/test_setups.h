#pragma once
// Small runs that the tests of the simulation share.

#include <memory>

#include "calot/anatomy/block.h"
#include "calot/simulation/setup.h"
#include "calot/tissue/sampling.h"

namespace calot::simulation {

/// A fat block of 24 x 24 x 9.6 mm, held below; the hook comes down on its middle, presses 2 mm in, burns and drags.
inline std::shared_ptr<Setup> burnt_block_setup() {
    auto setup = std::make_shared<Setup>();
    setup->name = "burnt block";
    setup->anatomy = anatomy::make_block({.size_m = Vec3(0.024, 0.024, 0.0096)});
    setup->model = tissue::sample(setup->anatomy, {});
    const Vec3 trocar(0.0, -0.08, 0.14);
    setup->script =
        Script(trocar,
               {{0.0, Vec3(0.0, 0.0, 0.004), 0.0},
                {0.2, Vec3(0.0, 0.0, -0.002), 0.0},
                {0.6, Vec3(0.0, 0.0, -0.002), 0.0},
                {1.4, Vec3(0.006, 0.0, -0.003), 0.0},
                {1.6, Vec3(0.006, 0.0, 0.006), 0.0}},
               {{0.25, 0.6, 40.0, tissue::GeneratorMode::cut}, {0.8, 1.4, 60.0, tissue::GeneratorMode::cut}});
    setup->duration_s = 1.6;
    return setup;
}

}  // namespace calot::simulation
