#include "haptics_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "haptics_figures.h"
#include "plot.h"
#include "report_style.h"

namespace calot::app {

namespace {

/// Upper ends of axes: round, a little beyond what is shown.
double round_up(double value, double step) {
    return step * std::max(1.0, std::ceil(value / step * 1.02));
}

std::string milliseconds(const Timing& t) {
    return fmt::format("{:.3f} ms median, {:.3f} ms at 99 %, {:.3f} ms at most", t.median_s * 1e3, t.p99_s * 1e3,
                       t.most_s * 1e3);
}

/// Force against depth in characters: * pressing, o releasing.
std::string character_plot(const std::vector<DepthPoint>& points, const TrialFigures& figures) {
    constexpr int kColumns = 60, kRows = 14;
    const double x_max_mm = round_up(figures.deepest_m * 1e3, 2.0), y_max_N = round_up(figures.greatest_tissue_N, 0.1);
    std::vector<std::string> lines(kRows, std::string(kColumns + 1, ' '));
    for (const DepthPoint& point : points) {
        const auto column = std::lround(point.depth_m * 1e3 / x_max_mm * kColumns);
        const auto row = std::lround(point.force_N / y_max_N * (kRows - 1));
        if (column < 0 || column > kColumns || row < 0 || row >= kRows) continue;
        char& place = lines[static_cast<std::size_t>(kRows - 1 - row)][static_cast<std::size_t>(column)];
        if (place != '*') place = point.pressing ? '*' : 'o';
    }
    std::string out = "  force [N]                                   * pressing   o releasing\n";
    for (int row = 0; row < kRows; ++row) {
        const bool labelled = row == 0 || row == kRows - 1;
        const std::string label = labelled ? fmt::format("{:.1f}", row == 0 ? y_max_N : 0.0) : "";
        out += fmt::format("{:>6} |{}\n", label, lines[static_cast<std::size_t>(row)]);
    }
    out += fmt::format("       +{}\n        0{:>{}}\n", std::string(kColumns + 1, '-'),
                       fmt::format("{:g} mm deep", x_max_mm), kColumns);
    return out;
}

std::string passivity_text(const HapticTrial& trial) {
    const haptics::ServoState& s = trial.status.servo;
    return fmt::format(
        "{} (least balance of the hand's energy {:+.4f} mJ, {:+.2f} allowed; {:.3f} mJ withheld in {} "
        "steps)",
        trial.passive() ? "passive: energy was never generated" : "NOT PASSIVE", s.least_absorbed_J * 1e3,
        -trial.options.servo.passivity.start_J * 1e3, s.withheld_J * 1e3, s.limited);
}

std::string joined(const std::vector<std::string>& parts) {
    std::string out;
    for (const std::string& part : parts) out += (out.empty() ? "" : ", ") + part;
    return out.empty() ? "none" : out;
}

nlohmann::ordered_json timing_json(const Timing& t) {
    if (t.count == 0) return nullptr;
    return {{"count", t.count},
            {"mean_ms", t.mean_s * 1e3},
            {"median_ms", t.median_s * 1e3},
            {"p99_ms", t.p99_s * 1e3},
            {"max_ms", t.most_s * 1e3}};
}

struct Axes {
    double x_max_mm, y_max_N;
    static constexpr double kWidth = 720, kHeight = 400, kLeft = 62, kRight = 20, kTop = 20, kBottom = 52;
    double x(double depth_mm) const { return kLeft + (kWidth - kLeft - kRight) * depth_mm / x_max_mm; }
    double y(double force_N) const { return kTop + (kHeight - kTop - kBottom) * (1.0 - force_N / y_max_N); }
};

/// One stroke for each stretch of pressing or releasing.
std::string strokes(const std::vector<DepthPoint>& points, const Axes& axes) {
    std::string out, path;
    bool pressing = true;
    auto end = [&] {
        if (!path.empty()) out += fmt::format("<path class=\"{}\" d=\"{}\"/>", pressing ? "press" : "release", path);
        path.clear();
    };
    constexpr std::size_t kEvery = 4;  // milliseconds: finer than a pixel
    for (std::size_t k = 0; k < points.size(); k += kEvery) {
        const DepthPoint& point = points[k];
        if (point.pressing != pressing) end();
        pressing = point.pressing;
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", axes.x(std::max(0.0, point.depth_m * 1e3)),
                            axes.y(point.force_N));
    }
    end();
    return out;
}

std::string time_plots(const HapticTrial& trial) {
    Plot force;
    force.title = "Force";
    force.unit = "N";
    force.y_floor = 0.05;
    force.x_max = std::max(1e-3, trial.rows.empty() ? 0.0 : trial.rows.back().time_s);
    Series tissue{"on the hook", "var(--blue)", {}}, hand{"on the hand", "var(--warm)", {}};
    Plot depth = force, energy = force;
    depth.title = "Height of the hook";
    depth.unit = "mm";
    energy.title = "Energy that the hand put in, net";
    energy.unit = "mJ";
    depth.y_floor = 1.0;
    Series height{"height", "var(--green)", {}}, joule{"energy", "var(--violet)", {}};
    for (const HapticRow& row : trial.rows) {
        tissue.points.emplace_back(row.time_s, glm::length(row.tissue_N));
        hand.points.emplace_back(row.time_s, glm::length(row.device_N));
        height.points.emplace_back(row.time_s, row.tip_m.z * 1e3);
        joule.points.emplace_back(row.time_s, row.absorbed_J * 1e3);
        if (row.pedal && (force.shaded.empty() || row.time_s - force.shaded.back().second > 2e-3))
            force.shaded.emplace_back(row.time_s, row.time_s);
        if (row.pedal) force.shaded.back().second = row.time_s;
    }
    depth.shaded = energy.shaded = force.shaded;
    force.series = {hand, tissue};
    depth.series = {height};
    energy.series = {joule};
    return "<div class=\"plots\">\n" + svg(force) + svg(depth) + svg(energy) + "</div>\n";
}

std::string figure(const std::string& value, const std::string& what) {
    return fmt::format("<div><b>{}</b><span>{}</span></div>", value, escaped(what));
}
std::string row(const std::string& what, const std::string& value) {
    return fmt::format("<tr><th>{}</th><td>{}</td></tr>", escaped(what), escaped(value));
}

std::string details(const HapticTrial& trial, const TrialFigures& figures) {
    std::string out = "<h2>The loop</h2>\n<table>";
    if (trial.virtual_clock) {
        out += row("clock", "virtual: rate, jitter and latency say nothing and were not measured");
    } else {
        out += row("rate", fmt::format("{:.1f} Hz, {} steps", 1.0 / trial.period.mean_s, trial.period.count));
        out += row("period", milliseconds(trial.period));
        out += row("from the hand's pose to the force that answers it", milliseconds(trial.latency));
        out += row("ticks of the simulation", milliseconds(trial.tick));
    }
    out += row("passivity", passivity_text(trial));
    out += row("faults", joined(figures.faults));
    out += row("clamped", fmt::format("{} steps at {:.2f} N", trial.status.servo.clamped,
                                      std::min(trial.options.servo.max_force_N, trial.status.device.max_force_N)));
    out += row("gain", fmt::format("{:g}", trial.options.servo.gain));
    out += row("coupling", fmt::format("{:g} N/m, {:g} N s/m", trial.options.coupling.stiffness_N_per_m,
                                       trial.options.coupling.damping_N_s_per_m));
    return out + "</table>\n";
}

}  // namespace

