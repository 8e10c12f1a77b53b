#include "statistics.h"

#include <algorithm>
#include <cmath>

namespace calot::app {

void Quantiles::add(double value) {
    const double position = value > kLeast ? std::log(value / kLeast) / std::log(kBin) : 0.0;
    ++bins_[std::min(bins_.size() - 1, static_cast<std::size_t>(position))];
    ++count_;
    max_ = std::max(max_, value);
    sum_ += value;
}

double Quantiles::at(double share) const {
    if (count_ == 0) return 0.0;
    const auto wanted = static_cast<std::int64_t>(share * static_cast<double>(count_ - 1)) + 1;
    std::int64_t seen = 0;
    for (std::size_t k = 0; k < bins_.size(); ++k) {
        seen += bins_[k];
        if (seen >= wanted) return std::min(max_, kLeast * std::pow(kBin, static_cast<double>(k) + 0.5));
    }
    return max_;
}

}  // namespace calot::app
