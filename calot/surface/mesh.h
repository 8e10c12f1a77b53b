#pragma once
// A triangle mesh, planar enough for a GPU.

#include <cstdint>
#include <vector>

#include "calot/base/vec.h"

namespace calot::surface {

struct Mesh {
    std::vector<Vec3f> position_m;
    std::vector<Vec3f> normal;         ///< unit
    std::vector<std::uint32_t> index;  ///< three a triangle, counter-clockwise seen from outside

    std::size_t triangles() const { return index.size() / 3; }
};

}  // namespace calot::surface
