// The table's patient: what the seed draws, and what a scene may fix instead.

#include "calot/scene/keys_build.h"

namespace calot::scene {

Group triangle_group() {
    Group group{"triangle", "The parametric patient, where anatomy.kind = \"calots_triangle\".", {}, {}};
    return group;
}

}  // namespace calot::scene
