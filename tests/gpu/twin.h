#pragma once
// A body that is moved twice: by the CPU's deformation room and by a device's.

#include <algorithm>
#include <cmath>

#include "calot/deformation/embedding.h"
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
    std::shared_ptr<Device> device = test_device();
    tissue::State state;  ///< the host's part of the device's run
    tissue::Exchange exchange;
    Arrays arrays;
    Deformation deformation;

    explicit Twin(deformation::rig::Body& body)
        : cpu(body), state(body.state), arrays(*device, body.model), deformation(device, body.model, arrays) {
        tissue::reserve_exchange(cpu.model, cpu.exchange);
        tissue::reserve_exchange(cpu.model, exchange);
        arrays.upload(*device, state);
        deformation.take(state);
    }

    /// Of relative differences: none where the device rounds as the CPU does.
    double tolerance() const { return device->info().is_gpu ? 1e-5 : 0.0; }

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
