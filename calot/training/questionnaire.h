#pragma once
// The questionnaire after a session: twelve statements, answered from 1 (not at all) to 5 (fully).
//
// It asks for the aspects that simulators of electrosurgery are judged by (Pan et al. 2019 asked six surgeons twelve
// such questions). The words are Calot's own: those of the paper are not reproduced here.

#include <array>
#include <string>

namespace calot::training {

struct Question {
    const char* name;    ///< for CSV
    const char* aspect;  ///< short, for tables
    const char* text;
};

inline constexpr std::size_t kQuestions = 12;
const std::array<Question, kQuestions>& questions();

/// What 1 to 5 stand for.
const std::array<const char*, 5>& scale();

}  // namespace calot::training
