#pragma once
// Smoke particles as billboards: sorted back to front, stretched along their way, with optical depths.

#include <vector>

#include "calot/render/view.h"

namespace calot::render {

struct SmokeSprite {
    Vec3f world_m;
    float radius_m;
    float optical_depth;  ///< through the middle
    float steam_share;
    float age_s;
    float seed;              ///< 0 to 1
    float along_x, along_y;  ///< unit, on the screen
    float stretch;
    float unused = 0.0f;
};

void make_sprites(const View& view, std::vector<SmokeSprite>& sprites);

}  // namespace calot::render
