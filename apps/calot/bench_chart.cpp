#include "bench_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plot.h"

namespace calot::app {

namespace {

constexpr double kLeft = 62, kRight = 16, kTop = 12, kBottom = 42;

double round_step(double span, int count) {
    const double raw = span / count, power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 2.5, 5.0})
        if (raw <= factor * power * 1.0001) return factor * power;
    return 10.0 * power;
}

struct Axis {
    bool logarithmic = false;
    double low = 0.0, high = 1.0;
    std::vector<double> ticks;

    double share(double v) const {
        return logarithmic ? std::log(std::max(v, 1e-300) / low) / std::log(high / low) : (v - low) / (high - low);
    }
};

Axis make_axis(double least, double most, bool logarithmic, int count) {
    Axis axis;
    axis.logarithmic = logarithmic;
    if (logarithmic) {
        axis.low = std::pow(10.0, std::floor(std::log10(least) + 1e-9));
        axis.high = std::pow(10.0, std::ceil(std::log10(most) - 1e-9));
        if (axis.high <= axis.low) axis.high = 10.0 * axis.low;
        for (double v = axis.low; v <= axis.high * 1.0001; v *= 10.0) axis.ticks.push_back(v);
        return axis;
    }
    least = std::min(least, 0.0);
    if (!(most > least)) most = least + 1.0;
    const double step = round_step(most - least, count);
    axis.low = std::floor(least / step) * step;
    axis.high = std::ceil(most / step - 1e-6) * step;
    for (double v = axis.low; v <= axis.high + 0.5 * step; v += step)
        axis.ticks.push_back(std::abs(v) < 1e-9 * step ? 0.0 : v);
    return axis;
}

/// 1000000 -> "1M"
std::string tick_text(double v) {
    if (std::abs(v) >= 1e6) return fmt::format("{:g}M", v * 1e-6);
    if (std::abs(v) >= 1e4) return fmt::format("{:g}k", v * 1e-3);
    return fmt::format("{:g}", v);
}

struct Frame {
    const Chart& chart;
    Axis x, y;

    double px(double v) const { return kLeft + (chart.width - kLeft - kRight) * std::clamp(x.share(v), 0.0, 1.0); }
    double py(double v) const {
        return kTop + (chart.height - kTop - kBottom) * (1.0 - std::clamp(y.share(v), 0.0, 1.0));
    }
};

Frame make_frame(const Chart& chart) {
    double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
    auto take = [](double v, bool logarithmic, double& low, double& high) {
        if (!std::isfinite(v) || (logarithmic && v <= 0.0)) return;
        low = std::min(low, v);
        high = std::max(high, v);
    };
    for (const ChartSeries& series : chart.series)
        for (const auto& [x, y] : series.points) {
            take(x, chart.log_x, x0, x1);
            take(y, chart.log_y, y0, y1);
        }
    for (const auto& [y, label] : chart.y_marks) take(y, chart.log_y, y0, y1);
    for (const auto& [x, label] : chart.x_marks) take(x, chart.log_x, x0, x1);
    if (x0 > x1) x0 = 1.0, x1 = 10.0;
    if (y0 > y1) y0 = 1.0, y1 = 10.0;
    return {chart, make_axis(x0, x1, chart.log_x, 7), make_axis(y0, y1, chart.log_y, 4)};
}

std::string grid(const Frame& f) {
    const Chart& c = f.chart;
    std::string out;
    for (const double v : f.y.ticks)
        out += fmt::format(
            "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text class=\"y\" x=\"{}\" "
            "y=\"{:.1f}\">{}</text>",
            kLeft, c.width - kRight, f.py(v), f.py(v), kLeft - 7, f.py(v) + 4, tick_text(v));
    for (const double v : f.x.ticks)
        out += fmt::format(
            "<line class=\"grid\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{}\" y2=\"{}\"/><text class=\"x\" x=\"{:.1f}\" "
            "y=\"{}\">{}</text>",
            f.px(v), f.px(v), kTop, c.height - kBottom, f.px(v), c.height - kBottom + 16, tick_text(v));
    out += fmt::format("<text class=\"x\" x=\"{:.1f}\" y=\"{}\">{}</text>", 0.5 * (kLeft + c.width - kRight),
                       c.height - 6, escaped(c.x_label));
    return out;
}

