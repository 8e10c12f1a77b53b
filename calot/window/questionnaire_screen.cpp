#include "calot/window/questionnaire_screen.h"

#include <algorithm>

namespace calot::window {

using viewer::Language;

namespace {

/// The words of the scale over their columns.
void draw_scale(const Gui& gui, const Language& text, const viewer::Questionnaire& questionnaire, float at,
                float column) {
    ImGui::PushFont(gui.fonts().small);
    for (std::size_t k = 0; k < questionnaire.scale.size(); ++k) {
        const std::string& word = text(questionnaire.scale[k]);
        if (k > 0) ImGui::SameLine();
        ImGui::SetCursorPosX(at + static_cast<float>(k) * column +
                             0.5f * (column - ImGui::CalcTextSize(word.c_str()).x));
        ImGui::TextColored(colour::kFaint, "%s", word.c_str());
    }
    ImGui::PopFont();
}

/// One statement with its answers; a second press takes an answer back.
void draw_statement(const Gui& gui, const std::string& statement, std::size_t scale, float at, float column,
                    std::optional<int>& answer) {
    const float u = gui.unit(), top = ImGui::GetCursorPosY(), height = 34.0f * u;
    ImGui::PushTextWrapPos(at - 12.0f * u);
    const float lines = ImGui::CalcTextSize(statement.c_str(), nullptr, false, at - 12.0f * u).y;
    ImGui::SetCursorPosY(top + std::max(0.0f, 0.5f * (height - lines)));
    ImGui::TextUnformatted(statement.c_str());
    ImGui::PopTextWrapPos();
    const float bottom = std::max(ImGui::GetCursorPosY(), top + height + ImGui::GetStyle().ItemSpacing.y);
    for (std::size_t k = 0; k < scale; ++k) {
        const int value = static_cast<int>(k) + 1;
        const bool chosen = answer == value;
        ImGui::SetCursorPos(ImVec2(at + static_cast<float>(k) * column + 4.0f * u, top));
        ImGui::PushID(value);
        const ImVec2 size(column - 8.0f * u, height);
        const std::string label = std::to_string(value);
        if (chosen ? main_button(gui, label, size) : ImGui::Button(label.c_str(), size))
            answer = chosen ? std::nullopt : std::optional(value);
        ImGui::PopID();
    }
    ImGui::SetCursorPosY(bottom);
}

}  // namespace

QuestionnaireChoice draw_questionnaire(const Gui& gui, const Language& text, const viewer::Questionnaire& questionnaire,
                                       Answers& answers) {
    const float u = gui.unit();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ImVec2 size(std::min(1120.0f * u, screen.x - 24.0f * u), std::min(780.0f * u, screen.y - 24.0f * u));
    answers.values.resize(questionnaire.statements.size());
    QuestionnaireChoice choice = QuestionnaireChoice::none;
    if (begin_panel("questionnaire", middle_of_screen(), ImVec2(0.5f, 0.5f), size, 0.95f)) {
        heading(gui, text("questionnaire.title"));
        wrapped(text("questionnaire.about"), colour::kFaint);
        ImGui::PushFont(gui.fonts().small);
        const float padding = ImGui::GetStyle().WindowPadding.x, scroll = ImGui::GetStyle().ScrollbarSize;
        float column = 66.0f * u;
        for (const std::string& word : questionnaire.scale)
            column = std::max(column, ImGui::CalcTextSize(text(word).c_str()).x + 10.0f * u);
        ImGui::PopFont();
        const auto columns = static_cast<float>(questionnaire.scale.size());
        column = std::min(column, 0.5f * (size.x - 2.0f * padding) / columns);
        const float at = size.x - 2.0f * padding - scroll - columns * column;
        draw_scale(gui, text, questionnaire, at + padding, column);
        const float row = 46.0f * u, spacing = ImGui::GetStyle().ItemSpacing.y;
        ImGui::BeginChild("statements", ImVec2(0.0f, -2.0f * (row + spacing)));
        ImGui::PushFont(gui.fonts().small);
        for (std::size_t k = 0; k < questionnaire.statements.size(); ++k) {
            ImGui::PushID(static_cast<int>(k));
            draw_statement(gui, text(questionnaire.statements[k]), questionnaire.scale.size(), at, column,
                           answers.values[k]);
            ImGui::PopID();
        }
        ImGui::PopFont();
        ImGui::EndChild();
        ImGui::SetNextItemWidth(-1.0f);
        ImGui::InputTextWithHint("##remark", text("questionnaire.remark").c_str(), answers.remark.data(),
                                 answers.remark.size());
        const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
        if (main_button(gui, text("questionnaire.store"), ImVec2(half, row))) choice = QuestionnaireChoice::store;
        ImGui::SameLine();
        if (ImGui::Button(text("questionnaire.skip").c_str(), ImVec2(half, row))) choice = QuestionnaireChoice::skip;
    }
    ImGui::End();
    return choice;
}

}  // namespace calot::window
