#include "xy_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "plot.h"

namespace calot::app {

namespace {

constexpr double kWidth = 560, kHeight = 300;
constexpr double kLeft = 66, kRight = 18, kTop = 14, kBottom = 46;
constexpr std::array kColours{"var(--blue)",   "var(--warm)", "var(--green)",
                              "var(--violet)", "var(--teal)", "var(--gold)"};

/// One axis: from values to shares of its length.
struct Axis {
    double low = 0.0, high = 1.0;
    bool logarithmic = false;
    std::vector<double> ticks;

    double share(double v) const {
        return logarithmic ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
    }
    bool holds(double v) const { return std::isfinite(v) && (!logarithmic || v > 0.0); }
};

double round_step(double span, int count) {
    const double raw = span / count, power = std::pow(10.0, std::floor(std::log10(raw)));
    for (double factor : {1.0, 2.0, 2.5, 5.0})
        if (raw <= factor * power) return factor * power;
    return 10.0 * power;
}

Axis linear_axis(double least, double most) {
    if (!(most > least)) {
        const double pad = least == 0.0 ? 1.0 : 0.05 * std::abs(least);
        least -= pad;
        most += pad;
    }
    Axis axis;
    const double step = round_step(most - least, 5);
    axis.low = std::floor(least / step + 1e-9) * step;
    axis.high = std::ceil(most / step - 1e-9) * step;
    for (double v = axis.low; v <= axis.high + 0.5 * step; v += step)
        axis.ticks.push_back(std::abs(v) < 1e-9 * step ? 0.0 : v);
    return axis;
}

/// Decades, and 2 and 5 between them where there are few.
Axis logarithmic_axis(double least, double most) {
    Axis axis;
    axis.logarithmic = true;
    axis.low = least / 1.25;
    axis.high = most * 1.25;
    const bool few = most / least < 300.0;
    for (double decade = std::pow(10.0, std::floor(std::log10(axis.low))); decade <= axis.high; decade *= 10.0)
        for (const double factor : {1.0, 2.0, 5.0})
            if ((few || factor == 1.0) && decade * factor >= axis.low && decade * factor <= axis.high)
                axis.ticks.push_back(decade * factor);
    return axis;
}

/// An axis over all curves; `pick` takes a point's x or y.
template <class Pick>
Axis make_axis(const validation::Figure& figure, const Pick& pick) {
    double least = 1e300, most = -1e300;
    for (const validation::Curve& curve : figure.curves)
        for (const auto& point : curve.points) {
            const double v = pick(point);
            if (!std::isfinite(v) || (figure.logarithmic && v <= 0.0)) continue;
            least = std::min(least, v);
            most = std::max(most, v);
        }
    if (least > most) least = figure.logarithmic ? 0.1 : 0.0, most = 1.0;
    if (figure.logarithmic) return logarithmic_axis(least, most);
    if (least > 0.0 && least < 0.4 * most) least = 0.0;  // near enough to be worth showing
    return linear_axis(least, most);
}

struct Frame {
    Axis x, y;
    double at_x(double v) const { return kLeft + (kWidth - kLeft - kRight) * x.share(v); }
    double at_y(double v) const { return kTop + (kHeight - kTop - kBottom) * (1.0 - y.share(v)); }
};

std::string grid(const Frame& frame, const validation::Figure& figure) {
    std::string out;
    for (double tick : frame.y.ticks)
        out += fmt::format(
            "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text x=\"{}\" y=\"{:.1f}\" "
            "class=\"y\">{:g}</text>",
            kLeft, kWidth - kRight, frame.at_y(tick), frame.at_y(tick), kLeft - 7, frame.at_y(tick) + 4, tick);
    for (double tick : frame.x.ticks)
        out += fmt::format(
            "<line class=\"grid\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{}\" y2=\"{}\"/><text x=\"{:.1f}\" y=\"{}\" "
            "class=\"x\">{:g}</text>",
            frame.at_x(tick), frame.at_x(tick), kTop, kHeight - kBottom, frame.at_x(tick), kHeight - kBottom + 17,
            tick);
    out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" class=\"x label\">{}</text>", 0.5 * (kLeft + kWidth - kRight),
                       kHeight - 8, escaped(figure.x_label));
    return out;
}

std::string draw(const Frame& frame, const validation::Curve& curve, const std::string& colour) {
    std::string out, path;
    bool down = false;
    for (const auto& [x, y] : curve.points) {
        if (!frame.x.holds(x) || !frame.y.holds(y)) {
            down = false;
            continue;
        }
        if (curve.marks)
            out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.4\" style=\"fill:{}\"/>", frame.at_x(x),
                               frame.at_y(y), colour);
        else
            path += fmt::format("{}{:.1f} {:.1f}", down ? "L" : "M", frame.at_x(x), frame.at_y(y));
        down = true;
    }
    if (!path.empty()) out = fmt::format("<path d=\"{}\" style=\"stroke:{}\"/>", path, colour) + out;
    return out;
}

}  // namespace

std::string svg(const validation::Figure& figure) {
    const Frame frame{make_axis(figure, [](const auto& p) { return p.first; }),
                      make_axis(figure, [](const auto& p) { return p.second; })};
    std::string legend, drawn;
    std::size_t colour = 0;
    std::string last = kColours[0];
    for (const validation::Curve& curve : figure.curves) {
        // Nameless marks belong to a line before them, in their order.
        if (!curve.name.empty()) {
            last = kColours[colour++ % kColours.size()];
            legend += fmt::format("<i style=\"--c:{}\">{}</i>", last, escaped(curve.name));
        }
        drawn += draw(frame, curve, last);
    }
    return fmt::format(
        "<figure class=\"plot\"><figcaption>{} <span>{}</span>{}</figcaption><svg viewBox=\"0 0 {} {}\" role=\"img\" "
        "aria-label=\"{}\">{}{}</svg></figure>\n",
        escaped(figure.title), escaped(figure.y_label), legend, kWidth, kHeight, escaped(figure.title),
        grid(frame, figure), drawn);
}

std::string svg_band(const validation::Case& result) {
    constexpr double kBand = 420, kThick = 34;
    const auto [low, high] = *result.range;
    const double least = std::min(low, result.value), most = std::max(high, result.value);
    const double pad = std::max(0.18 * (most - least), 0.05 * std::abs(most) + 1e-9);
    const auto at = [&](double v) { return 8.0 + (kBand - 16.0) * (v - least + pad) / (most - least + 2.0 * pad); };
    const bool inside = result.verdict == validation::Verdict::band;
    return fmt::format(
        "<svg class=\"band\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"band\"><line class=\"axis\" x1=\"0\" "
        "x2=\"{}\" y1=\"13\" y2=\"13\"/><rect x=\"{:.1f}\" y=\"6\" width=\"{:.1f}\" height=\"14\" rx=\"3\"/>"
        "<circle cx=\"{:.1f}\" cy=\"13\" r=\"6\" class=\"{}\"/><text class=\"x\" x=\"{:.1f}\" y=\"32\">{:.3g}</text>{}"
        "</svg>",
        kBand, kThick, kBand, at(low), std::max(2.0, at(high) - at(low)), at(result.value), inside ? "in" : "out",
        at(low), low,
        high > low ? fmt::format("<text class=\"x\" x=\"{:.1f}\" y=\"32\">{:.3g}</text>", at(high), high)
                   : std::string());
}

}  // namespace calot::app
