#pragma once
// The window's exercises from the task files: every attempt is a stored session.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calot/training/session.h"
#include "calot/viewer/exercise.h"

namespace calot::app {

/// Free practice first, then a task each. `trainee`: a label, may be empty. `trouble`: what kept sessions from being
/// stored, for people; the exercises are there all the same. `cut_off`: a session that a killed program left, if any.
std::vector<viewer::Exercise> training_exercises(const std::string& data, const std::string& trainee,
                                                 std::string& trouble, std::optional<viewer::CutOff>& cut_off);

}  // namespace calot::app
