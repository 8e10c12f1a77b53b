#include "calot/training/movement.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace calot::training {

namespace {

constexpr double kCutoff_Hz = 10.0;
constexpr double kLeastAmplitude = 0.05;
/// The profile is padded with zeros to 2^4 times its length, so that the spectrum is a smooth curve.
constexpr int kPadding = 16;

/// In place; the length is a power of two.
void fourier(std::vector<std::complex<double>>& x) {
    const std::size_t n = x.size();
    for (std::size_t i = 1, j = 0; i < n; ++i) {
        std::size_t bit = n >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(x[i], x[j]);
    }
    for (std::size_t length = 2; length <= n; length <<= 1) {
        const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi / static_cast<double>(length));
        for (std::size_t start = 0; start < n; start += length) {
            std::complex<double> w = 1.0;
            for (std::size_t k = 0; k < length / 2; ++k) {
                const std::complex<double> even = x[start + k], odd = w * x[start + k + length / 2];
                x[start + k] = even + odd;
                x[start + k + length / 2] = even - odd;
                w *= turn;
            }
        }
    }
}

}  // namespace

double spectral_arc_length(std::span<const float> speed, double samples_per_s) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    if (speed.size() < 3) return kUnknown;
    std::size_t n = 1;
    while (n < speed.size()) n <<= 1;
    n *= kPadding;
    std::vector<std::complex<double>> spectrum(n);
    for (std::size_t k = 0; k < speed.size(); ++k) spectrum[k] = static_cast<double>(speed[k]);
    fourier(spectrum);
    const double zero = std::abs(spectrum[0]);
    if (!(zero > 0.0)) return kUnknown;
    const double step_Hz = samples_per_s / static_cast<double>(n);
    const auto cutoff = std::min(n / 2, static_cast<std::size_t>(kCutoff_Hz / step_Hz));
    std::size_t last = 0;
    for (std::size_t k = 0; k <= cutoff; ++k)
        if (std::abs(spectrum[k]) >= kLeastAmplitude * zero) last = k;
    if (last == 0) return kUnknown;
    double length = 0.0;
    for (std::size_t k = 1; k <= last; ++k)
        length +=
            std::hypot(1.0 / static_cast<double>(last), (std::abs(spectrum[k]) - std::abs(spectrum[k - 1])) / zero);
    return -length;
}

MovementWatch::MovementWatch(double tick_s) : tick_s_(tick_s) {
    speed_m_per_s_.reserve(200'000);  // half an hour without growing
}

void MovementWatch::after_tick(const Vec3& tip_m, std::int64_t tick) {
    if (!started_) {
        last_m_ = sample_m_ = sample_before_m_ = tip_m;
        started_ = true;
    }
    path_m_ += glm::distance(tip_m, last_m_);
    last_m_ = tip_m;
    if (tick % kTicksPerSample != 0) return;
    // Central difference about the sample before: over 20 ms, which a hand cannot notice and a mouse needs.
    if (samples_ >= 2)
        speed_m_per_s_.push_back(
            static_cast<float>(glm::distance(tip_m, sample_before_m_) / (2.0 * kTicksPerSample * tick_s_)));
    samples_ = std::min(samples_ + 1, 2);
    sample_before_m_ = sample_m_;
    sample_m_ = tip_m;
}

template <class F>
void MovementWatch::for_each_movement(const F& visit) const {
    const double sample_s = kTicksPerSample * tick_s_;
    const auto least = static_cast<std::size_t>(kLeastMovement_s / sample_s + 0.5);
    std::size_t start = 0;
    for (std::size_t k = 0; k <= speed_m_per_s_.size(); ++k) {
        const bool moving = k < speed_m_per_s_.size() && static_cast<double>(speed_m_per_s_[k]) > kMoving_m_per_s;
        if (moving) continue;
        if (k - start >= least) visit(std::span<const float>(speed_m_per_s_).subspan(start, k - start));
        start = k + 1;
    }
}

double MovementWatch::smoothness() const {
    double sum = 0.0, weight = 0.0;
    for_each_movement([&](std::span<const float> speed) {
        const double value = spectral_arc_length(speed, 1.0 / (kTicksPerSample * tick_s_));
        if (std::isnan(value)) return;
        sum += value * static_cast<double>(speed.size());
        weight += static_cast<double>(speed.size());
    });
    return weight > 0.0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

int MovementWatch::movements() const {
    int count = 0;
    for_each_movement([&](std::span<const float>) { ++count; });
    return count;
}

}  // namespace calot::training
