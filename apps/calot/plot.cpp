#include "plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace calot::app {

namespace {

constexpr double kWidth = 560, kHeight = 230;
constexpr double kLeft = 56, kRight = 14, kTop = 12, kBottom = 30;

/// A round step that divides `span` into about `count`.
double round_step(double span, int count) {
    const double raw = span / count;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    for (double factor : {1.0, 2.0, 2.5, 5.0})
        if (raw <= factor * power) return factor * power;
    return 10.0 * power;
}

/// Where y values lie: linear from 0 (or below) or by decades.
struct Scale {
    bool logarithmic = false;
    double low = 0.0, high = 1.0;
    std::vector<double> ticks;

    double share(double y) const {
        if (logarithmic) return std::log(y / low) / std::log(high / low);
        return (y - low) / (high - low);
    }
};

Scale make_scale(const Plot& plot) {
    double least = plot.logarithmic ? 1e300 : 0.0, most = plot.y_floor;
    for (const Series& series : plot.series)
        for (const auto& [x, y] : series.points) {
            if (!std::isfinite(y) || (plot.logarithmic && y <= 0.0)) continue;
            least = std::min(least, y);
            most = std::max(most, y);
        }
    Scale scale;
    scale.logarithmic = plot.logarithmic;
    if (plot.logarithmic) {
        if (!(most > 0.0) || least > most) least = 1.0, most = 10.0;
        scale.low = std::pow(10.0, std::floor(std::log10(least)));
        scale.high = std::pow(10.0, std::ceil(std::log10(most * 1.0001)));
        for (double y = scale.low; y <= scale.high * 1.0001; y *= 10.0) scale.ticks.push_back(y);
        return scale;
    }
    if (!(most > least)) most = least + 1.0;
    const double step = round_step(most - least, 4);
    scale.low = std::floor(least / step) * step;
    scale.high = std::ceil(most / step * 1.0001) * step;
    for (double y = scale.low; y <= scale.high + 0.5 * step; y += step)
        scale.ticks.push_back(std::abs(y) < 1e-9 * step ? 0.0 : y);
    return scale;
}

double x_at(const Plot& plot, double x) {
    return kLeft + (kWidth - kLeft - kRight) * x / plot.x_max;
}
double y_at(const Scale& scale, double y) {
    return kTop + (kHeight - kTop - kBottom) * (1.0 - std::clamp(scale.share(y), 0.0, 1.0));
}

/// Least and greatest of each pixel column, so that peaks survive thinning.
std::string path_of(const Plot& plot, const Series& series, const Scale& scale) {
    std::string path;
    bool pen_down = false;
    std::size_t k = 0;
    while (k < series.points.size()) {
        const double column = std::floor(x_at(plot, series.points[k].first));
        double low = 1e300, high = -1e300;
        bool gap = true;
        for (; k < series.points.size() && std::floor(x_at(plot, series.points[k].first)) == column; ++k) {
            const double y = series.points[k].second;
            if (!std::isfinite(y) || (plot.logarithmic && y <= 0.0)) continue;
            gap = false;
            low = std::min(low, y);
            high = std::max(high, y);
        }
        if (gap) {
            pen_down = false;
            continue;
        }
        path += fmt::format("{}{:.0f} {:.1f}", pen_down ? "L" : "M", column, y_at(scale, low));
        if (high > low) path += fmt::format("L{:.0f} {:.1f}", column, y_at(scale, high));
        pen_down = true;
    }
    return path;
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string out;
    for (char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string svg(const Plot& plot) {
    const Scale scale = make_scale(plot);
    std::string out =
        fmt::format("<figure class=\"plot\"><figcaption>{} <span>{}</span>", escaped(plot.title), escaped(plot.unit));
    if (plot.series.size() > 1)
        for (const Series& series : plot.series)
            out += fmt::format("<i style=\"--c:{}\">{}</i>", series.colour, escaped(series.name));
    out += fmt::format("</figcaption><svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} against time\">", kWidth,
                       kHeight, escaped(plot.title));
    for (const auto& [from, to] : plot.shaded)
        out += fmt::format("<rect class=\"pedal\" x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\"/>",
                           x_at(plot, from), kTop, std::max(1.0, x_at(plot, to) - x_at(plot, from)),
                           kHeight - kTop - kBottom);
    for (double tick : scale.ticks)
        out += fmt::format(
            "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text x=\"{}\" y=\"{:.1f}\" "
            "class=\"y\">{:g}</text>",
            kLeft, kWidth - kRight, y_at(scale, tick), y_at(scale, tick), kLeft - 7, y_at(scale, tick) + 4, tick);
    const double step = round_step(plot.x_max, 8);
    for (double x = 0.0; x <= plot.x_max * 1.0001; x += step)
        out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" class=\"x\">{:g}{}</text>", x_at(plot, x), kHeight - 10, x,
                           x + step > plot.x_max * 1.0001 ? " s" : "");
    for (const auto& [y, label] : plot.marks)
        if (scale.share(y) < 1.0 && scale.share(y) > 0.0)
            out += fmt::format(
                "<line class=\"mark\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text x=\"{}\" y=\"{:.1f}\" "
                "class=\"m\">{}</text>",
                kLeft, kWidth - kRight, y_at(scale, y), y_at(scale, y), kWidth - kRight - 4, y_at(scale, y) - 4,
                escaped(label));
    for (const Series& series : plot.series)
        out += fmt::format("<path d=\"{}\" style=\"stroke:{}\"/>", path_of(plot, series, scale), series.colour);
    return out + "</svg></figure>\n";
}

std::string svg_stack(const std::vector<Bar>& bars, const std::string& unit) {
    double total = 0.0;
    for (const Bar& bar : bars) total += std::max(0.0, bar.value);
    if (!(total > 0.0)) return "<p>No energy was delivered.</p>\n";
    constexpr double kBarWidth = 1000, kBarHeight = 36;
    std::string out = fmt::format(
        "<svg class=\"stack\" viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"energy\">",
        kBarWidth, kBarHeight);
    double x = 0.0;
    for (const Bar& bar : bars) {
        const double width = kBarWidth * std::max(0.0, bar.value) / total;
        out += fmt::format("<rect x=\"{:.2f}\" width=\"{:.2f}\" height=\"{}\" style=\"fill:{}\"/>", x, width,
                           kBarHeight, bar.colour);
        x += width;
    }
    out += "</svg>\n<ul class=\"legend\">";
    for (const Bar& bar : bars)
        out += fmt::format("<li style=\"--c:{}\">{}<b>{:.3g} {}</b><span>{:.1f} %</span></li>", bar.colour,
                           escaped(bar.name), bar.value, unit, 100.0 * bar.value / total);
    return out + "</ul>\n";
}

}  // namespace calot::app
