#pragma once
// Plots as inline SVG. Colours come from the page's CSS variables, so that they suit light and dark.

#include <string>
#include <utility>
#include <vector>

namespace calot::app {

struct Series {
    std::string name;
    std::string colour;  ///< CSS, as in "var(--warm)"
    std::vector<std::pair<double, double>> points;
};

struct Plot {
    std::string title;
    std::string unit;  ///< of y
    std::vector<Series> series;
    std::vector<std::pair<double, double>> shaded;  ///< spans of x: pedal down
    double x_max = 1.0;
    bool logarithmic = false;                           ///< y; points at or below 0 are gaps
    double y_floor = 0.0;                               ///< least upper end of y, so that noise is not blown up
    std::vector<std::pair<double, std::string>> marks;  ///< horizontal lines with a label
};

std::string svg(const Plot& plot);

struct Bar {
    std::string name;
    std::string colour;
    double value = 0.0;
};

/// One horizontal bar of all values, with a legend that tells value and share.
std::string svg_stack(const std::vector<Bar>& bars, const std::string& unit);

/// Text made safe for HTML and SVG.
std::string escaped(const std::string& text);

}  // namespace calot::app
