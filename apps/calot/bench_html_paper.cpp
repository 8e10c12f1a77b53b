// The paper's tables and figures on the page.

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "bench_chart.h"
#include "bench_html.h"
#include "plot.h"

namespace calot::app {

namespace {

std::string ms_text(double ms) {
    return ms >= 1.0 ? fmt::format("{:.2f} ms", ms) : fmt::format("{:.1f} µs", ms * 1e3);
}

std::string table_1(const BenchResults& results) {
    std::map<std::int64_t, std::array<double, 4>> by_size;  // ours, ours scalar, paper, rival
    for (const PaperRow& row : results.paper) {
        if (row.table != "Table 1") continue;
        auto& values = by_size[row.size];
        if (row.stage == "deformation step")
            values[0] = row.ours_ms, values[2] = row.published_ms;
        else if (row.published_ms > 0.0)
            values[3] = row.published_ms;
        else
            values[1] = row.ours_ms;
    }
    if (by_size.empty()) return "";
    std::vector<BarRow> rows;
    for (const auto& [size, v] : by_size)
        rows.push_back(
            {grouped_number(size) + " phyxels",
             "one step",
             {{fmt::format("{}, Calot, one core", ms_text(v[0])), "var(--blue)", v[0]},
              {fmt::format("{}, Calot's scalar reference", ms_text(v[1])), "var(--grey)", v[1]},
              {fmt::format("{}, the paper, on a GPU: {:.0f}×", ms_text(v[2]), v[2] / v[0]), "var(--warm)", v[2]},
              {fmt::format("{}, its CPU rival: {:.0f}×", ms_text(v[3]), v[3] / v[0]), "var(--red)", v[3]}}});
    return "<h3>Table 1: one step of deformation</h3><p>Published figures are of a GTX 1050 Ti and a CPU of 2019. "
           "Scale: "
           "logarithmic.</p>" +
           bar_chart(rows, true, 0.004, 120.0);
}

std::string table_2(const BenchResults& results) {
    std::vector<std::int64_t> sizes;
    std::vector<std::string> stages;
    std::map<std::pair<std::string, std::int64_t>, PaperRow> cells;
    for (const PaperRow& row : results.paper) {
        if (row.table != "Table 2") continue;
        if (std::find(sizes.begin(), sizes.end(), row.size) == sizes.end()) sizes.push_back(row.size);
        if (std::find(stages.begin(), stages.end(), row.stage) == stages.end()) stages.push_back(row.stage);
        cells[{row.stage, row.size}] = row;
    }
    if (sizes.empty()) return "";
    std::string out =
        "<h3>Table 2: stages of a tick while burning</h3><p>Mean over ticks with current. The paper's whole loop runs "
        "at "
        "about 40 Hz, 25 ms, for one visual frame; ours for every millisecond.</p><div class=\"scroll\"><table "
        "class=\"wide\"><tr><th>stage</th>";
    for (const std::int64_t size : sizes) out += fmt::format("<th>{} hexels</th>", grouped_number(size));
    out += "<th>the paper</th></tr>";
    for (const std::string& stage : stages) {
        double published = 0.0;
        out += fmt::format("<tr><td>{}</td>", escaped(stage));
        for (const std::int64_t size : sizes) {
            const PaperRow& row = cells[{stage, size}];
            published = std::max(published, row.published_ms);
            out += fmt::format("<td>{}</td>", ms_text(row.ours_ms));
        }
        out += fmt::format("<td>{}</td></tr>", published > 0.0 ? ms_text(published) : std::string("–"));
    }
    return out + "</table></div>\n";
}

std::string pictures(const BenchResults& results, const char* figure, const char* heading, const char* look) {
    std::string out;
    for (const Picture64& picture : results.pictures)
        if (picture.figure == figure)
            out += fmt::format(
                "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>",
                escaped(picture.caption), picture.base64);
    return out.empty() ? "" : fmt::format("<h3>{}</h3><div class=\"pictures {}\">{}</div>\n", heading, look, out);
}

std::string press(const BenchResults& results) {
    if (results.press.empty()) return "";
    constexpr std::array<const char*, 4> kColours{"var(--green)", "var(--blue)", "var(--warm)", "var(--red)"};
    Chart time, depth;
    time.title = "Force on the hook";
    time.x_label = "s";
    time.y_label = "N";
    depth.title = "Force against depth";
    depth.x_label = "mm, the lower end of the wire below the surface at rest";
    depth.y_label = "N";
    for (std::size_t k = 0; k < results.press.size(); ++k) {
        ChartSeries a{results.press[k].name, kColours[k % 4], {}}, b = a;
        for (const auto& [t, d, f] : results.press[k].points) {
            a.points.emplace_back(t, f);
            b.points.emplace_back(d, f);
        }
        time.series.push_back(std::move(a));
        depth.series.push_back(std::move(b));
    }
    return "<h3>Fig. 16: pressing and releasing</h3><p>The hook presses into a block of fat (5 kPa), holds, and lets "
           "go. "
           "These are true newtons; the paper's 0 to 8 N would need tissue of 130 to 500 kPa.</p><div "
           "class=\"plots\">" +
           svg(time) + svg(depth) + "</div>\n";
}

}  // namespace

std::string paper_section(const BenchResults& results) {
    const std::string body =
        table_1(results) + table_2(results) +
        pictures(results, "Figs. 13 and 14", "Figs. 13 and 14: the same stroke with and without physics", "three") +
        pictures(results, "Fig. 15", "Fig. 15: what 100 burnt hexels leave, by density", "") + press(results);
    if (body.empty()) return "";
    return "<h2>Against the paper</h2><p>Pan et al. 2019, <i>Real-time simulation of electrocautery procedure using "
           "meshfree methods in laparoscopic cholecystectomy</i> (doi 10.1007/s00371-019-01680-z).</p>" +
           body;
}

}  // namespace calot::app
