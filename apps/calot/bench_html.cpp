#include "bench_html.h"

#include <cmath>

#include <fmt/format.h>

#include "bench_chart.h"
#include "plot.h"
#include "report_style.h"

namespace calot::app {

namespace {

constexpr const char* kBenchStyle = R"css(
.bars{display:grid;grid-template-columns:minmax(150px,260px) 1fr;gap:10px 18px;align-items:center;margin:14px 0 22px}
.bar-name{font-weight:600;line-height:1.25}.bar-name span{display:block;font-weight:400;color:var(--soft);font-size:14px}
.bar{display:flex;align-items:center;gap:9px;margin:2px 0}.bar i{height:15px;border-radius:3px;flex:none}
.bar b{font-weight:500;font-size:14px;font-variant-numeric:tabular-nums}
circle{stroke:var(--card);stroke-width:1.2}svg .s{text-anchor:start}
.wide{max-width:none}.wide td:not(:first-child),.wide th:not(:first-child){text-align:right}
.wide td,.wide th{padding-right:10px}.worst td:first-child{white-space:nowrap}.plots .scroll{align-self:center}.columns table{align-self:start}.plot figcaption i{white-space:nowrap;display:inline-block}.scroll{overflow-x:auto}.wide td:last-child.left,.wide th:last-child.left{text-align:left}
.keys{display:flex;flex-wrap:wrap;gap:4px 22px;color:var(--soft);font-size:14px;margin:6px 0 2px}
.keys i{font-style:normal}.keys i::before{content:"";display:inline-block;width:11px;height:11px;border-radius:3px;background:var(--c);margin-right:6px}
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,255px),1fr));gap:14px;margin:12px 0 24px}
.pictures.three{grid-template-columns:repeat(auto-fill,minmax(min(100%,340px),1fr))}
.pictures figure{margin:0}.pictures img{width:100%;border-radius:10px;display:block;background:#000}
.pictures figcaption{color:var(--soft);font-size:14px;padding:5px 2px}
h3{font:600 17px/1.3 Georgia,serif;margin:26px 0 6px}
.figures b small{font-size:15px;font-weight:500;color:var(--soft)}
)css";

std::string figure_box(const std::string& value, const std::string& unit, const std::string& what,
                       const char* look = "") {
    return fmt::format("<div><b class=\"{}\">{} <small>{}</small></b><span>{}</span></div>", look, value, unit,
                       escaped(what));
}

std::string head_figures(const BenchResults& results) {
    std::string out;
    for (const TickResult& tick : results.tick) {
        if (tick.target_p99_us <= 0.0) continue;
        out += figure_box(fmt::format("{:.3f}", tick.p99_us * 1e-3), "ms",
                          fmt::format("a tick of 1 ms, 99 % of {} on {} thread{} (to reach: {:g} ms)", tick.title,
                                      tick.threads, tick.threads == 1 ? "" : "s", tick.target_p99_us * 1e-3),
                          tick.p99_us <= tick.target_p99_us ? "good" : "bad");
    }
    double best_speedup = 0.0;
    for (const PaperRow& row : results.paper)
        if (row.stage == "deformation step" && row.size == 3041 && row.ours_ms > 0.0)
            best_speedup = row.published_ms / row.ours_ms;
    if (best_speedup > 0.0)
        out += figure_box(fmt::format("{:.0f}×", best_speedup), "",
                          "as fast as the paper's deformation at 3,041 phyxels, which ran on a GPU");
    if (results.scale.exponent > 0.0)
        out += figure_box(
            fmt::format("n<sup>{:.2f}</sup>", results.scale.exponent), "",
            fmt::format("growth of a tick up to {} warm hexels", grouped_number(results.scale.sizes.back())));
    return out.empty() ? "" : "<div class=\"figures\">" + out + "</div>\n";
}

