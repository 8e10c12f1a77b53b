#pragma once
// How a duration spreads: counts in bins of 10 us, so that adding costs nothing and any thread may look at any time.

#include <array>
#include <atomic>
#include <cstdint>

namespace calot::haptics {

class Spread {
  public:
    /// From one thread.
    void add(double seconds) {
        const double bin = seconds / kBin_s;
        const auto k = static_cast<std::size_t>(bin < 0.0 ? 0.0 : bin < kBins - 1.0 ? bin : kBins - 1.0);
        bump(counts_[k], 1u);
        bump(count_, std::uint64_t{1});
        sum_s_.store(sum_s_.load(std::memory_order_relaxed) + seconds, std::memory_order_relaxed);
        if (seconds > most_s_.load(std::memory_order_relaxed)) most_s_.store(seconds, std::memory_order_relaxed);
    }
    std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
    double mean_s() const {
        return count() == 0 ? 0.0 : sum_s_.load(std::memory_order_relaxed) / static_cast<double>(count());
    }
    double most_s() const { return most_s_.load(std::memory_order_relaxed); }
    /// To the width of a bin, from above; what lies beyond the bins counts as the greatest.
    double quantile_s(double share) const {
        const double wanted = share * static_cast<double>(count());
        double seen = 0.0;
        for (std::size_t k = 0; k + 1 < kBins; ++k) {
            seen += counts_[k].load(std::memory_order_relaxed);
            if (seen >= wanted && seen > 0.0) return static_cast<double>(k + 1) * kBin_s;
        }
        return most_s();
    }

  private:
    static constexpr double kBin_s = 10e-6;
    static constexpr std::size_t kBins = 2048;
    template <class N>
    static void bump(std::atomic<N>& value, N by) {
        value.store(value.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
    }
    std::array<std::atomic<std::uint32_t>, kBins> counts_{};
    std::atomic<std::uint64_t> count_{0};
    std::atomic<double> sum_s_{0.0}, most_s_{0.0};
};

}  // namespace calot::haptics
