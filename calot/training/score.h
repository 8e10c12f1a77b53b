#pragma once
// From metrics to a score out of 100, with what each part was worth and what would raise it.

#include <string>
#include <vector>

#include "calot/training/meter.h"
#include "calot/training/task.h"

namespace calot::training {

struct ScorePart {
    std::string metric;
    double value = 0.0;   ///< SI; not a number when unknown
    double weight = 0.0;  ///< points that it could bring, of 100 in all
    double points = 0.0;  ///< that it brought
    bool known = false;   ///< false: not measurable in this scene, its weight is shared by the others
    std::string tip;
};

struct BrokenLimit {
    std::size_t index = 0;
    std::string message;
    double cap = 100.0;
};

/// points = 100 sum_k w_k s_k / sum_k w_k,  s_k = clamp((value - worst) / (best - worst), 0, 1),
/// at most the least cap of the broken limits.
struct Score {
    double points = 0.0;
    double before_caps = 0.0;
    bool completed = false;  ///< the task's goal is reached
    std::vector<ScorePart> parts;
    std::vector<BrokenLimit> broken;
};

Score score(const Task& task, const Metrics& metrics);

/// Watches a task while it goes on: when it is done, when a limit breaks. Adds events to the meter.
class TaskWatch {
  public:
    explicit TaskWatch(const Task& task) : task_(task), broken_(task.limits.size(), false) {}
    /// Once a tick, after Meter::after_tick; looks every 100 ticks.
    void after_tick(Meter& meter, std::int64_t tick, double time_s);
    bool completed() const { return completed_; }
    bool ended() const { return ended_; }  ///< goal reached, time over, or a limit broken that ends it
    /// Takes up what the events of an earlier meter say.
    void restore(const std::vector<Event>& events);

  private:
    const Task& task_;
    std::vector<bool> broken_;
    bool completed_ = false, ended_ = false;
};

}  // namespace calot::training
