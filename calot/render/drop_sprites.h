#pragma once
// Drops of blood and water as the shader takes them: billboards stretched along where they fly.

#include <vector>

#include "calot/render/view.h"

namespace calot::render {

/// As it lies in the vertex buffer, one per instance.
struct DropSprite {
    Vec3f world_m;
    float radius_m;
    float along_x, along_y;  ///< unit, on the screen
    float stretch;
    float water;
};

void make_drops(const View& view, std::vector<DropSprite>& sprites);

}  // namespace calot::render
