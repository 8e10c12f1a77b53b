#pragma once
// The page of a benchmark: one file, opens offline.

#include <string>
#include <vector>

#include "bench_compare.h"
#include "bench_results.h"

namespace calot::app {

std::string bench_html(const BenchResults& results, const std::vector<Comparison>& comparisons);

// Its sections; empty where there is nothing.
std::string kernels_section(const BenchResults& results);
std::string tick_section(const BenchResults& results);
std::string paper_section(const BenchResults& results);
std::string scale_section(const BenchResults& results);
std::string device_section(const BenchResults& results);

/// 1178091 -> "1,178,091"
std::string grouped_number(std::int64_t number);
/// 3 digits, in us or ms as it suits.
std::string time_text(double us);

}  // namespace calot::app
