#pragma once
// Random numbers that are the same on every machine: counter-based, a pure function of (seed, stream, counter).

#include <cstdint>

namespace calot {

/// SplitMix64's finaliser (Steele, Lea & Flood 2014): a good 64-bit mix.
constexpr std::uint64_t mix64(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

class Random {
  public:
    explicit constexpr Random(std::uint64_t seed, std::uint64_t stream = 0) : key_(mix64(seed ^ mix64(stream))) {}
    constexpr std::uint64_t next() { return mix64(key_ + counter_++); }
    /// Uniform in [0, 1).
    constexpr double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }

  private:
    std::uint64_t key_;
    std::uint64_t counter_ = 0;
};

}  // namespace calot
