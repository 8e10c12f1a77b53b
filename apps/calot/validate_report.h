#pragma once
// What `calot validate` writes.

#include <string>
#include <vector>

#include "calot/validation/case.h"

namespace calot::app {

struct ValidationRecord {
    std::vector<validation::Case> cases;
    bool quick = false;
    std::string spoilt;  ///< what was spoilt on purpose, empty: nothing
    double wall_s = 0.0;

    int count(validation::Verdict verdict) const;
};

/// {version, quick, cases: [{suite, name, kind, value, expected, unit, error, tolerance, order, verdict, source, ...}]}
std::string validation_json(const ValidationRecord& record);
/// One page that opens offline.
std::string validation_html(const ValidationRecord& record);

/// Error and tolerance of a case as people read them: "0.21 % of 1 %", "outside 54.8 ... 61.4".
std::string error_text(const validation::Case& result);
std::string number_text(double value);

}  // namespace calot::app
