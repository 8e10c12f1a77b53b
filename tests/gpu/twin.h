#pragma once
// A body that is moved twice: by the CPU's deformation room and by a device's.

#include <algorithm>
#include <cmath>

#include "calot/deformation/carriers.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/ghosts.h"
#include "calot/deformation/grasp.h"
#include "calot/deformation/tear.h"
#include "calot/deformation/topology.h"
#include "calot/gpu/deformation.h"
#include "calot/instruments/contact.h"
#include "calot/validation/elastic_rig.h"
#include "gpu/rig.h"

namespace calot::gpu {

/// Largest difference between two arrays, over the largest value of the first.
inline double difference(std::span<const float> a, std::span<const float> b) {
    EXPECT_EQ(a.size(), b.size());
    double most = 0.0, largest = 0.0;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
        const double d = std::abs(static_cast<double>(a[k]) - static_cast<double>(b[k]));
        most = d <= most ? most : d;  // NaN stays
        largest = std::max(largest, std::abs(static_cast<double>(a[k])));
    }
    return most == 0.0 ? 0.0 : most / largest;
}

struct Twin {
    deformation::rig::Body& cpu;
    std::shared_ptr<Device> device;
    tissue::State state;  ///< the host's part of the device's run
    tissue::Exchange exchange;
    Arrays arrays;
    Deformation deformation;

    explicit Twin(deformation::rig::Body& body, std::shared_ptr<Device> on = test_device())
        : cpu(body),
          device(std::move(on)),
          state(body.state),
          arrays(*device, body.model),
          deformation(device, body.model, arrays) {
        tissue::reserve_exchange(cpu.model, cpu.exchange);
        tissue::reserve_exchange(cpu.model, exchange);
        arrays.upload(*device, state);
        deformation.take(state);
    }

    /// Of relative differences: none where the device rounds as the CPU does.
    double tolerance() const { return device->info().is_gpu || !device->info().has_double ? 1e-5 : 0.0; }

    void advance() {
        deformation.advance(state, exchange);
        deformation.finish_advance(state, exchange);
    }

    /// What is on the device, with what the host keeps.
    tissue::State fetched() {
        tissue::State all = state;
        arrays.download(*device, all);
        return all;
    }

    std::vector<float> plane(const DeviceArray<float>& array, std::int64_t plane) {
        std::vector<float> data(static_cast<std::size_t>(cpu.model.phyxels.cells));
        array.download(*device, std::span<float>(data), plane * cpu.model.phyxels.cells);
        return data;
    }

    /// The same in rest properties and masses.
    double difference_of_rest() {
        double most = 0.0;
        auto compare = [&](const Array<float>& expected, const DeviceArray<float>& array, int k) {
            most = std::max(most, difference(expected, plane(array, k)));
        };
        const deformation::Work& work = cpu.work;
        for (int e = 0; e < 6; ++e)
            compare(work.moment_inverse[static_cast<std::size_t>(e)], deformation.rest(), REST_MOMENT_INVERSE + e);
        for (int c = 0; c < 3; ++c)
            compare(work.step_sum[static_cast<std::size_t>(c)], deformation.rest(), REST_STEP_SUM + c);
        compare(work.volume_m3, deformation.rest(), REST_VOLUME);
        compare(work.hourglass, deformation.rest(), REST_HOURGLASS);
        compare(work.lame_mu_Pa, deformation.rest(), REST_MU);
        compare(work.lame_lambda_Pa, deformation.rest(), REST_LAMBDA);
        compare(work.pull_N_per_m2, deformation.rest(), REST_PULL);
        compare(work.weighing_mass_kg, deformation.mass(), MASS_WEIGHING);
        compare(work.moving_mass_kg, deformation.mass(), MASS_MOVING);
        Array<float> stable_kg = work.stable_mass_kg;
        for (std::int64_t p = cpu.model.phyxels.first; p < cpu.model.phyxels.last; ++p)
            if (cpu.model.phyxel_ghost.test(p)) stable_kg[static_cast<std::size_t>(p)] = 0.0f;  // they have no mass
        compare(stable_kg, deformation.mass(), MASS_STABLE);
        return most;
    }

    /// Cells whose words differ from what the CPU has.
    std::int64_t wrong_words() {
        const std::vector<std::uint32_t> words = deformation.words().download(*device);
        const std::int64_t cells = cpu.model.phyxels.cells;
        auto word = [&](int plane, std::int64_t p) { return words[static_cast<std::size_t>(plane * cells + p)]; };
        std::int64_t wrong = 0;
        for (std::int64_t p = cpu.model.phyxels.first; p < cpu.model.phyxels.last; ++p) {
            const auto i = static_cast<std::size_t>(p);
            std::uint32_t carriers = 0, mirrored = 0;
            const deformation::Carriers found = deformation::find_carriers(cpu.model, cpu.state, cpu.work, p);
            for (std::size_t n = 0; n < static_cast<std::size_t>(found.count); ++n) carriers |= 1u << found.cell[n];
            if (cpu.model.phyxel_ghost.test(p)) {
                const deformation::Mirror& mirror = deformation::find_mirror(cpu.work, p);
                for (std::size_t n = 0; n < static_cast<std::size_t>(mirror.count); ++n)
                    for (std::size_t k = 0; k < 27; ++k)
                        if (p + cpu.work.neighbour_offset[k] == mirror.phyxel[n]) mirrored |= 1u << k;
            }
            const std::uint64_t occupancy = word(WORD_OCCUPANCY, p) | std::uint64_t{word(WORD_OCCUPANCY + 1, p)} << 32;
            wrong += word(WORD_LINKS, p) != cpu.work.link_word[i] || word(WORD_CARRIERS, p) != carriers ||
                     word(WORD_MIRROR, p) != mirrored || occupancy != cpu.work.occupancy[i];
        }
        return wrong;
    }

    /// Largest relative difference in what moves, in gradients and stresses. Gradients are compared where tissue or a
    /// ghost is.
    double difference_of_motion() {
        const tissue::State all = fetched();
        double most = 0.0;
        for (std::size_t r = 0; r < 3; ++r) {
            most = std::max(most, difference(cpu.state.displacement_m[r], all.displacement_m[r]));
            most = std::max(most, difference(cpu.state.velocity_m_per_s[r], all.velocity_m_per_s[r]));
        }
        for (std::size_t e = 0; e < 9; ++e) {
            const auto k = static_cast<std::int64_t>(e);
            most = std::max(most, difference(cpu.work.gradient[e], plane(deformation.gradient(), k)));
            most = std::max(most, difference(cpu.work.moment_stress[e], plane(deformation.moment_stress(), k)));
        }
        return most;
    }
};

}  // namespace calot::gpu