std::string trial_text(const HapticTrial& trial) {
    const std::vector<DepthPoint> points = force_against_depth(trial);
    const TrialFigures figures = figures_of(trial, points);
    std::string out = fmt::format("{}: {}, feeling \"{}\" for {:.2f} s{}\n\n", trial.status.device.name,
                                  trial.status.device.model, trial.scene, static_cast<double>(trial.rows.size()) * 1e-3,
                                  trial.virtual_clock ? " on a virtual clock" : "");
    if (trial.period.count > 0) {
        out += fmt::format("  rate       {:.1f} Hz over {} steps\n", 1.0 / trial.period.mean_s, trial.period.count);
        out += fmt::format("  period     {}\n", milliseconds(trial.period));
        out += fmt::format("  latency    {} (pose to force)\n", milliseconds(trial.latency));
        out += fmt::format("  ticks      {} (simulation)\n", milliseconds(trial.tick));
    }
    out += fmt::format("  passivity  {}\n", passivity_text(trial));
    out += fmt::format("  faults     {}\n", joined(figures.faults));
    out += fmt::format("  force      {:.3f} N on the hook at most, {:.3f} N on the hand\n", figures.greatest_tissue_N,
                       figures.greatest_device_N);
    if (figures.at_5mm_N > 0.0)
        out += fmt::format("  depth      {:.1f} mm at most; {:.3f} N at 5 mm{}\n", figures.deepest_m * 1e3,
                           figures.at_5mm_N,
                           figures.at_10mm_N > 0.0 ? fmt::format(", {:.3f} N at 10 mm", figures.at_10mm_N) : "");
    if (points.empty()) return out + "\nNothing was touched.\n";
    return out + "\n" + character_plot(points, figures);
}