std::string machine_section(const BenchResults& results) {
    const Machine& m = results.machine;
    std::string out = "<h2>The machine</h2><div class=\"columns\"><table>";
    auto row = [&](const char* name, const std::string& value) {
        out += fmt::format("<tr><th>{}</th><td>{}</td></tr>", name, escaped(value));
    };
    row("processor", m.processor);
    row("instruction set in use", m.instruction_set);
    row("cores, memory", fmt::format("{}, {:.0f} GB", m.cores, m.memory_GB));
    row("system", m.system);
    row("compiler", m.compiler);
    row("scheduling", m.scheduling + (m.memory_locked ? "; memory locked" : ""));
    row("load when it began", fmt::format("{:.2f}", m.load));
    out += "</table><table><tr><th>ceilings</th><th>threads</th><th>read GB/s</th><th>copy GB/s</th></tr>";
    for (const Bandwidth& b : results.ceilings.bandwidth)
        out += fmt::format("<tr><td>{:g} MB</td><td>{}</td><td>{:.1f}</td><td>{:.1f}</td></tr>", b.megabytes, b.threads,
                           b.read_GB_per_s, b.copy_GB_per_s);
    for (const ArithmeticRate& a : results.ceilings.arithmetic)
        out += fmt::format(
            "<tr><td>multiply, add</td><td>{}</td><td colspan=2>{:.0f} GFlop/s ({:.0f} when fused)</td></tr>",
            a.threads, a.separate_GFlop_per_s, a.fused_GFlop_per_s);
    return out + "</table></div>\n";
}

std::string comparison_section(const std::vector<Comparison>& comparisons) {
    if (comparisons.empty()) return "";
    std::string out =
        "<h2>Against the earlier run</h2><p>Each repetition is paired with the same repetition of the earlier run; "
        "kernels are divided by a yardstick timed at the same moment. The interval holds the true ratio with 95 %.</p>"
        "<div class=\"scroll\"><table class=\"wide\"><tr><th>measured</th><th>earlier</th><th>now</th><th>ratio</th>"
        "<th>95 % interval</th><th>verdict</th></tr>";
    for (const Comparison& c : comparisons) {
        const std::string verdict = c.verdict();
        out += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.3f}</td><td>{:.3f} to {:.3f}</td><td "
            "class=\"{}\">{}</td></tr>",
            escaped(c.name), time_text(c.earlier_us), time_text(c.later_us), c.change.ratio, c.change.low,
            c.change.high,
            verdict == "faster"   ? "good"
            : verdict == "slower" ? "bad"
                                  : "",
            verdict);
    }
    return out + "</table></div>\n";
}

std::string notes_section(const BenchResults& results) {
    std::string out;
    for (const std::string& note : results.notes) out += fmt::format("<p class=\"note\">{}</p>", escaped(note));
    return out;
}

}  // namespace

std::string grouped_number(std::int64_t number) {
    std::string text = fmt::format("{}", number);
    for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), ",");
    return text;
}

std::string time_text(double us) {
    if (us >= 1e4) return fmt::format("{:.1f} ms", us * 1e-3);
    if (us >= 1e3) return fmt::format("{:.2f} ms", us * 1e-3);
    if (us >= 100.0) return fmt::format("{:.0f} µs", us);
    if (us >= 10.0) return fmt::format("{:.1f} µs", us);
    return fmt::format("{:.2f} µs", us);
}

std::string bench_html(const BenchResults& results, const std::vector<Comparison>& comparisons) {
    std::string out = fmt::format(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\"><title>Calot's speed</title><style>{}{}</style></head><body>"
        "<main><h1>Calot's speed</h1><p class=\"lead\">Calot {} on {}, {} core{}, measured in {:.0f} s{}. A tick "
        "simulates one millisecond; whatever takes less keeps up with the hand.</p>",
        kReportStyle, kBenchStyle, CALOT_VERSION, escaped(results.machine.processor), results.machine.cores,
        results.machine.cores == 1 ? "" : "s", results.wall_s, results.quick ? ", a quick look only" : "");
    out += head_figures(results) + comparison_section(comparisons) + tick_section(results) + kernels_section(results) +
           device_section(results) + scale_section(results) + paper_section(results) + machine_section(results) +
           notes_section(results);
    return out +
           "<footer>Written by calot bench. What the figures mean: "
           "docs/performance.md.</footer></main></body></html>\n";
}

}  // namespace calot::app
