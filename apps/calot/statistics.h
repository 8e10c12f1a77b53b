#pragma once
// Quantiles of many samples in constant memory: a histogram on a logarithmic scale.

#include <array>
#include <cstdint>

namespace calot::app {

/// Positive samples; quantiles are within half a bin, 0.5 %.
class Quantiles {
  public:
    void add(double value);
    double at(double share) const;  ///< 0.5 = the median; 0 when there is no sample
    double max() const { return max_; }
    double sum() const { return sum_; }
    std::int64_t count() const { return count_; }

  private:
    static constexpr double kLeast = 1e-3;
    static constexpr double kBin = 1.01;      ///< ratio of neighbouring bins' edges
    std::array<std::uint32_t, 2800> bins_{};  ///< up to kLeast * 1.01^2800 = 1e9
    std::int64_t count_ = 0;
    double max_ = 0.0;
    double sum_ = 0.0;
};

}  // namespace calot::app
