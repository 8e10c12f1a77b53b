#pragma once
// Charts of a benchmark as inline SVG: lines and markers on linear or logarithmic axes, and rows of bars.

#include <string>
#include <utility>
#include <vector>

namespace calot::app {

struct ChartSeries {
    std::string name;
    std::string colour;  ///< CSS
    std::vector<std::pair<double, double>> points;
    bool line = true, markers = false, dashed = false, filled = false;
};

struct Chart {
    std::string title, x_label, y_label;
    bool log_x = false, log_y = false;
    std::vector<ChartSeries> series;
    std::vector<std::pair<double, std::string>> x_marks, y_marks;  ///< lines across, with a label
    double width = 560, height = 260;
};

std::string svg(const Chart& chart);

/// A row of a bar chart: several bars under one name.
struct BarRow {
    std::string name, detail;
    struct Bar {
        std::string label, colour;
        double value = 0.0;
    };
    std::vector<Bar> bars;
};
/// Horizontal bars; logarithmic ones begin at `low`.
std::string bar_chart(const std::vector<BarRow>& rows, bool logarithmic, double low, double high);

}  // namespace calot::app
