#pragma once
// A plain block, for experiments.

#include "calot/anatomy/anatomy.h"

namespace calot::anatomy {

struct BlockParameters {
    Vec3 size_m{0.036, 0.036, 0.0192};
    std::string material = "fat";
    bool held_below = true;  ///< held by a rigid slab under its -z face
};

/// A block of one tissue, centred on the origin in x and y, its top at z = 0. Landmarks: "top" (0,0,0), "centre",
/// "trocar".
Anatomy make_block(const BlockParameters& parameters);

}  // namespace calot::anatomy
