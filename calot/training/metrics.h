#pragma once
// What is measured: every metric with its unit, formula and source. docs/scoring.md says the same at more length; a
// test compares the two.

#include <map>
#include <string>
#include <vector>

namespace calot::training {

/// Values by name, in SI (kelvin, metres, cubic metres; shares from 0 to 1).
using Metrics = std::map<std::string, double>;

/// Which way is better, for arrows and colours; `neither` depends on the task.
enum class Better { more, less, neither };

struct Metric {
    const char* name;   ///< in task files, databases, CSV
    const char* title;  ///< for people
    const char* unit;   ///< as shown
    double factor;      ///< shown = SI * factor + offset
    double offset;
    Better better;
    const char* formula;  ///< how it is computed, in words and symbols
    const char* source;   ///< where the idea comes from; "" where it is Calot's own
};

/// All metrics, in the order in which people read them.
const std::vector<Metric>& metric_table();

/// Null when there is none of that name.
const Metric* find_metric(const std::string& name);

/// "12.3 mm", "85 %"; a dash for values that are not known (not a number).
std::string shown(const Metric& metric, double value);

}  // namespace calot::training
