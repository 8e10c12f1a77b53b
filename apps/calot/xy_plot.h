#pragma once
// A validation::Figure as inline SVG: lines and marks against any x, on linear or logarithmic axes.

#include <string>

#include "calot/validation/case.h"

namespace calot::app {

std::string svg(const validation::Figure& figure);

/// A published band with what Calot says, on one line.
std::string svg_band(const validation::Case& result);

}  // namespace calot::app
