#pragma once
// summary.json: the run in figures.

#include <string>

#include "run.h"

namespace calot::app {

std::string summary_json(const RunRecord& record);

}  // namespace calot::app
