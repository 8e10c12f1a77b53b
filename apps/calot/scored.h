#pragma once
// Scores a run against a task: for `simulate --task` and `score`.

#include <memory>
#include <string>

#include "calot/training/result.h"
#include "run.h"

namespace calot::app {

/// The task of this name or path. Tasks lie in scenes/tasks, below the working directory or where Calot was built.
training::Task choose_task(const std::string& name);
std::vector<std::string> task_folders();

/// Makes `plan` measure itself; the result ends up in RunRecord::scored. The run ends when the task does, unless
/// `to_the_end`.
void score_against(const training::Task& task, RunPlan& plan, bool to_the_end);

/// Says why a moment of this recording takes long to reach, where its checkpoints are of an older version.
void note_older_checkpoints(const std::string& recording);
/// Points, parts and advice.
void print_score(const training::Result& result);

}  // namespace calot::app
