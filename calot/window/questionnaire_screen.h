#pragma once
// The questionnaire after a session: a row of answers for each statement, all of them optional.

#include <array>
#include <optional>
#include <vector>

#include "calot/viewer/exercise.h"
#include "calot/viewer/language.h"
#include "calot/window/gui.h"

namespace calot::window {

/// What has been answered so far.
struct Answers {
    std::vector<std::optional<int>> values;
    std::array<char, 512> remark{};  ///< UTF-8, ends with zero
};

enum class QuestionnaireChoice { none, store, skip };
QuestionnaireChoice draw_questionnaire(const Gui& gui, const viewer::Language& text,
                                       const viewer::Questionnaire& questionnaire, Answers& answers);

}  // namespace calot::window
