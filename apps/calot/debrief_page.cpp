// A debrief as one HTML page: no fonts, scripts or pictures from elsewhere.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "calot/base/units.h"
#include "calot/training/questionnaire.h"
#include "debrief.h"
#include "debrief_style.h"
#include "html.h"
#include "plot.h"
#include "report_style.h"

namespace calot::app {

namespace {

using training::Event;
using training::EventKind;

const char* colour_of(double points) {
    return points >= 75.0 ? "var(--green)" : points >= 45.0 ? "var(--warm)" : "var(--red)";
}

const char* kind_class(const Event& event) {
    switch (event.kind) {
        case EventKind::injured:
        case EventKind::burnt:
        case EventKind::organ_touch:
        case EventKind::limit:
            return "k-bad";
        case EventKind::exposed:
        case EventKind::completed:
        case EventKind::target:
            return "k-good";
        case EventKind::touch:
            return event.value > 0.0 ? "k-bad" : "k-touch";
        default:
            return "";
    }
}

bool worth_a_mark(const Event& event) {
    return event.kind != EventKind::activation_start && event.kind != EventKind::activation_end;
}

std::string ring(const training::Score& score) {
    constexpr double kRadius = 62.0;
    const double round = 2.0 * std::numbers::pi * kRadius;
    return fmt::format(
        "<div class=\"ring\" role=\"img\" aria-label=\"{0:.0f} of 100 points\"><svg viewBox=\"0 0 148 148\"><circle "
        "class=\"track\" cx=\"74\" cy=\"74\" r=\"{1}\"/><circle cx=\"74\" cy=\"74\" r=\"{1}\" style=\"stroke:{2}\" "
        "stroke-dasharray=\"{3:.1f} {4:.1f}\" stroke-linecap=\"round\"/></svg><div><b>{0:.0f}</b><span>of "
        "100</span></div></div>\n",
        score.points, kRadius, colour_of(score.points), round * std::max(0.004, score.points / 100.0), round);
}

std::string facts(const DebriefContent& c) {
    std::string text =
        fmt::format("{} of “{}”, patient {}", clock_text(c.duration_s), escaped(c.setup->name), c.setup->seed);
    if (c.subject.session) {
        const training::SessionRow& row = *c.subject.session;
        text += fmt::format(" · session {}", row.id);
        if (!row.trainee.empty()) text += ", " + escaped(row.trainee);
        if (row.started_utc.size() >= 16)
            text += fmt::format(" · {} {} UTC", row.started_utc.substr(0, 10), row.started_utc.substr(11, 5));
        if (row.parent)
            text += fmt::format(" · continues session {} from {:.1f} s", *row.parent,
                                static_cast<double>(row.parent_tick) * c.setup->model.tick_s);
    }
    return text;
}

std::string opening(const DebriefContent& c) {
    const training::Task& task = c.result.task;
    const bool scored = !task.score.empty();
    std::string out = "<div class=\"head\">\n";
    if (scored) out += ring(c.result.score);
    out += fmt::format("<div class=\"words\"><h1>{}</h1>\n", scored ? escaped(task.title) : "Free practice");
    if (scored) {
        out += fmt::format("<p>{}</p>\n", escaped(task.goal));
        if (!task.end.empty())
            out += c.result.score.completed ? "<p class=\"goal good\">Goal reached.</p>\n"
                                            : "<p class=\"goal bad\">Goal not reached.</p>\n";
    }
    out += fmt::format("<p class=\"facts\">{}</p></div></div>\n", facts(c));
    if (!c.complete) out += "<p class=\"note\">The session was cut off. What is told here is all until then.</p>\n";
    if (!c.result.score.broken.empty()) {
        out += "<div class=\"broken\">";
        for (const training::BrokenLimit& limit : c.result.score.broken)
            out += fmt::format("<p><b class=\"bad\">{}</b> — nothing else makes that good: at most {:.0f} points.</p>",
                               escaped(limit.message), limit.cap);
        if (c.result.score.before_caps > c.result.score.points + 0.5)
            out += fmt::format("<p>Without it, the session would have brought {:.0f} points.</p>",
                               c.result.score.before_caps);
        out += "</div>\n";
    }
    return out;
}

std::string advice(const DebriefContent& c) {
    std::vector<training::ScorePart> parts;
    for (const training::ScorePart& part : c.result.score.parts)
        if (part.known && !part.tip.empty() && part.weight - part.points >= 0.5) parts.push_back(part);
    if (parts.empty()) return "";
    std::stable_sort(parts.begin(), parts.end(),
                     [](const auto& a, const auto& b) { return a.weight - a.points > b.weight - b.points; });
    std::string out = "<h2>What would bring more</h2>\n<ul class=\"tips\">\n";
    for (std::size_t k = 0; k < std::min<std::size_t>(3, parts.size()); ++k)
        out += fmt::format("<li><b>+{:.0f}</b>{}</li>\n", parts[k].weight - parts[k].points, escaped(parts[k].tip));
    return out + "</ul>\n";
}

std::string replay(const DebriefContent& c) {
    if (c.frames.empty()) {
        if (c.no_pictures.empty()) return "";
        return fmt::format("<p class=\"note\">There are no pictures: {}</p>\n", escaped(c.no_pictures));
    }
    std::string out =
        "<h2 id=\"replay\">Replay</h2>\n<div class=\"views\"><figure><img id=\"front\" alt=\"as the laparoscope "
        "saw it\"><figcaption>laparoscope</figcaption></figure><figure><img id=\"side\" alt=\"from the "
        "side\"><figcaption>from the side</figcaption></figure></div>\n"
        "<div class=\"player\"><button id=\"play\" aria-label=\"play\">&#9654;</button><div class=\"bar\"><div "
        "class=\"marks\">";
    const double whole = std::max(1e-3, c.duration_s);
    for (const auto& [from, to] : c.pedal_s)
        out += fmt::format("<i style=\"left:{:.2f}%;width:{:.2f}%\"></i>", 100.0 * from / whole,
                           std::max(0.15, 100.0 * (to - from) / whole));
    for (const Event& event : c.result.events)
        if (worth_a_mark(event))
            out += fmt::format("<a class=\"{}\" style=\"left:{:.2f}%\" data-t=\"{:.3f}\" title=\"{:.1f} s: {}\"></a>",
                               kind_class(event), 100.0 * event.time_s / whole, event.time_s, event.time_s,
                               escaped(training::describe(event)));
    out +=
        "</div><input type=\"range\" id=\"at\" min=\"0\" value=\"0\" aria-label=\"moment of the replay\"></div><output "
        "id=\"now\"></output></div>\n";
    std::string list;  // the pedal is in the bar
    for (const Event& event : c.result.events)
        if (worth_a_mark(event))
            list += fmt::format("<a data-t=\"{0:.3f}\"><time>{0:.1f} s</time><i class=\"{1}\"></i><span>{2}</span></a>",
                                event.time_s, kind_class(event), escaped(training::describe(event)));
    if (!list.empty()) out += "<div class=\"events\">" + list + "</div>\n";
    if (c.subject.session)
        out += fmt::format(
            "<p class=\"go\">Another session can go on from this moment: <code>calot continue {} --from <span "
            "id=\"from\">0.0</span></code></p>\n",
            c.subject.session->id);
    out += "<p class=\"facts\">Gold: pedal down. Smoke is left out of the replay. Arrow keys step.</p>\n";
    return out;
}

std::string moments(const DebriefContent& c) {
    if (c.frames.empty()) return "";
    std::string out;
    int count = 0;
    for (const Event& event : c.result.events) {
        const bool key = event.kind == EventKind::injured || event.kind == EventKind::burnt ||
                         event.kind == EventKind::exposed || event.kind == EventKind::organ_touch ||
                         event.kind == EventKind::completed;
        if (!key || ++count > 8) continue;
        out += fmt::format("<a data-t=\"{0:.3f}\"><img alt=\"\"><span>{0:.1f} s: {1}</span></a>\n", event.time_s,
                           escaped(training::describe(event)));
    }
    return out.empty() ? "" : "<h2>Moments that mattered</h2>\n<div class=\"moments\">\n" + out + "</div>\n";
}

std::string scale(bool injury) {
    struct Step {
        const char *colour, *label;
    };
    static const std::vector<Step> heat{
        {"#8d8d92", "37 °C"}, {"#e8cf52", "48"}, {"#e07a1c", "60"}, {"#b3140f", "90"}, {"#3a0a1c", "200 °C"}};
    static const std::vector<Step> dead{
        {"#8d8d92", "unhurt"}, {"#e8cf52", "Ω 0.2, recovers"}, {"#d11a46", "Ω ≥ 1, dead"}, {"#a0139b", "Ω ≥ 3"}};
    std::string out = "<div class=\"scale\">";
    for (const Step& step : injury ? dead : heat)
        out += fmt::format("<span><i style=\"background:{}\"></i>{}</span>", step.colour, step.label);
    return out + "</div>";
}

std::string known(const DebriefContent& c, const char* metric) {
    const auto found = c.result.metrics.find(metric);
    return found != c.result.metrics.end() ? training::shown(*training::find_metric(metric), found->second) : "–";
}

double value_or(const DebriefContent& c, const char* metric, double otherwise) {
    const auto found = c.result.metrics.find(metric);
    return found != c.result.metrics.end() ? found->second : otherwise;
}

std::string maps(const DebriefContent& c) {
    const bool vessels = c.result.metrics.count("hidden_injury_m3") != 0;
    if (c.maps.empty() && !vessels) return "";
    const double hidden = value_or(c, "hidden_injury_m3", 0.0);
    std::string out = fmt::format("<h2>{}</h2>\n", hidden > 0.0 ? "The injury that nobody saw" : "Heat and injury");
    if (vessels) {
        const double all = value_or(c, "duct_injured_m3", 0.0) + value_or(c, "artery_injured_m3", 0.0);
        if (all <= 0.0)
            out += fmt::format(
                "<p class=\"good\">Neither duct nor artery was injured. At its hottest, the duct was at {}, the artery "
                "at "
                "{}.</p>\n",
                known(c, "duct_peak_K"), known(c, "artery_peak_K"));
        else
            out += fmt::format(
                "<p>Heat killed {} of the duct and {} of the artery; {} of that lay out of sight when the session "
                "ended. "
                "At their hottest, the duct had {}, the artery {}. Such injuries show days later, as leaks and "
                "strictures.</p>\n",
                known(c, "duct_injured_m3"), known(c, "artery_injured_m3"), known(c, "hidden_injury_m3"),
                known(c, "duct_peak_K"), known(c, "artery_peak_K"));
    }
    if (c.maps.empty()) return out;
    out += "<div class=\"maps\">\n";
    for (const DebriefMap& map : c.maps)
        out +=
            fmt::format("<figure><img alt=\"{0}\" src=\"{1}\"><figcaption><b>{0}.</b> {2}{3}</figcaption></figure>\n",
                        map.title, data_url("image/jpeg", map.picture), map.caption, scale(map.injury));
    return out + "</div>\n";
}

/// Title of a metric that unfolds its formula.
std::string folded(const training::Metric& metric) {
    return fmt::format("<details><summary title=\"{0}\">{1}</summary><p>{0}.{2}</p></details>", escaped(metric.formula),
                       escaped(metric.title),
                       *metric.source ? fmt::format(" <em>{}.</em>", escaped(metric.source)) : "");
}

std::string parts(const DebriefContent& c) {
    if (c.result.task.score.empty()) return "";
    std::string out =
        "<h2>How the points came about</h2>\n<table "
        "class=\"parts\"><tr><th>Measure</th><th>Value</th><th></th><th>Points</"
        "th><th>What would raise it</th></tr>\n";
    for (const training::ScorePart& part : c.result.score.parts) {
        const training::Metric& metric = *training::find_metric(part.metric);
        if (!part.known) {
            out += fmt::format(
                "<tr><td>{}</td><td colspan=\"4\">not in this scene; its weight is shared by the "
                "others</td></tr>\n",
                folded(metric));
            continue;
        }
        const double share = part.weight > 0.0 ? part.points / part.weight : 1.0;
        out += fmt::format(
            "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"meter\"><div><i "
            "style=\"width:{:.0f}%;background:{}\"></"
            "i></div></td><td class=\"number\">{:.1f} of {:.1f}</td><td>{}</td></tr>\n",
            folded(metric), training::shown(metric, part.value), 100.0 * share, colour_of(100.0 * share), part.points,
            part.weight, share > 0.98 ? "" : escaped(part.tip));
    }
    return out +
           "</table>\n<p class=\"facts\">Full points at the task's best value, none at its worst, linear between; "
           "weights "
           "add up to 100. Click a measure for its formula.</p>\n";
}

template <class F>
Series series(const DebriefContent& c, const char* name, const char* colour, F value) {
    Series out{name, colour, {}};
    for (const training::TrackPoint& point : c.track)
        out.points.emplace_back(point.time_s, static_cast<double>(value(point)));
    return out;
}

std::string plots(const DebriefContent& c) {
    if (c.track.size() < 2) return "";
    using P = training::TrackPoint;
    const bool vessels = c.result.metrics.count("duct_exposed") != 0;
    Plot base;
    base.shaded = c.pedal_s;
    base.x_max = std::max(1e-3, c.duration_s);
    auto make = [&](const char* title, const char* unit, double floor, std::vector<Series> lines) {
        Plot plot = base;
        plot.title = title;
        plot.unit = unit;
        plot.y_floor = floor;
        plot.series = std::move(lines);
        return svg(plot);
    };
    std::string out = "<h2>Against time</h2>\n<div class=\"plots\">\n";
    if (vessels) {
        out += make("Exposed, towards the lens", "%", 10.0,
                    {series(c, "duct", "var(--green)", [](const P& p) { return 100.0f * p.exposed[0]; }),
                     series(c, "artery", "var(--red)", [](const P& p) { return 100.0f * p.exposed[1]; })});
        Plot hot = base;
        hot.title = "Hottest spot so far";
        hot.unit = "°C";
        hot.y_floor = 60.0;
        hot.marks = {{60.0, "protein coagulates in seconds"}};
        hot.series = {series(c, "duct", "var(--green)", [](const P& p) { return p.peak_K[0] - 273.15f; }),
                      series(c, "artery", "var(--red)", [](const P& p) { return p.peak_K[1] - 273.15f; })};
        out += svg(hot);
    }
    out += make("Greatest force on the hook", "N", 0.5,
                {series(c, "force", "var(--blue)", [](const P& p) { return p.force_peak_N; })});
    out +=
        make("Power into tissue", "W", 1.0, {series(c, "power", "var(--warm)", [](const P& p) { return p.power_W; })});
    return out + "</div>\n";
}

std::string all_measures(const DebriefContent& c) {
    std::string out = "<h2>Everything that was measured</h2>\n<table class=\"all\">\n";
    for (const training::Metric& metric : training::metric_table()) {
        const auto found = c.result.metrics.find(metric.name);
        if (found == c.result.metrics.end()) continue;
        out += fmt::format("<tr><td>{}</td><td class=\"number\">{}</td><td><code>{}</code></td></tr>\n", folded(metric),
                           training::shown(metric, found->second), metric.name);
    }
    return out + "</table>\n";
}

std::string answers(const DebriefContent& c) {
    if (!c.subject.session || c.subject.session->answers.empty()) return "";
    std::string out = "<h2>What the trainee said</h2>\n<table>\n";
    const auto& given = c.subject.session->answers;
    for (std::size_t k = 0; k < std::min(given.size(), training::kQuestions); ++k)
        out += fmt::format(
            "<tr><td>{}</td><td>{}</td></tr>\n", escaped(training::questions()[k].text),
            given[k] ? fmt::format("{} · {}", *given[k], training::scale()[static_cast<std::size_t>(*given[k] - 1)])
                     : "–");
    out += "</table>\n";
    if (!c.subject.session->remark.empty()) out += fmt::format("<p>“{}”</p>\n", escaped(c.subject.session->remark));
    return out;
}

std::string script(const DebriefContent& c) {
    if (c.frames.empty()) return "";
    std::string out = "<script>var frames=[";
    for (const DebriefFrame& frame : c.frames)
        out += fmt::format("{{t:{:.3f},a:\"{}\",b:\"{}\"}},\n", frame.time_s, data_url("image/jpeg", frame.front),
                           data_url("image/jpeg", frame.side));
    return out + "];" + kDebriefScript + "</script>\n";
}

}  // namespace

std::string debrief_html(const DebriefContent& c) {
    std::string out =
        "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\">\n";
    const std::string title = c.result.task.title.empty() ? "Free practice" : c.result.task.title;
    out += fmt::format("<title>{} · Calot</title>\n<style>{}{}</style></head>\n<body><main>\n", escaped(title),
                       kReportStyle, kDebriefStyle);
    out +=
        opening(c) + advice(c) + replay(c) + maps(c) + moments(c) + parts(c) + plots(c) + answers(c) + all_measures(c);
    out += fmt::format(
        "<footer>Calot {} · scene “{}”, seed {}. A simulation for training and research; how well its physics holds is "
        "told "
        "in docs/validation.md, what is measured in docs/scoring.md.</footer>\n</main>{}</body></html>\n",
        CALOT_VERSION, escaped(c.setup->name), c.setup->seed, script(c));
    return out;
}

}  // namespace calot::app
