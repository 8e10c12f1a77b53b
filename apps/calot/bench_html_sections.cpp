// Kernels, whole ticks and growth on the page.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench_chart.h"
#include "bench_html.h"
#include "plot.h"

namespace calot::app {

namespace {

constexpr std::array<const char*, simulation::kStages> kStageColours{"var(--blue)",  "var(--teal)",  "var(--gold)",
                                                                     "var(--warm)",  "var(--red)",   "var(--grey)",
                                                                     "var(--green)", "var(--violet)"};

std::string threads_text(int threads) {
    return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
}

/// Ticks per bin, each bin a step.
ChartSeries histogram_series(const TickResult& tick, std::size_t stage, const std::string& name,
                             const std::string& colour, double from_us = 0.0) {
    ChartSeries series;
    series.name = name;
    series.colour = colour;
    series.filled = true;
    const auto& bins = tick.histogram[stage];
    double all = 0.0;
    for (const std::int64_t count : bins) all += static_cast<double>(count);
    std::size_t first = 0, last = bins.size();
    while (first < bins.size() && (bins[first] == 0 || tick.bin_edges_us[first] < from_us)) ++first;
    while (last > first && bins[last - 1] == 0) --last;
    for (std::size_t k = first; k < last; ++k) {
        const double share = 100.0 * static_cast<double>(bins[k]) / std::max(all, 1.0);
        series.points.emplace_back(tick.bin_edges_us[k], share);
        series.points.emplace_back(tick.bin_edges_us[k + 1], share);
    }
    return series;
}

std::string stage_table(const TickResult& tick) {
    std::string out =
        "<div class=\"scroll\"><table class=\"wide\"><tr><th>stage</th><th>mean</th><th>median</th><th>99 %</th>"
        "<th>longest</th></tr>";
    for (std::size_t k = 0; k < simulation::kStages; ++k)
        out +=
            fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>", simulation::kStageNames[k],
                        time_text(tick.stages_us[k].mean), time_text(tick.stages_us[k].median),
                        time_text(tick.stages_us[k].p99), time_text(tick.stages_us[k].max));
    return out + "</table></div>\n";
}

std::string tick_charts(const TickResult& tick) {
    Chart whole;
    whole.title = "How long ticks take";
    whole.x_label = "µs";
    whole.y_label = "% of ticks";
    whole.log_x = true;
    whole.series.push_back(histogram_series(tick, simulation::kStages, "", "var(--blue)"));
    whole.x_marks.emplace_back(tick.p99_us, "99 %");
    whole.x_marks.emplace_back(1000.0, "1 ms");

    Chart stages;
    stages.title = "Stages, where they have work";
    stages.x_label = "µs";
    stages.y_label = "% of ticks";
    stages.log_x = true;
    for (std::size_t k = 0; k < simulation::kStages; ++k)
        if (tick.stages_us[k].max > 1.0) {
            ChartSeries series = histogram_series(tick, k, simulation::kStageNames[k], kStageColours[k], 0.9);
            series.filled = false;
            stages.series.push_back(std::move(series));
        }

    Chart course;
    course.title = "Along the scene";
    course.x_label = "simulated s";
    course.y_label = "µs a tick";
    ChartSeries median{"median", "var(--blue)", {}, true, false, false, false}, p99{"99 %", "var(--warm)", {}};
    for (std::size_t k = 0; k < tick.block_median_us.size(); ++k) {
        const double t = 0.1 * (static_cast<double>(k) + 0.5);
        median.points.emplace_back(t, tick.block_median_us[k]);
        p99.points.emplace_back(t, tick.block_p99_us[k]);
    }
    course.series = {p99, median};
    return "<div class=\"plots\">" + svg(whole) + svg(course) + svg(stages) + stage_table(tick) + "</div>\n";
}

std::string worst_table(const TickResult& tick) {
    std::string out = "<h3>The longest ticks, and why</h3><table class=\"worst\">";
    for (std::size_t k = 0; k < std::min<std::size_t>(3, tick.worst.size()); ++k)
        out += fmt::format("<tr><td>{}</td><td>at {:.3f} s: {}</td></tr>", time_text(tick.worst[k].us),
                           1e-3 * static_cast<double>(tick.worst[k].tick), escaped(tick.worst[k].cause));
    return out + "</table>\n";
}

}  // namespace

std::string tick_section(const BenchResults& results) {
    if (results.tick.empty()) return "";
    std::string out =
        "<h2>Whole ticks</h2><div class=\"scroll\"><table "
        "class=\"wide\"><tr><th>scene</th><th>phyxels</th><th>hexels</th>"
        "<th>threads</th><th>simulated</th><th>median</th><th>99 %</th><th>99.9 %</th><th>longest</th>"
        "<th>late</th><th>99 % of least</th></tr>";
    for (const TickResult& t : results.tick) {
        const char* look = t.target_p99_us <= 0.0 ? "" : t.p99_us <= t.target_p99_us ? "good" : "bad";
        out += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.1f} s</td><td>{}</td>"
            "<td class=\"{}\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            escaped(t.title), grouped_number(t.phyxels), grouped_number(t.hexels), t.threads, t.simulated_s,
            time_text(t.median_us), look, time_text(t.p99_us), time_text(t.p999_us), time_text(t.max_us), t.late,
            t.passes > 1 ? time_text(t.least.p99) : "");
    }
    out +=
        "</table></div><p>Late are ticks that took longer than the millisecond that they simulate. A scene may be run "
        "several times: every pass does the same work in a tick, and what the shortest took is the program's own; "
        "figures but "
        "the last are of the first pass.</p>\n";
    for (const TickResult& t : results.tick) {
        out += fmt::format("<h3>{}, {}</h3><p>{} hexels went, at most {} in a second; {} links were severed.</p>",
                           escaped(t.title), threads_text(t.threads), grouped_number(t.removed),
                           grouped_number(t.most_removed_in_a_second), grouped_number(t.severed));
        out += tick_charts(t) + worst_table(t);
    }
    return out;
}

