#pragma once
// A session's outcome: what debriefs, databases and programs get.

#include <string>
#include <vector>

#include "calot/training/score.h"

namespace calot::training {

struct Result {
    Task task;
    Metrics metrics;
    Score score;
    std::vector<Event> events;
};

Result conclude(const Task& task, const Meter& meter);

/// All of it, for programs: score, parts, limits, metrics with title, unit and formula, events.
std::string to_json(const Result& result);

/// Metrics alone, and back: {"time_s": 30.3, ...}.
std::string metrics_json(const Metrics& metrics);
Metrics metrics_from_json(const std::string& text);

}  // namespace calot::training
