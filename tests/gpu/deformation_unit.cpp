// Deformation's kernels against the CPU's, on random bodies.

#include "gpu/twin.h"

namespace calot::gpu {
namespace {

using deformation::rig::Body;
using deformation::rig::block;
using deformation::rig::shake;
using deformation::rig::wound;

/// Between devices whose division and roots round differently; where they round as the CPU does, results are the same.
constexpr double kTolerance = 1e-5;

tissue::Model random_model(tissue::ElasticLaw law, const Int3& size = {6, 7, 5}) {
    tissue::Model model = block(size, true);
    model.deformation.law = law;
    model.deformation.volume_stiffness_Pa = 4e3;
    model.deformation.gravity_m_per_s2 = Vec3(1.0, -9.81, 2.0);
    return model;
}

TEST(Deformation, MovesAsTheCpuDoes) {
    for (const auto law : {tissue::ElasticLaw::stable_neo_hookean, tissue::ElasticLaw::saint_venant_kirchhoff})
        for (const double severed : {0.0, 0.3}) {
            Body body(random_model(law));
            wound(body, 0.3, severed, 3);
            shake(body, 0.03, 0.05, 4);
            Twin twin(body);
            EXPECT_EQ(twin.difference_of_motion(), 0.0);
            for (int tick = 0; tick < 4; ++tick) {
                body.tick();
                twin.advance();
                const double d = twin.difference_of_motion();
                EXPECT_LT(d, kTolerance) << tick;
                std::printf("law %d severed %g tick %d: %g\n", static_cast<int>(law), severed, tick, d);
            }
            EXPECT_TRUE(twin.state.status.ok);
        }
}

}  // namespace
}  // namespace calot::gpu
