#pragma once
// A smooth way through values at given times: monotone cubic (Fritsch & Carlson 1980) per component, never past a
// value, at rest where two agree and at both ends; before the first and after the last it stays there.

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

namespace calot::simulation {

template <std::size_t N>
class Track {
  public:
    using Values = std::array<double, N>;

    void add(double time_s, const Values& values) {
        assert(times_s_.empty() || time_s > times_s_.back());
        times_s_.push_back(time_s);
        values_.push_back(values);
    }
    /// Once all are there.
    void finish() {
        slopes_.assign(times_s_.size(), Values{});
        for (std::size_t k = 1; k + 1 < times_s_.size(); ++k) {
            const double before = times_s_[k] - times_s_[k - 1], after = times_s_[k + 1] - times_s_[k];
            for (std::size_t c = 0; c < N; ++c)
                slopes_[k][c] = inner_slope(before, after, (values_[k][c] - values_[k - 1][c]) / before,
                                            (values_[k + 1][c] - values_[k][c]) / after);
        }
    }
    bool empty() const { return times_s_.empty(); }

    Values at(double time_s) const {
        if (time_s <= times_s_.front()) return values_.front();
        if (time_s >= times_s_.back()) return values_.back();
        const auto next = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
        const auto k = static_cast<std::size_t>(next - times_s_.begin()) - 1;
        const double span = times_s_[k + 1] - times_s_[k], t = (time_s - times_s_[k]) / span;
        // Cubic Hermite basis.
        const double h00 = (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t), h10 = t * (1.0 - t) * (1.0 - t);
        const double h01 = t * t * (3.0 - 2.0 * t), h11 = t * t * (t - 1.0);
        Values value{};
        for (std::size_t c = 0; c < N; ++c)
            value[c] = h00 * values_[k][c] + h10 * span * slopes_[k][c] + h01 * values_[k + 1][c] +
                       h11 * span * slopes_[k + 1][c];
        return value;
    }

  private:
    /// The weighted harmonic mean of the two secants, zero where they differ in sign (Fritsch & Butland 1984), so that
    /// the curve has no overshoot.
    static double inner_slope(double step_before, double step_after, double secant_before, double secant_after) {
        if (secant_before * secant_after <= 0.0) return 0.0;
        const double w1 = 2.0 * step_after + step_before, w2 = step_after + 2.0 * step_before;
        return (w1 + w2) / (w1 / secant_before + w2 / secant_after);
    }

    std::vector<double> times_s_;
    std::vector<Values> values_, slopes_;
};

}  // namespace calot::simulation
