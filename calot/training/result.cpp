#include "calot/training/result.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace calot::training {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json parts_json(const Score& score) {
    Json parts = Json::array();
    for (const ScorePart& part : score.parts)
        parts.push_back({{"metric", part.metric},
                         {"value", number(part.value)},
                         {"weight", part.weight},
                         {"points", part.points},
                         {"known", part.known},
                         {"tip", part.tip}});
    return parts;
}

}  // namespace

Result conclude(const Task& task, const Meter& meter) {
    Result result;
    result.task = task;
    result.metrics = meter.metrics();
    result.score = score(task, result.metrics);
    result.events = meter.events();
    return result;
}

std::string metrics_json(const Metrics& metrics) {
    Json json = Json::object();
    for (const auto& [name, value] : metrics) json[name] = number(value);
    return json.dump();
}

Metrics metrics_from_json(const std::string& text) {
    Metrics metrics;
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) return metrics;
    for (const auto& [name, value] : json.items())
        metrics[name] = value.is_number() ? value.get<double>() : std::nan("");
    return metrics;
}

std::string to_json(const Result& result) {
    Json json;
    json["task"] = result.task.name;
    json["title"] = result.task.title;
    json["points"] = result.score.points;
    json["points_before_limits"] = result.score.before_caps;
    json["completed"] = result.score.completed;
    json["parts"] = parts_json(result.score);
    json["limits_broken"] = Json::array();
    for (const BrokenLimit& limit : result.score.broken)
        json["limits_broken"].push_back({{"message", limit.message}, {"cap", limit.cap}});
    for (const Metric& metric : metric_table()) {
        const auto found = result.metrics.find(metric.name);
        if (found == result.metrics.end()) continue;
        json["metrics"][metric.name] = {{"value", number(found->second)},
                                        {"shown", shown(metric, found->second)},
                                        {"title", metric.title},
                                        {"formula", metric.formula}};
    }
    json["events"] = Json::array();
    for (const Event& event : result.events)
        json["events"].push_back({{"time_s", event.time_s},
                                  {"kind", name_of(event.kind)},
                                  {"structure", event.structure},
                                  {"value", event.value},
                                  {"text", describe(event)}});
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace calot::training
