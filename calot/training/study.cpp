#include "calot/training/study.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

namespace calot::training {

namespace {

/// Quoted where it must be; a leading =, +, - or @ is no formula for spreadsheets.
std::string field(const std::string& text) {
    std::string out = !text.empty() && std::string("=+-@\t").find(text[0]) != std::string::npos ? "'" + text : text;
    if (out.find_first_of(",\"\r\n") == std::string::npos) return out;
    std::string quoted = "\"";
    for (char c : out) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string number(double value) {
    return std::isnan(value) ? "" : fmt::format("{:.10g}", value);
}

bool is_attempt(const SessionRow& row) {
    return row.status == SessionStatus::finished && !row.parent && row.points;
}

}  // namespace

Spread spread(const std::vector<double>& values) {
    Spread result;
    result.count = values.size();
    if (values.empty()) return result;
    for (double value : values) result.mean += value;
    result.mean /= static_cast<double>(values.size());
    double squares = 0.0;
    for (double value : values) squares += (value - result.mean) * (value - result.mean);
    if (values.size() > 1) result.deviation = std::sqrt(squares / static_cast<double>(values.size() - 1));
    return result;
}

Study make_study(const std::vector<SessionRow>& sessions) {
    Study study;
    study.sessions = sessions.size();
    std::map<std::pair<std::string, std::string>, Curve> curves;
    std::vector<std::vector<double>> answers(kQuestions);
    for (const SessionRow& row : sessions) {
        if (is_attempt(row)) {
            Curve& curve = curves[{row.trainee, row.task}];
            curve.trainee = row.trainee;
            curve.task = row.task;
            curve.attempts.push_back(row);
        }
        study.with_answers += !row.answers.empty();
        for (std::size_t k = 0; k < std::min(kQuestions, row.answers.size()); ++k)
            if (row.answers[k]) answers[k].push_back(*row.answers[k]);
    }
    for (auto& [key, curve] : curves) study.curves.push_back(std::move(curve));
    for (const std::vector<double>& values : answers) study.answers.push_back(spread(values));
    return study;
}

std::string csv(const std::vector<SessionRow>& sessions) {
    std::string out =
        "session,status,started_utc,trainee,scene,seed,task,duration_s,points,completed,parent,parent_tick,"
        "program_version";
    for (const Metric& metric : metric_table()) out += std::string(",") + metric.name;
    for (const Question& question : questions()) out += std::string(",q_") + question.name;
    out += ",remark\r\n";
    for (const SessionRow& row : sessions) {
        out +=
            fmt::format("{},{},{},{},{},{},{},{},{},{:d},{},{},{}", row.id, name_of(row.status), row.started_utc,
                        field(row.trainee), field(row.scene), row.seed, field(row.task), number(row.duration_s),
                        row.points ? number(*row.points) : "", row.completed,
                        row.parent ? fmt::format("{}", *row.parent) : "", row.parent_tick, field(row.program_version));
        for (const Metric& metric : metric_table()) {
            const auto found = row.metrics.find(metric.name);
            out += "," + (found != row.metrics.end() ? number(found->second) : std::string());
        }
        for (std::size_t k = 0; k < kQuestions; ++k)
            out +=
                "," + (k < row.answers.size() && row.answers[k] ? fmt::format("{}", *row.answers[k]) : std::string());
        out += "," + field(row.remark) + "\r\n";
    }
    return out;
}

}  // namespace calot::training
