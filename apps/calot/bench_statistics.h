#pragma once
// Small statistics of measured times.

#include <cstdint>
#include <utility>
#include <vector>

namespace calot::app {

/// 0.5 = the median, interpolated. 0 when there are none.
double quantile(std::vector<double> values, double share);
double least(const std::vector<double>& values);

/// How a time changed, as the ratio of later to earlier, with an interval that holds the true one with 95 %.
struct Change {
    double ratio = 1.0, low = 1.0, high = 1.0;
    std::size_t pairs = 0;
    /// Shares of resamples on either side of no change tell how sure a difference is.
    double sure = 0.0;  ///< 0.95 ... 1: it moved; towards 0.5 and below: nobody knows
};

/// Median ratio later[k] / earlier[k] of paired times, with a bootstrap interval (Efron 1979, percentiles) over pairs.
Change compare_paired(const std::vector<double>& earlier, const std::vector<double>& later);

/// Slope of log y against log x by least squares.
double growth_exponent(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace calot::app