std::string device_section(const BenchResults& results) {
    const DeviceBench& device = results.device;
    if (device.name.empty()) return "";
    std::string out = fmt::format(
        "<h2>On the device</h2><p>{}. A launch takes {}, with four bytes back {}; {:.1f} GB/s go up, {:.1f} down, "
        "{:.1f} "
        "within the device.</p><div class=\"scroll\"><table class=\"wide\"><tr><th></th><th>size</th><th>whole</th>"
        "<th>kernels</th><th>transfers</th><th>launches</th><th>waits</th><th>bytes up</th><th>bytes down</th></tr>",
        escaped(device.name), time_text(device.launch_us), time_text(device.round_trip_us), device.up_GB_per_s,
        device.down_GB_per_s, device.copy_GB_per_s);
    for (const DeviceCost& c : device.costs)
        out += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.0f}</td>"
            "<td>{:.0f}</td></tr>",
            escaped(c.name), grouped_number(c.size), time_text(c.us), time_text(c.kernels_us),
            time_text(c.transfers_us), c.launches, c.reads, c.bytes_up, c.bytes_down);
    return out +
           "</table></div><p>Averages of a call or a tick. The whole is by the host's clock, waiting included; ticks "
           "are measured here with the device's clocks on, which costs some of it.</p>\n";
}

std::string kernels_section(const BenchResults& results) {
    if (results.kernels.empty()) return "";
    double low = 1e300, high = 0.0;
    for (const KernelResult& k : results.kernels)
        for (const double us : {k.us, k.reference_us, k.floor_us, k.target_us})
            if (us > 0.0) low = std::min(low, us), high = std::max(high, us);
    std::vector<BarRow> rows;
    for (const KernelResult& k : results.kernels) {
        BarRow row;
        row.name = k.name;
        row.detail = fmt::format("{} {}, {}", grouped_number(k.size), k.unit, threads_text(k.threads));
        std::string label = time_text(k.us);
        if (k.target_us > 0.0) label += fmt::format(" (to reach: {})", time_text(k.target_us));
        row.bars.push_back({label, "var(--blue)", k.us});
        if (k.floor_us > 0.0)
            row.bars.push_back({fmt::format("{}, floor by its {}: {:.0f} % of that speed", time_text(k.floor_us),
                                            k.floor_of_bytes ? "bytes" : "operations", 100.0 * k.floor_us / k.us),
                                "var(--green)", k.floor_us});
        if (k.reference_us > 0.0)
            row.bars.push_back({fmt::format("{}, scalar reference: {:.1f} times as long", time_text(k.reference_us),
                                            k.reference_us / k.us),
                                "var(--grey)", k.reference_us});
        rows.push_back(std::move(row));
    }
    return "<h2>Kernels</h2><p>Least time of a call over many short repetitions, on a logarithmic scale. The floor is "
           "what the operations or the bytes of the kernel must take at the rates measured in the same run.</p>"
           "<div class=\"keys\"><i style=\"--c:var(--blue)\">Calot</i><i style=\"--c:var(--green)\">floor</i>"
           "<i style=\"--c:var(--grey)\">scalar reference, one thread</i></div>" +
           bar_chart(rows, true, 0.5 * low, high);
}

std::string scale_section(const BenchResults& results) {
    const ScaleResult& scale = results.scale;
    if (scale.sizes.empty()) return "";
    Chart chart;
    chart.title = fmt::format("Time of a tick, {}", threads_text(scale.threads));
    chart.x_label = "hexels, all of them warm";
    chart.y_label = "µs";
    chart.log_x = chart.log_y = true;
    ChartSeries whole{"whole tick", "var(--ink)", {}, true, true, false, false};
    for (std::size_t k = 0; k < scale.sizes.size(); ++k)
        whole.points.emplace_back(static_cast<double>(scale.sizes[k]), scale.us[k]);
    chart.series.push_back(whole);
    for (const simulation::Stage stage :
         {simulation::Stage::deformation, simulation::Stage::heat, simulation::Stage::electric}) {
        const auto s = static_cast<std::size_t>(stage);
        ChartSeries series{simulation::kStageNames[s], kStageColours[s], {}, true, true, false, false};
        for (std::size_t k = 0; k < scale.sizes.size(); ++k)
            series.points.emplace_back(static_cast<double>(scale.sizes[k]), scale.stages_us[s][k]);
        chart.series.push_back(std::move(series));
    }
    chart.y_marks.emplace_back(1000.0, "1 ms");
    std::string out = fmt::format(
        "<h2>Growth</h2><p>A block of fat, warm all through, under a hook with current. Over the larger half of the "
        "sizes the time of a tick grows as n<sup>{:.2f}</sup>.</p><div class=\"plots\">",
        scale.exponent);
    out += svg(chart) +
           "<div class=\"scroll\"><table class=\"wide\"><tr><th>hexels</th><th>a tick</th><th>a hexel</th></tr>";
    for (std::size_t k = 0; k < scale.sizes.size(); ++k)
        out += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.2f} ns</td></tr>", grouped_number(scale.sizes[k]),
                           time_text(scale.us[k]), 1e3 * scale.us[k] / static_cast<double>(scale.sizes[k]));
    return out + "</table></div></div>\n";
}

}  // namespace calot::app
