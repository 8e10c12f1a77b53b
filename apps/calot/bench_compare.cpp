#include "bench_compare.h"

#include <algorithm>

#include <fmt/format.h>

namespace calot::app {

namespace {

constexpr double kNoticeable = 0.03;
constexpr std::size_t kFewestPairs = 5;

/// Times in units of the yardstick.
std::vector<double> steadied(const Samples& samples) {
    std::vector<double> out = samples.us;
    if (samples.yardstick_us.size() != samples.us.size()) return out;
    for (std::size_t k = 0; k < out.size(); ++k)
        if (samples.yardstick_us[k] > 0.0) out[k] /= samples.yardstick_us[k];
    return out;
}

}  // namespace

std::string Comparison::verdict() const {
    if (change.pairs < kFewestPairs) return "unclear";
    if (change.high < 1.0 - kNoticeable / 3.0) return "faster";
    if (change.low > 1.0 + kNoticeable / 3.0) return "slower";
    if (change.low > 1.0 - kNoticeable && change.high < 1.0 + kNoticeable) return "the same";
    return "unclear";
}

std::vector<Comparison> compare(const SampleSet& earlier, const SampleSet& later) {
    std::vector<Comparison> out;
    for (const auto& [name, now] : later) {
        const auto before = earlier.find(name);
        if (before == earlier.end() || now.us.empty() || before->second.us.empty()) continue;
        Comparison c;
        c.name = name;
        c.earlier_us = quantile(before->second.us, 0.5);
        c.later_us = quantile(now.us, 0.5);
        c.change = compare_paired(steadied(before->second), steadied(now));
        out.push_back(std::move(c));
    }
    return out;
}

std::string comparison_text(const std::vector<Comparison>& comparisons) {
    if (comparisons.empty()) return "nothing to compare: the two runs have no measurement in common\n";
    std::size_t width = 0;
    for (const Comparison& c : comparisons) width = std::max(width, c.name.size());
    std::string out = fmt::format("{:<{}}  {:>11} {:>11}  {:>6}  {:<16} {:>5}  {}\n", "against the earlier run", width,
                                  "earlier us", "now us", "ratio", "95 % interval", "pairs", "verdict");
    for (const Comparison& c : comparisons)
        out += fmt::format("{:<{}}  {:>11.2f} {:>11.2f}  {:>6.3f}  {:<16} {:>5}  {}\n", c.name, width, c.earlier_us,
                           c.later_us, c.change.ratio, fmt::format("{:.3f} to {:.3f}", c.change.low, c.change.high),
                           c.change.pairs, c.verdict());
    return out;
}

}  // namespace calot::app
