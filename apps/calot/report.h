#pragma once
// report.html: one page that opens offline and tells what happened.

#include <string>

#include "run.h"

namespace calot::app {

/// Stills are read from `directory` and embedded.
std::string report_html(const RunRecord& record, const RunPlan& plan, const std::string& directory);

}  // namespace calot::app