std::string trial_json(const HapticTrial& trial) {
    const std::vector<DepthPoint> points = force_against_depth(trial);
    const TrialFigures figures = figures_of(trial, points);
    const haptics::ServoState& servo = trial.status.servo;
    nlohmann::ordered_json json;
    json["calot"] = CALOT_VERSION;
    json["device"] = {{"kind", trial.status.device.name},
                      {"model", trial.status.device.model},
                      {"max_force_N", trial.status.device.max_force_N},
                      {"connections", trial.status.connections}};
    json["scene"] = trial.scene;
    json["seconds"] = static_cast<double>(trial.rows.size()) * 1e-3;
    json["virtual_clock"] = trial.virtual_clock;
    json["interrupted"] = trial.interrupted;
    json["rate_Hz"] = trial.period.count > 0 ? nlohmann::ordered_json(1.0 / trial.period.mean_s) : nullptr;
    json["period"] = timing_json(trial.period);
    json["latency"] = timing_json(trial.latency);
    json["tick"] = timing_json(trial.tick);
    json["passivity"] = {{"passive", trial.passive()},
                         {"absorbed_J", servo.absorbed_J},
                         {"least_absorbed_J", servo.least_absorbed_J},
                         {"allowed_J", -trial.options.servo.passivity.start_J},
                         {"withheld_J", servo.withheld_J},
                         {"limited_steps", servo.limited}};
    json["faults"] = nlohmann::ordered_json::object();
    for (std::size_t k = 1; k < servo.faults.size(); ++k)
        json["faults"][haptics::describe(static_cast<haptics::Fault>(k))] = servo.faults[k];
    json["force"] = {{"gain", trial.options.servo.gain},
                     {"max_on_hook_N", figures.greatest_tissue_N},
                     {"max_on_hand_N", figures.greatest_device_N},
                     {"clamped_steps", servo.clamped},
                     {"at_5mm_N", figures.at_5mm_N},
                     {"at_10mm_N", figures.at_10mm_N}};
    json["max_depth_m"] = figures.deepest_m;
    json["notes"] = trial.notes;
    constexpr std::size_t kEvery = 10;
    for (std::size_t k = 0; k < points.size(); k += kEvery)
        json["force_against_depth"].push_back(
            {{"depth_mm", points[k].depth_m * 1e3}, {"force_N", points[k].force_N}, {"pressing", points[k].pressing}});
    return json.dump(2) + "\n";
}

std::string trial_svg(const HapticTrial& trial) {
    const std::vector<DepthPoint> points = force_against_depth(trial);
    const TrialFigures figures = figures_of(trial, points);
    const Axes axes{round_up(figures.deepest_m * 1e3, 2.0), round_up(figures.greatest_tissue_N, 0.05)};
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" class=\"depth\" role=\"img\" "
        "aria-label=\"force against depth\">\n<style>.depth{{--press:#b3372b;--release:#3c6fb0;--soft:#6b6358;"
        "--line:#e4ded5;background:none}}@media (prefers-color-scheme:dark){{.depth{{--press:#e5695b;--release:#7ba6df;"
        "--soft:#a89f92;--line:#38322a}}}}.depth text{{fill:var(--soft);font:13px system-ui,sans-serif}}"
        ".depth line{{stroke:var(--line)}}.depth path{{fill:none;stroke-width:2.2;stroke-linejoin:round}}"
        ".depth .press{{stroke:var(--press)}}.depth .release{{stroke:var(--release)}}"
        ".depth text.press{{fill:var(--press);stroke:none}}.depth text.release{{fill:var(--release);stroke:none}}"
        "</style>\n",
        Axes::kWidth, Axes::kHeight);
    const double y_step = axes.y_max_N > 0.5 ? 0.1 * std::ceil(axes.y_max_N / 0.8) : 0.05;
    for (double y = 0.0; y <= axes.y_max_N + 1e-9; y += y_step)
        out += fmt::format(
            "<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text x=\"{}\" y=\"{:.1f}\" "
            "text-anchor=\"end\">{:.2f}</text>\n",
            Axes::kLeft, Axes::kWidth - Axes::kRight, axes.y(y), axes.y(y), Axes::kLeft - 8, axes.y(y) + 4, y);
    const double x_step = std::max(1.0, std::ceil(axes.x_max_mm / 14.0));
    for (double x = 0.0; x <= axes.x_max_mm + 1e-9; x += x_step)
        out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g}</text>\n", axes.x(x),
                           Axes::kHeight - Axes::kBottom + 20, x);
    out += fmt::format(
        "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">depth of the hook below first touch "
        "[mm]</text>\n<text x=\"{}\" y=\"{}\">force [N]</text>\n",
        axes.x(0.5 * axes.x_max_mm), Axes::kHeight - 8, Axes::kLeft + 8, Axes::kTop + 14);
    out += fmt::format(
        "<text x=\"{0}\" y=\"{1}\" class=\"press\">pressing</text><text x=\"{0}\" y=\"{2}\" "
        "class=\"release\">releasing</text>\n",
        Axes::kLeft + 90, Axes::kTop + 14, Axes::kTop + 32);
    return out + strokes(points, axes) + "\n</svg>\n";
}

