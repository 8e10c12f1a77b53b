#include "calot/anatomy/block.h"

#include "calot/anatomy/shapes.h"

namespace calot::anatomy {

Anatomy make_block(const BlockParameters& parameters) {
    const Vec3 size = parameters.size_m;
    const Vec3 low(-0.5 * size.x, -0.5 * size.y, -size.z), high(0.5 * size.x, 0.5 * size.y, 0.0);
    Anatomy anatomy;
    anatomy.tissues.push_back({"block", parameters.material, make_box(low, high)});
    if (parameters.held_below) {
        const double thickness = 0.02;
        anatomy.organs.push_back({"slab", "liver", true,
                                  make_box(Vec3(low.x - thickness, low.y - thickness, low.z - thickness),
                                           Vec3(high.x + thickness, high.y + thickness, low.z))});
    }
    anatomy.landmarks_m["top"] = Vec3(0.0);
    anatomy.landmarks_m["centre"] = Vec3(0.0, 0.0, -0.5 * size.z);
    anatomy.landmarks_m["trocar"] = Vec3(0.0, -0.08, 0.14);
    anatomy.field = Box{low, high};
    return anatomy;
}

}  // namespace calot::anatomy
