#pragma once
// Tasks: what a trainee is asked to do, when it is done, and what it is worth. A TOML file each (scenes/tasks/);
// anybody may add one. docs/scoring.md explains the keys.

#include <optional>
#include <string>
#include <vector>

#include "calot/base/vec.h"
#include "calot/simulation/setup.h"
#include "calot/training/meter.h"
#include "calot/training/metrics.h"

namespace calot::training {

/// A patient to choose from.
struct Patient {
    std::uint64_t seed = 1;
    std::string name;
    int difficulty = 1;  ///< 1 easy to 3 hard
};

/// A bound on a metric, in SI.
struct Bound {
    std::string metric;
    std::optional<double> at_least, at_most;
    bool met(const Metrics& metrics) const;  ///< false where the metric is not known
};

/// What must not happen. Breaking it caps the score: nothing else makes it good.
struct Limit {
    Bound bound;
    std::string message;
    double cap = 100.0;  ///< greatest score once broken
    bool ends = false;   ///< breaking it ends the task
};

/// Part of the score: `weight` points at `best`, none at `worst`, linear between.
struct ScoreItem {
    std::string metric;
    double weight = 1.0;
    double worst = 0.0, best = 1.0;  ///< SI
    std::string tip;                 ///< what would raise it
};

struct TargetPlace {
    std::string landmark;  ///< of the anatomy; empty: the origin
    Vec3 offset_m{0.0};
    double radius_m = 2e-3;
};

struct Task {
    std::string name;  ///< file name without .toml
    std::string title;
    std::string goal;
    std::string scene;                     ///< path of its scene
    std::vector<std::string> assignments;  ///< changes to the scene, as of --set
    std::vector<Patient> patients;
    std::vector<std::string> hints;
    double time_limit_s = 0.0;  ///< 0: none
    std::vector<Bound> end;     ///< the goal: all of them
    std::vector<Limit> limits;
    std::vector<ScoreItem> score;
    std::vector<TargetPlace> targets;
    std::string text;  ///< the file's
    std::string path;
};

/// Throws InputError with file, line and the mend.
Task load_task(const std::string& path);
/// The same from text, `path` standing for the file.
Task parse_task(const std::string& text, const std::string& path);

/// Path of a task by name ("dissect") or path ("my/task.toml"): looked for in `folders`, in order. Throws InputError
/// that lists what there is.
std::string find_task(const std::string& name, const std::vector<std::string>& folders);
/// All task files of the folders, by name; the first folder wins.
std::vector<std::string> list_tasks(const std::vector<std::string>& folders);

/// The task's targets in this anatomy. Throws InputError for an unknown landmark.
std::vector<Target> place_targets(const Task& task, const simulation::Setup& setup);

}  // namespace calot::training