std::string trial_csv(const HapticTrial& trial) {
    std::string out =
        "time_s,tip_x_m,tip_y_m,tip_z_m,tissue_x_N,tissue_y_N,tissue_z_N,hand_x_N,hand_y_N,hand_z_N,absorbed_J,pedal,"
        "fault\n";
    for (const HapticRow& r : trial.rows)
        out += fmt::format("{:.4f},{:.7f},{:.7f},{:.7f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4e},{},{}\n",
                           r.time_s, r.tip_m.x, r.tip_m.y, r.tip_m.z, r.tissue_N.x, r.tissue_N.y, r.tissue_N.z,
                           r.device_N.x, r.device_N.y, r.device_N.z, r.absorbed_J, r.pedal ? 1 : 0,
                           haptics::describe(r.fault));
    return out;
}

std::string trial_html(const HapticTrial& trial) {
    const TrialFigures figures = figures_of(trial, force_against_depth(trial));
    std::string out = fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\"><title>The force in the hand · Calot</title>\n<style>{}"
        ".wide{{background:var(--card);border:1px solid var(--line);border-radius:12px;padding:16px;margin:0 0 14px}}"
        "</style></head>\n<body><main>\n<h1>The force in the hand</h1>\n<p class=\"lead\">{} ({}), feeling “{}” for "
        "{:.1f} s{}.</p>\n",
        kReportStyle, escaped(trial.status.device.name), escaped(trial.status.device.model), escaped(trial.scene),
        static_cast<double>(trial.rows.size()) * 1e-3, trial.virtual_clock ? ", on a virtual clock" : "");
    for (const std::string& note : trial.notes) out += fmt::format("<p class=\"note\">{}</p>\n", escaped(note));
    out += "<div class=\"figures\">";
    if (trial.period.count > 0) {
        out += figure(fmt::format("{:.0f} Hz", 1.0 / trial.period.mean_s), "rate of the servo loop");
        out += figure(fmt::format("{:.2f} ms", trial.period.p99_s * 1e3), "between steps, at 99 %");
        out += figure(fmt::format("{:.2f} ms", trial.latency.median_s * 1e3), "from pose to force (median)");
    }
    out += figure(trial.passive() ? "<em class=\"good\">passive</em>" : "<em class=\"bad\">not passive</em>",
                  "energy was never generated");
    out += figure(figures.faults.empty() ? "<em class=\"good\">none</em>"
                                         : fmt::format("<em class=\"bad\">{}</em>", figures.faults.size()),
                  "kinds of faults");
    out += figure(fmt::format("{:.3f} N", figures.greatest_tissue_N), "greatest force on the hook");
    out +=
        "</div>\n<h2>Force against depth</h2>\n<div class=\"wide\">" + trial_svg(trial) +
        "</div>\n<p>Pressing the hook into tissue and releasing it, as in Fig. 16 of Pan et al. 2019, in true newtons "
        "on the hook. That the way back runs below the way there is damping and friction.</p>\n<h2>Against "
        "time</h2>\n" +
        time_plots(trial) + details(trial, figures);
    return out + fmt::format(
                     "<footer>Calot {} · trace.csv has every millisecond, summary.json all figures</footer>\n"
                     "</main></body></html>\n",
                     CALOT_VERSION);
}

}  // namespace calot::app
