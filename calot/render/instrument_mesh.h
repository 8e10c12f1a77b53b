#pragma once
// Instruments as they are drawn. The hook: smooth tubes along chains of capsules that share ends, bends rounded off.
// The grasper: two toothed jaws in a joint (jaw_mesh.h).

#include <cstdint>
#include <vector>

#include "calot/tissue/exchange.h"

namespace calot::render {

struct InstrumentVertex {
    Vec3f world_m;
    Vec3f normal;
    Vec3f along;            ///< unit tangent of the tube
    float metal = 0.0f;     ///< 1 = bare wire
    float pale = 0.0f;      ///< 1 = ceramic or pale plastic, 0 = dark insulation
    float axial_mm = 0.0f;  ///< length along the tube: brushing and wear
    float around = 0.0f;    ///< angle in turns
};

struct InstrumentMesh {
    std::vector<InstrumentVertex> vertex;
    std::vector<std::uint32_t> index;
};

/// Clears and fills `mesh`. Thin insulated pieces (thinner than 2 mm) are pale sleeves, thick ones dark shafts with a
/// pale chamfered collar at the end that is nearer to bare metal.
void build_instrument(const std::vector<tissue::Capsule>& capsules, InstrumentMesh& mesh);

}  // namespace calot::render
