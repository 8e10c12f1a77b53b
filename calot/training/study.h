#pragma once
// From stored sessions to what a study wants: learning curves, means and deviations, CSV.

#include <cstdint>
#include <string>
#include <vector>

#include "calot/training/questionnaire.h"
#include "calot/training/store.h"

namespace calot::training {

/// Of n numbers. The deviation is that of a sample (n - 1); 0 for a single one.
struct Spread {
    std::size_t count = 0;
    double mean = 0.0, deviation = 0.0;
};
Spread spread(const std::vector<double>& values);

/// One trainee's attempts at one task, in order. Sessions that continue another, or were cut off, are no attempts.
struct Curve {
    std::string trainee, task;
    std::vector<SessionRow> attempts;
};

struct Study {
    std::vector<Curve> curves;    ///< by trainee, then task
    std::vector<Spread> answers;  ///< of each question
    std::size_t sessions = 0, with_answers = 0;
};
Study make_study(const std::vector<SessionRow>& sessions);

/// A line a session: its columns, all metrics (SI), all answers. RFC 4180.
std::string csv(const std::vector<SessionRow>& sessions);

}  // namespace calot::training
