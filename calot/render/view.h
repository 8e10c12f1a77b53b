#pragma once
// What one picture is made of. The renderer knows nothing of the simulation: the program fills a View from it.

#include <cstdint>
#include <vector>

#include "calot/effects/bleeding.h"
#include "calot/effects/smoke.h"
#include "calot/surface/mesh.h"
#include "calot/tissue/exchange.h"

namespace calot::render {

/// The look of a surface: which of the procedural tissues the shader draws.
enum class Look : std::uint8_t { fat, duct, artery, gallbladder, liver, peritoneum, bowel };

/// A vertex of deformable tissue.
struct TissueVertex {
    Vec3f world_m;
    Vec3f normal;  ///< world, unit
    Vec3f rest_m;  ///< texture coordinate: texture sticks to tissue
    float temperature_K = 310.15f;
    float peak_temperature_K = 310.15f;
    float damage = 0.0f;                   ///< Omega
    float dryness = 0.0f;                  ///< 0 = all its water, 1 = dry
    float exposure = 0.0f;                 ///< 0 = surface of the start, 1 = laid bare by burning
    float blood = 0.0f;                    ///< 0 = none, 1 = so thick that nothing shines through
    float look_weights[4] = {1, 0, 0, 0};  ///< fat, duct, artery, gallbladder; sums to 1
};

struct OrganMesh {
    Look look = Look::liver;
    surface::Mesh mesh;  ///< in world space; constant over a run
};

/// Camera of a 30-degree laparoscope.
struct Camera {
    Vec3 eye_m{0.0, -0.02, 0.09};
    Vec3 target_m{0.0};
    Vec3 up{0.0, 1.0, 0.0};
    double field_of_view_deg = 60.0;  ///< across the round image
};

/// How tissue is coloured: as it looks, or as a map of its peak temperature or its Arrhenius injury (organs grey).
enum class Paint { natural, peak_temperature, injury };

/// What is on the front lens.
struct Lens {
    float fog = 0.0f;    ///< 0 clear ... 1 blind
    float smear = 0.0f;  ///< drops and film, 0 ... 1
    float seed = 0.0f;   ///< another pattern for every number
};

struct View {
    Camera camera;
    Paint paint = Paint::natural;
    double time_s = 0.0;  ///< for pulse and flicker
    std::vector<TissueVertex> tissue;
    std::vector<std::uint32_t> tissue_index;
    std::uint64_t tissue_index_version = 0;          ///< changes when tissue_index changed
    const std::vector<OrganMesh>* organs = nullptr;  ///< constant over a run, may be shared by views
    std::uint64_t organs_version = 0;                ///< changes when *organs changed
    std::vector<tissue::Capsule> instrument;         ///< the hook; the renderer models it beautifully from its capsules
    bool energised = false;
    std::vector<effects::SmokeParticle> smoke;
    std::vector<effects::BloodDrop> drops;
    Lens lens;
};

enum class Quality { low, medium, high };

}  // namespace calot::render
