#include "calot/training/score.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace calot::training {

namespace {

constexpr std::int64_t kTicksPerCheck = 100;

bool broken(const Limit& limit, const Metrics& metrics) {
    return metrics.count(limit.bound.metric) != 0 && !limit.bound.met(metrics);
}

}  // namespace

Score score(const Task& task, const Metrics& metrics) {
    Score result;
    double sum = 0.0, weights = 0.0;
    for (const ScoreItem& item : task.score) {
        ScorePart part;
        part.metric = item.metric;
        part.tip = item.tip;
        const auto found = metrics.find(item.metric);
        part.value = found != metrics.end() ? found->second : std::numeric_limits<double>::quiet_NaN();
        part.known = !std::isnan(part.value);
        if (part.known) {
            part.weight = item.weight;
            part.points = item.weight * std::clamp((part.value - item.worst) / (item.best - item.worst), 0.0, 1.0);
            weights += part.weight;
            sum += part.points;
        }
        result.parts.push_back(part);
    }
    for (ScorePart& part : result.parts) {
        part.points *= weights > 0.0 ? 100.0 / weights : 0.0;
        part.weight *= weights > 0.0 ? 100.0 / weights : 0.0;
    }
    result.before_caps = weights > 0.0 ? 100.0 * sum / weights : 0.0;
    result.points = result.before_caps;
    for (std::size_t k = 0; k < task.limits.size(); ++k) {
        if (!broken(task.limits[k], metrics)) continue;
        result.broken.push_back({k, task.limits[k].message, task.limits[k].cap});
        result.points = std::min(result.points, task.limits[k].cap);
    }
    result.completed = !task.end.empty() && std::all_of(task.end.begin(), task.end.end(),
                                                        [&](const Bound& bound) { return bound.met(metrics); });
    return result;
}

void TaskWatch::after_tick(Meter& meter, std::int64_t tick, double time_s) {
    if (tick % kTicksPerCheck != 0) return;
    const Metrics now = meter.metrics(false);
    for (std::size_t k = 0; k < task_.limits.size(); ++k) {
        if (broken_[k] || !broken(task_.limits[k], now)) continue;
        broken_[k] = true;
        ended_ = ended_ || task_.limits[k].ends;
        meter.add_event({time_s, EventKind::limit, task_.limits[k].message, static_cast<double>(k)});
    }
    if (!completed_ && !task_.end.empty() &&
        std::all_of(task_.end.begin(), task_.end.end(), [&](const Bound& bound) { return bound.met(now); })) {
        completed_ = ended_ = true;
        meter.add_event({time_s, EventKind::completed, "", 0.0});
    }
    if (task_.time_limit_s > 0.0 && time_s >= task_.time_limit_s) ended_ = true;
}

void TaskWatch::restore(const std::vector<Event>& events) {
    for (const Event& event : events) {
        if (event.kind == EventKind::completed) completed_ = ended_ = true;
        if (event.kind != EventKind::limit) continue;
        const auto k = static_cast<std::size_t>(event.value);
        if (k < broken_.size()) broken_[k] = true;
        if (k < broken_.size() && task_.limits[k].ends) ended_ = true;
    }
}

}  // namespace calot::training