std::string marks(const Frame& f) {
    const Chart& c = f.chart;
    std::string out;
    for (const auto& [v, label] : c.y_marks)
        out += fmt::format(
            "<line class=\"mark\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text class=\"m\" x=\"{}\" "
            "y=\"{:.1f}\">{}</text>",
            kLeft, c.width - kRight, f.py(v), f.py(v), c.width - kRight - 4, f.py(v) - 4, escaped(label));
    for (const auto& [v, label] : c.x_marks) {
        const bool right = f.px(v) > 0.6 * c.width;  // the label on the side that has room
        out += fmt::format(
            "<line class=\"mark\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{}\" y2=\"{}\"/><text class=\"{}\" x=\"{:.1f}\" "
            "y=\"{}\">{}</text>",
            f.px(v), f.px(v), kTop, c.height - kBottom, right ? "m" : "s", f.px(v) + (right ? -5 : 5), kTop + 11,
            escaped(label));
    }
    return out;
}

std::string draw(const Frame& f, const ChartSeries& series) {
    std::string path, dots;
    double first_x = 0.0, last_x = 0.0;
    bool pen = false;
    for (const auto& [x, y] : series.points) {
        if (!std::isfinite(y) || (f.chart.log_y && y <= 0.0) || (f.chart.log_x && x <= 0.0)) {
            pen = false;
            continue;
        }
        if (path.empty()) first_x = f.px(x);
        last_x = f.px(x);
        path += fmt::format("{}{:.1f} {:.1f}", pen ? "L" : "M", f.px(x), f.py(y));
        pen = true;
        if (series.markers)
            dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.6\" style=\"fill:{}\"/>", f.px(x), f.py(y),
                                series.colour);
    }
    std::string out;
    const double base = f.chart.height - kBottom;
    if (series.filled && !path.empty())
        out += fmt::format("<path d=\"{}L{:.1f} {}L{:.1f} {}Z\" style=\"fill:{};stroke:none;opacity:.18\"/>", path,
                           last_x, base, first_x, base, series.colour);
    if (series.line && !path.empty())
        out += fmt::format("<path d=\"{}\" style=\"stroke:{}{}\"/>", path, series.colour,
                           series.dashed ? ";stroke-dasharray:5 5" : "");
    return out + dots;
}

}  // namespace

std::string svg(const Chart& chart) {
    const Frame f = make_frame(chart);
    std::string out = fmt::format("<figure class=\"plot\"><figcaption>{} <span>{}</span>", escaped(chart.title),
                                  escaped(chart.y_label));
    if (chart.series.size() > 1)
        for (const ChartSeries& series : chart.series)
            if (!series.name.empty())
                out += fmt::format("<i style=\"--c:{}\">{}</i>", series.colour, escaped(series.name));
    out += fmt::format("</figcaption><svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", chart.width,
                       chart.height, escaped(chart.title));
    out += grid(f);
    for (const ChartSeries& series : chart.series) out += draw(f, series);
    return out + marks(f) + "</svg></figure>\n";
}

std::string bar_chart(const std::vector<BarRow>& rows, bool logarithmic, double low, double high) {
    std::string out = "<div class=\"bars\">";
    for (const BarRow& row : rows) {
        out += fmt::format("<div class=\"bar-name\">{}<span>{}</span></div><div class=\"bar-set\">", escaped(row.name),
                           escaped(row.detail));
        for (const BarRow::Bar& bar : row.bars) {
            const double share = logarithmic ? std::log(std::max(bar.value, low) / low) / std::log(high / low)
                                             : (bar.value - low) / (high - low);
            out += fmt::format("<div class=\"bar\"><i style=\"width:{:.2f}%;background:{}\"></i><b>{}</b></div>",
                               58.0 * std::clamp(share, 0.004, 1.0), bar.colour, escaped(bar.label));
        }
        out += "</div>";
    }
    return out + "</div>\n";
}

}  // namespace calot::app
