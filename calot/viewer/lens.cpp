#include "calot/viewer/lens.h"

#include <algorithm>
#include <cmath>

namespace calot::viewer {

namespace {

// Chosen so that a minute of burning at a usual distance asks for one wipe.
constexpr double kFogPerKg = 700.0;  ///< of gas, at kNear_m
constexpr double kSmearPerKg = 500.0;
constexpr double kNear_m = 0.045;
constexpr double kSpatter_m = 0.030;        ///< spatter flies this far
constexpr double kFogClears_per_s = 0.012;  ///< the scope is warm
constexpr double kSpurtSmear_per_s = 0.5;   ///< blood that hits the lens, at full flow close by
constexpr double kFullFlow_m3_per_s = 0.6e-6;
constexpr double kWipe_s = 0.35;

}  // namespace

void LensState::advance(const Figures& figures, const Vec3& eye_m, double dt_s) {
    const double far_m = std::max(0.01, glm::distance(eye_m, figures.tip_m));
    const double near = std::min(4.0, (kNear_m / far_m) * (kNear_m / far_m));
    const double gas_kg = figures.boiling_kg_per_s * dt_s;
    fog_ += kFogPerKg * near * gas_kg - kFogClears_per_s * dt_s;
    smear_ += kSmearPerKg * std::exp(-far_m / kSpatter_m) * gas_kg;
    smear_ += kSpurtSmear_per_s * dt_s * std::exp(-far_m / kSpatter_m) * figures.bleeding_m3_per_s / kFullFlow_m3_per_s;
    if (wiping_ > 0.0) {
        const double left = std::exp(-dt_s / (0.25 * kWipe_s));
        fog_ *= left;
        smear_ *= left;
        wiping_ -= dt_s;
    }
    fog_ = std::clamp(fog_, 0.0, 0.9);
    smear_ = std::clamp(smear_, 0.0, 0.9);
}

void LensState::wipe() {
    wiping_ = kWipe_s;
    ++wiped_;
}

render::Lens LensState::look() const {
    auto seen = [](double amount) { return static_cast<float>(std::round(128.0 * amount) / 128.0); };
    return {seen(fog_), seen(smear_), static_cast<float>(std::fmod(0.37 * wiped_, 1.0))};
}

}  // namespace calot::viewer
