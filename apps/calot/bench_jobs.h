#pragma once
// A benchmark is a list of jobs, done one after another under one progress bar.

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "commands.h"

namespace calot::app {

class BenchProgress {
  public:
    explicit BenchProgress(ProgressKind kind);
    /// `share` of all work is done; `label` is going on.
    void update(double share, const std::string& label);
    void finish();

  private:
    using Clock = std::chrono::steady_clock;
    bool bar_ = false, lines_ = false, drawn_ = false;
    Clock::time_point start_, last_;
    std::string last_label_;
};

class Jobs {
  public:
    /// Tells how much of the job is done, 0 to 1; false: stop, the user wants it.
    using Report = std::function<bool(double share)>;
    using Work = std::function<void(const Report& report)>;

    /// `weight` is about how many seconds it takes.
    void add(std::string label, double weight, Work work) {
        jobs_.push_back({std::move(label), weight, std::move(work)});
    }
    /// False when the user interrupted.
    bool run(BenchProgress& progress) const;

  private:
    struct Job {
        std::string label;
        double weight;
        Work work;
    };
    std::vector<Job> jobs_;
};

}  // namespace calot::app
