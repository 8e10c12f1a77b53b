#include "validate_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "plot.h"
#include "report_style.h"
#include "xy_plot.h"

namespace calot::app {

namespace {

using validation::Case;
using validation::Kind;
using validation::Verdict;

constexpr const char* kStyle = R"css(
.cases{max-width:none;margin:0 0 20px}.cases td:nth-child(n+3){white-space:nowrap}.cases small{display:block;color:var(--soft);max-width:70ch}
.cases td:first-child{width:84px}.cases td:nth-child(2){width:46%}.plot figcaption i{white-space:nowrap;display:inline-block}.cases th{font-size:14px}
.pill{display:inline-block;min-width:62px;text-align:center;border-radius:99px;padding:1px 10px;font-size:13px;font-weight:600;border:1.5px solid}
.pass,.band{color:var(--green);border-color:var(--green)}.fail{color:#fff;background:var(--red);border-color:var(--red)}.outside{color:var(--warm);border-color:var(--warm)}
svg .label{font-size:13px}svg .x,svg .y{font-variant-numeric:tabular-nums}
svg.band{max-width:420px;min-width:220px;border:0;padding:0}svg.band rect{fill:var(--green);opacity:.32}svg.band .axis{stroke:var(--line);stroke-width:2}
svg.band .in{fill:var(--green)}svg.band .out{fill:var(--warm)}
.cases td.wide{white-space:normal;min-width:240px}
.toc{display:flex;gap:8px 18px;flex-wrap:wrap;margin:0 0 8px;padding:0;list-style:none}
@media print{body{background:#fff}.plot,.figures div{break-inside:avoid}main{padding:0}}
)css";

std::string title_of(const std::string& suite) {
    if (suite == "deformation") return "Deformation";
    if (suite == "heat") return "Heat";
    if (suite == "electric") return "Electric field";
    if (suite == "phase") return "Phase change and damage";
    if (suite == "surface") return "Surface";
    return "Whole runs";
}

std::string lead_of(const std::string& suite) {
    if (suite == "deformation")
        return "Meshfree elasticity on phyxels against B-bar finite elements of two resolutions, extrapolated, and "
               "against Saint-Venant's torsion. Asked: within 3 % at 6 cells across.";
    if (suite == "heat")
        return "Conduction, surface exchange and perfusion against closed forms. Asked: within 1 % at 8 cells across.";
    if (suite == "electric")
        return "Resistances and potentials of ideal electrodes. Asked: within 2 % at 8 cells across; power in is power "
               "out to 0.05 %.";
    if (suite == "phase") return "Boiling, gasification, fronts of phase change, Arrhenius damage.";
    if (suite == "surface") return "Marching cubes on a ball of hexels, and on what burning leaves.";
    return "Trends that must hold, and experiments as far as they are described. A value outside a published band "
           "fails nothing: experiments on tissue disagree with one another by more than a model should be bent.";
}

std::string pill(Verdict verdict) {
    return fmt::format("<span class=\"pill {}\">{}</span>", validation::word(verdict), validation::word(verdict));
}

std::string row(const Case& c) {
    const std::string name = fmt::format("{}<small>{}{}{}</small>", escaped(c.name), escaped(c.note),
                                         c.note.empty() || c.source.empty() ? "" : " · ", escaped(c.source));
    const std::string unit = c.unit == "1" ? "" : " " + escaped(c.unit);
    if (c.kind == Kind::published)
        return fmt::format("<tr><td>{}</td><td>{}</td><td>{}{}</td><td>{}</td></tr>\n", pill(c.verdict), name,
                           number_text(c.value), unit, svg_band(c));
    std::string expected = c.kind == Kind::trend ? "≥ " + number_text(c.expected) + unit
                           : c.expected == 0.0   ? "≤ " + number_text(c.tolerance) + unit
                                                 : number_text(c.expected) + unit;
    return fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", pill(c.verdict), name,
        number_text(c.value), unit, expected, escaped(error_text(c)),
        c.order ? fmt::format("{:.2f}{}", *c.order, c.least_order > 0.0 ? fmt::format(" (≥ {:g})", c.least_order) : "")
                : "");
}

std::string table(const std::vector<Case>& cases, const std::string& suite, bool published) {
    std::string rows;
    for (const Case& c : cases)
        if (c.suite == suite && (c.kind == Kind::published) == published) rows += row(c);
    if (rows.empty()) return "";
    return fmt::format("<table class=\"cases\"><tr><th></th><th>{}</th><th>Calot</th>{}</tr>\n{}</table>\n",
                       published ? "Experiment" : "Case",
                       published ? "<th>published band</th>" : "<th>expected</th><th>error</th><th>order</th>", rows);
}

std::string section(const ValidationRecord& record, const std::string& suite) {
    std::string figures;
    bool any = false;
    for (const Case& c : record.cases) {
        if (c.suite != suite) continue;
        any = true;
        for (const validation::Figure& figure : c.figures) figures += svg(figure);
    }
    if (!any) return "";
    return fmt::format("<h2 id=\"{}\">{}</h2>\n<p>{}</p>\n", suite, title_of(suite), lead_of(suite)) +
           table(record.cases, suite, false) + table(record.cases, suite, true) +
           (figures.empty() ? "" : "<div class=\"plots\">\n" + figures + "</div>\n");
}

std::string figure(const std::string& value, const std::string& what) {
    return fmt::format("<div><b>{}</b><span>{}</span></div>", value, what);
}

}  // namespace

int ValidationRecord::count(Verdict verdict) const {
    return static_cast<int>(
        std::count_if(cases.begin(), cases.end(), [&](const Case& c) { return c.verdict == verdict; }));
}

std::string number_text(double value) {
    if (!std::isfinite(value)) return "none";
    if (value != 0.0 && std::abs(value) < 1e-3) return fmt::format("{:.1e}", value);
    return fmt::format("{:.4g}", value);
}

std::string error_text(const Case& c) {
    const auto percent = [](double v) {
        return v == 0.0 || v >= 1e-5 ? fmt::format("{:.2g} %", 100.0 * v) : fmt::format("{:.0e} %", 100.0 * v);
    };
    if (c.kind == Kind::published) return fmt::format("band {:.3g} … {:.3g}", c.range->first, c.range->second);
    if (c.kind == Kind::trend) return c.error > 0.0 ? fmt::format("{:.3g} short", c.error) : "holds";
    if (c.expected == 0.0 && c.unit != "1") return "";
    return percent(c.error) + (c.expected == 0.0 ? "" : " of " + percent(c.tolerance));
}

std::string validation_json(const ValidationRecord& record) {
    using Json = nlohmann::ordered_json;
    Json all = Json::array();
    for (const Case& c : record.cases) {
        Json j{{"suite", c.suite},       {"name", c.name},         {"kind", word(c.kind)}, {"value", c.value},
               {"expected", c.expected}, {"unit", c.unit},         {"error", c.error},     {"tolerance", c.tolerance},
               {"order", nullptr},       {"least_order", nullptr}, {"band", nullptr},      {"verdict", word(c.verdict)},
               {"source", c.source},     {"note", c.note}};
        if (c.order) j["order"] = *c.order;
        if (c.least_order > 0.0) j["least_order"] = c.least_order;
        if (c.range) j["band"] = {c.range->first, c.range->second};
        all.push_back(j);
    }
    const Json out{{"version", CALOT_VERSION},
                   {"quick", record.quick},
                   {"spoilt", record.spoilt},
                   {"wall_s", record.wall_s},
                   {"passed", record.count(Verdict::pass)},
                   {"failed", record.count(Verdict::fail)},
                   {"in_band", record.count(Verdict::band)},
                   {"outside", record.count(Verdict::outside)},
                   {"cases", all}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string validation_html(const ValidationRecord& record) {
    const int passed = record.count(Verdict::pass), failed = record.count(Verdict::fail);
    const int band = record.count(Verdict::band), outside = record.count(Verdict::outside);
    std::string out = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\"><title>Validation of Calot {}</title><style>{}{}</style>"
        "</head><body><main>\n<h1>Validation of Calot</h1>\n<p class=\"lead\">Calot {} against closed forms, converged "
        "references, trends and published measurements{}.</p>\n",
        CALOT_VERSION, kReportStyle, kStyle, CALOT_VERSION, record.quick ? ", in short form" : "");
    if (!record.spoilt.empty())
        out += fmt::format(
            "<p class=\"note\">The simulation was spoilt on purpose ({}), to see whether this page "
            "notices.</p>\n",
            escaped(record.spoilt));
    out += "<div class=\"figures\">" + figure(fmt::format("<em class=\"good\">{}</em>", passed), "checks pass") +
           figure(fmt::format("<em class=\"{}\">{}</em>", failed ? "bad" : "good", failed), "checks fail");
    if (band + outside > 0)
        out += figure(fmt::format("{}", band), "values within published bands") +
               figure(fmt::format("{}", outside), "values outside published bands");
    out += figure(fmt::format("{:.0f} s", record.wall_s), "computing") + "</div>\n<ul class=\"toc\">";
    for (const std::string& suite : validation::suites())
        if (std::any_of(record.cases.begin(), record.cases.end(), [&](const Case& c) { return c.suite == suite; }))
            out += fmt::format("<li><a href=\"#{}\">{}</a></li>", suite, title_of(suite));
    out += "</ul>\n";
    for (const std::string& suite : validation::suites()) out += section(record, suite);
    return out +
           "<footer>Errors are relative. Order: slope of the logarithm of the error against that of the cells across a "
           "feature. Made by <code>calot validate</code>; docs/validation.md discusses what disagrees and why."
           "</footer>\n</main></body></html>\n";
}

}  // namespace calot::app
