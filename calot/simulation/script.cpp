#include "calot/simulation/script.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "calot/instruments/hook.h"

namespace calot::simulation {

namespace {

glm::dvec4 values(const Keyframe& key) {
    return {key.tip_m, key.roll_rad};
}

/// Slope at an inner keyframe: the weighted harmonic mean of the two secants, zero where they differ in sign
/// (Fritsch & Butland 1984), so that the curve has no overshoot.
double inner_slope(double step_before, double step_after, double secant_before, double secant_after) {
    if (secant_before * secant_after <= 0.0) return 0.0;
    const double w1 = 2.0 * step_after + step_before, w2 = step_after + 2.0 * step_before;
    return (w1 + w2) / (w1 / secant_before + w2 / secant_after);
}

}  // namespace

Script::Script(const Vec3& trocar_m, std::vector<Keyframe> keyframes, std::vector<Burst> bursts)
    : trocar_m_(trocar_m),
      keyframes_(std::move(keyframes)),
      bursts_(std::move(bursts)),
      slopes_(keyframes_.size(), glm::dvec4(0.0)) {
    assert(!keyframes_.empty());
    std::sort(bursts_.begin(), bursts_.end(), [](const Burst& a, const Burst& b) { return a.from_s < b.from_s; });
    // The hand starts and ends at rest.
    for (std::size_t k = 1; k + 1 < keyframes_.size(); ++k) {
        const double before = keyframes_[k].time_s - keyframes_[k - 1].time_s,
                     after = keyframes_[k + 1].time_s - keyframes_[k].time_s;
        assert(before > 0.0 && after > 0.0);
        const glm::dvec4 secant_before = (values(keyframes_[k]) - values(keyframes_[k - 1])) / before;
        const glm::dvec4 secant_after = (values(keyframes_[k + 1]) - values(keyframes_[k])) / after;
        for (int c = 0; c < 4; ++c) slopes_[k][c] = inner_slope(before, after, secant_before[c], secant_after[c]);
    }
}

tissue::Input Script::at(double time_s) const {
    glm::dvec4 value;
    if (time_s <= keyframes_.front().time_s) {
        value = values(keyframes_.front());
    } else if (time_s >= keyframes_.back().time_s) {
        value = values(keyframes_.back());
    } else {
        const auto next = std::upper_bound(keyframes_.begin(), keyframes_.end(), time_s,
                                           [](double t, const Keyframe& key) { return t < key.time_s; });
        const auto k = static_cast<std::size_t>(next - keyframes_.begin()) - 1;
        const double span = next->time_s - keyframes_[k].time_s;
        const double t = (time_s - keyframes_[k].time_s) / span;
        // Cubic Hermite basis.
        const double h00 = (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t), h10 = t * (1.0 - t) * (1.0 - t);
        const double h01 = t * t * (3.0 - 2.0 * t), h11 = t * t * (t - 1.0);
        value =
            h00 * values(keyframes_[k]) + h10 * span * slopes_[k] + h01 * values(*next) + h11 * span * slopes_[k + 1];
    }
    tissue::Input input;
    input.hook = instruments::pose_through_trocar(trocar_m_, Vec3(value), value.w);
    for (const Burst& burst : bursts_)
        if (time_s >= burst.from_s && time_s < burst.to_s) {
            input.pedal = true;
            input.mode = burst.mode;
            input.power_setting_W = burst.power_W;
            input.wipe_tip = burst.wiped && time_s < burst.from_s + 1.5e-3;
        }
    return input;
}

}  // namespace calot::simulation
