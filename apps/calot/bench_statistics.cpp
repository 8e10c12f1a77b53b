#include "bench_statistics.h"

#include <algorithm>
#include <cmath>

#include "calot/base/random.h"

namespace calot::app {

namespace {
constexpr int kResamples = 2000;
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    const double at = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (at - std::floor(at)) * (values[above] - values[below]);
}

double least(const std::vector<double>& values) {
    return values.empty() ? 0.0 : *std::min_element(values.begin(), values.end());
}

Change compare_paired(const std::vector<double>& earlier, const std::vector<double>& later) {
    Change change;
    std::vector<double> logarithms;
    for (std::size_t k = 0; k < std::min(earlier.size(), later.size()); ++k)
        if (earlier[k] > 0.0 && later[k] > 0.0) logarithms.push_back(std::log(later[k] / earlier[k]));
    change.pairs = logarithms.size();
    if (logarithms.empty()) return change;
    change.ratio = std::exp(quantile(logarithms, 0.5));

    Random random(logarithms.size());
    std::vector<double> medians, drawn(logarithms.size());
    double below = 0.0;
    for (int k = 0; k < kResamples; ++k) {
        for (double& value : drawn)
            value = logarithms[static_cast<std::size_t>(random.uniform() * static_cast<double>(logarithms.size()))];
        const double median = quantile(drawn, 0.5);
        medians.push_back(median);
        below += median < 0.0 ? 1.0 : median > 0.0 ? 0.0 : 0.5;
    }
    change.low = std::exp(quantile(medians, 0.025));
    change.high = std::exp(quantile(medians, 0.975));
    change.sure = std::max(below, kResamples - below) / kResamples;
    return change;
}

double growth_exponent(const std::vector<double>& x, const std::vector<double>& y) {
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t k = 0; k < x.size() && k < y.size(); ++k) {
        const double a = std::log(x[k]), b = std::log(y[k]);
        n += 1.0, sx += a, sy += b, sxx += a * a, sxy += a * b;
    }
    const double spread = n * sxx - sx * sx;
    return spread > 0.0 ? (n * sxy - sx * sy) / spread : 0.0;
}

}  // namespace calot::app
