// `calot study`: learning curves and questionnaires, on the terminal, as CSV and as a page.

#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "calot/training/session.h"
#include "calot/training/study.h"
#include "commands.h"
#include "html.h"
#include "output_directory.h"
#include "plot.h"
#include "report_style.h"

namespace calot::app {

namespace {

std::string label(const std::string& trainee) {
    return trainee.empty() ? "no label" : trainee;
}
std::string task_name(const std::string& task) {
    return task.empty() ? "free practice" : task;
}

void print_study(const training::Study& study) {
    fmt::print("{} sessions, {} with a questionnaire\n", study.sessions, study.with_answers);
    if (!study.curves.empty())
        fmt::print("\n{:<14}  {:<16}  {:>8}  {:>6}  {:>6}  {:>6}  {}\n", "trainee", "task", "attempts", "first", "best",
                   "last", "points, attempt by attempt");
    for (const training::Curve& curve : study.curves) {
        std::string points;
        double best = 0.0;
        for (const training::SessionRow& row : curve.attempts) {
            points += fmt::format("{}{:.0f}", points.empty() ? "" : " ", *row.points);
            best = std::max(best, *row.points);
        }
        fmt::print("{:<14}  {:<16}  {:>8}  {:>6.0f}  {:>6.0f}  {:>6.0f}  {}\n", label(curve.trainee),
                   task_name(curve.task), curve.attempts.size(), *curve.attempts.front().points, best,
                   *curve.attempts.back().points, points);
    }
    if (study.with_answers == 0) return;
    fmt::print("\n{:<26}  {:>3}  {:>5}  {:>5}\n", "question", "n", "mean", "SD");
    for (std::size_t k = 0; k < training::kQuestions; ++k)
        if (const training::Spread& spread = study.answers[k]; spread.count > 0)
            fmt::print("{:<26}  {:>3}  {:>5.2f}  {:>5.2f}\n", training::questions()[k].aspect, spread.count,
                       spread.mean, spread.deviation);
        else
            fmt::print("{:<26}  {:>3}  {:>5}  {:>5}\n", training::questions()[k].aspect, 0, "-", "-");
}

/// The curves of one task: points against attempts, a line a trainee.
std::string curve_plot(const std::string& task, const std::vector<const training::Curve*>& curves) {
    static constexpr const char* kColours[] = {"var(--blue)",   "var(--red)",  "var(--green)", "var(--warm)",
                                               "var(--violet)", "var(--teal)", "var(--gold)",  "var(--grey)"};
    constexpr double kWidth = 560, kHeight = 250, kLeft = 44, kRight = 16, kTop = 14, kBottom = 34;
    std::size_t most = 2;
    for (const training::Curve* curve : curves) most = std::max(most, curve->attempts.size());
    const auto x = [&](std::size_t k) {
        return kLeft + (kWidth - kLeft - kRight) * static_cast<double>(k) / static_cast<double>(most - 1);
    };
    const auto y = [&](double points) { return kTop + (kHeight - kTop - kBottom) * (1.0 - points / 100.0); };
    std::string out =
        fmt::format("<figure class=\"plot\"><figcaption>{} <span>points</span>", escaped(task_name(task)));
    for (std::size_t k = 0; k < curves.size(); ++k)
        out += fmt::format("<i style=\"--c:{}\">{}</i>", kColours[k % std::size(kColours)],
                           escaped(label(curves[k]->trainee)));
    out += fmt::format("</figcaption><svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"points against attempts\">",
                       kWidth, kHeight);
    for (int tick = 0; tick <= 100; tick += 25)
        out += fmt::format(
            "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text x=\"{}\" y=\"{:.1f}\" "
            "class=\"y\">{}</text>",
            kLeft, kWidth - kRight, y(tick), y(tick), kLeft - 7, y(tick) + 4, tick);
    const std::size_t step = std::max<std::size_t>(1, most / 10);
    for (std::size_t k = 0; k < most; k += step)
        out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" class=\"x\">{}</text>", x(k), kHeight - 12, k + 1);
    for (std::size_t k = 0; k < curves.size(); ++k) {
        const char* colour = kColours[k % std::size(kColours)];
        std::string path;
        for (std::size_t n = 0; n < curves[k]->attempts.size(); ++n) {
            const training::SessionRow& row = curves[k]->attempts[n];
            path += fmt::format("{}{:.1f} {:.1f}", n == 0 ? "M" : "L", x(n), y(*row.points));
            out += fmt::format(
                "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.6\" style=\"fill:{}\"><title>session {}, {}: {:.0f} "
                "points</title></circle>",
                x(n), y(*row.points), colour, row.id, row.started_utc, *row.points);
        }
        out += fmt::format("<path d=\"{}\" style=\"stroke:{}\"/>", path, colour);
    }
    return out + "</svg></figure>\n";
}

std::string curves_section(const training::Study& study) {
    if (study.curves.empty()) return "<p>There are no scored sessions yet.</p>\n";
    std::map<std::string, std::vector<const training::Curve*>> by_task;
    for (const training::Curve& curve : study.curves) by_task[curve.task].push_back(&curve);
    std::string out = "<div class=\"plots\">\n";
    for (const auto& [task, curves] : by_task) out += curve_plot(task, curves);
    return out +
           "</div>\n<p class=\"soft\">Attempt by attempt. Sessions that continue another, or were cut off, do not "
           "count.</p>\n";
}

std::string answers_section(const training::Study& study) {
    if (study.with_answers == 0) return "<p>Nobody has answered the questionnaire yet.</p>\n";
    std::string out =
        "<table class=\"answers\"><tr><th></th><th>Statement</th><th></th><th>Mean</th><th>SD</th><th>n</th></tr>\n";
    for (std::size_t k = 0; k < training::kQuestions; ++k) {
        const training::Spread& spread = study.answers[k];
        if (spread.count == 0) {
            out += fmt::format(
                "<tr><td>{}</td><td><b>{}.</b> {}</td><td class=\"likert\"><div></div></td><td>–</td><td>–</td>"
                "<td>0</td></tr>\n",
                k + 1, escaped(training::questions()[k].aspect), escaped(training::questions()[k].text));
            continue;
        }
        const double mean = spread.mean, share = (mean - 1.0) / 4.0;
        const double low = std::clamp((mean - spread.deviation - 1.0) / 4.0, 0.0, 1.0),
                     high = std::clamp((mean + spread.deviation - 1.0) / 4.0, 0.0, 1.0);
        out += fmt::format(
            "<tr><td>{}</td><td><b>{}.</b> {}</td><td class=\"likert\"><div><i "
            "style=\"left:{:.1f}%;width:{:.1f}%\"></i><u "
            "style=\"left:{:.1f}%\"></u></div></td><td>{:.2f}</td><td>{:.2f}</td><td>{}</td></tr>\n",
            k + 1, escaped(training::questions()[k].aspect), escaped(training::questions()[k].text), 100.0 * low,
            100.0 * (high - low), 100.0 * share, mean, spread.deviation, spread.count);
    }
    return out + "</table>\n<p class=\"soft\">1 not at all, 5 fully. Bar: mean ± SD.</p>\n";
}

std::string sessions_section(const std::vector<training::SessionRow>& rows) {
    std::string out =
        "<table class=\"wide\"><tr><th>Session</th><th>Started "
        "(UTC)</th><th>Trainee</th><th>Task</th><th>Patient</th><th>Time</"
        "th><th>Points</th><th>Duct, artery exposed</th><th>injured</th></tr>\n";
    for (const training::SessionRow& row : rows) {
        const auto shown = [&](const char* name) {
            const auto found = row.metrics.find(name);
            return found != row.metrics.end() ? training::shown(*training::find_metric(name), found->second)
                                              : std::string("–");
        };
        out += fmt::format(
            "<tr><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}, {}</td><td>{}, "
            "{}</td></tr>\n",
            row.id, row.status == training::SessionStatus::finished ? "" : fmt::format(" ({})", name_of(row.status)),
            row.started_utc, escaped(label(row.trainee)), escaped(task_name(row.task)), row.seed,
            clock_text(row.duration_s), row.points ? fmt::format("{:.0f}", *row.points) : "–", shown("duct_exposed"),
            shown("artery_exposed"), shown("duct_injured_m3"), shown("artery_injured_m3"));
    }
    return out + "</table>\n";
}

std::string study_html(const training::Study& study, const std::vector<training::SessionRow>& rows) {
    std::string out =
        "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\">\n<title>Study · Calot</title>\n<style>";
    out += kReportStyle;
    out +=
        ".plots "
        "svg{max-width:640px}.soft{color:var(--soft);font-size:15px}.wide,.answers{max-width:none}.likert{width:26%;"
        "min-width:140px}"
        ".likert div{position:relative;height:12px;border-radius:6px;background:var(--line)}"
        ".likert i{position:absolute;top:0;height:12px;border-radius:6px;background:color-mix(in srgb,var(--blue) "
        "35%,transparent)}"
        ".likert "
        "u{position:absolute;top:-3px;width:4px;height:18px;margin-left:-2px;border-radius:2px;background:var(--blue)}";
    out += fmt::format(
        "</style></head>\n<body><main><h1>Study</h1>\n<p class=\"lead\">{} sessions of {} trainees, {} with a "
        "questionnaire.</p>\n",
        study.sessions,
        [&] {
            std::vector<std::string> labels;
            for (const training::SessionRow& row : rows)
                if (!row.trainee.empty()) labels.push_back(row.trainee);
            std::sort(labels.begin(), labels.end());
            return std::unique(labels.begin(), labels.end()) - labels.begin();
        }(),
        study.with_answers);
    out += "<h2>Learning curves</h2>\n" + curves_section(study);
    out += "<h2>What trainees say</h2>\n" + answers_section(study);
    out += "<h2>Sessions</h2>\n" + sessions_section(rows);
    return out +
           fmt::format("<footer>Calot {} · formulas of all measures: docs/scoring.md</footer>\n</main></body></html>\n",
                       CALOT_VERSION);
}

void write_whole(const std::string& path, const std::string& content) {
    write_file(path + ".tmp", content);
    std::filesystem::rename(path + ".tmp", path);
    fmt::print("wrote {}\n", path);
}

}  // namespace

int study(const StudyOptions& options) {
    training::Store store(options.data.empty() ? training::default_data_directory() : options.data);
    const std::vector<training::SessionRow> rows = store.sessions(options.trainee, options.task);
    const training::Study study = training::make_study(rows);
    print_study(study);
    if (!options.csv.empty()) write_whole(options.csv, training::csv(rows));
    if (!options.html.empty()) write_whole(options.html, study_html(study, rows));
    return kDone;
}

}  // namespace calot::app
