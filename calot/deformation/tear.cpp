#include "calot/deformation/tear.h"

#include <array>

#include "calot/deformation/falling.h"

namespace calot::deformation {

namespace {

/// |F|^2 = tr C of 64 phyxels, F = I + G: the sum of the squared principal stretches, blind to rotation.
std::array<float, 64> squared_stretches(const Work& work, std::size_t first) {
    std::array<float, 64> sum{};
    for (std::size_t k = 0; k < 9; ++k) {
        const float* gradient = work.gradient[k].data() + first;
        const float identity = k % 4 == 0 ? 1.0f : 0.0f;
        for (std::size_t lane = 0; lane < 64; ++lane) {
            const float f = gradient[lane] + identity;
            sum[lane] += f * f;
        }
    }
    return sum;
}

}  // namespace

void tear_overstretched(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                        const Work& work) {
    // Uniaxial stretch of incompressible tissue: lambda along, 1 / sqrt(lambda) across.
    const double stretch = model.deformation.tear_stretch;
    const auto limit = static_cast<float>(stretch * stretch + 2.0 / stretch);
    const auto& words = state.phyxel_present.words();
    for (std::size_t w = 0; 64 * w + 64 <= work.gradient[0].size(); ++w) {
        if (words[w] == 0) continue;
        const std::array<float, 64> sum = squared_stretches(work, 64 * w);
        for (std::uint64_t rest = words[w]; rest != 0; rest &= rest - 1) {
            const int lane = __builtin_ctzll(rest);
            if (!(sum[static_cast<std::size_t>(lane)] > limit)) continue;
            const auto phyxel = static_cast<std::int64_t>(64 * w) + lane;
            drop_hexels(model, state, exchange, phyxel, work.occupancy[static_cast<std::size_t>(phyxel)]);
        }
    }
}

}  // namespace calot::deformation
