#include "calot/window/rewind_screen.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calot/window/hud.h"

namespace calot::window {

using viewer::Language;
using viewer::Mark;

namespace {

constexpr float kMargin = 16.0f, kPanelHeight = 160.0f;
constexpr double kStep_s = 5.0;

const ImVec4& colour_of(Mark::Kind kind) {
    static const ImVec4 touch{0.55f, 0.72f, 0.95f, 1.0f};
    return kind == Mark::Kind::harm ? colour::kBad : kind == Mark::Kind::progress ? colour::kGood : touch;
}

std::string fine_clock_text(double time_s) {
    const auto tenths = static_cast<std::int64_t>(std::floor(10.0 * time_s + 1e-6));
    return fmt::format("{}:{:02d}.{}", tenths / 600, tenths / 10 % 60, tenths % 10);
}

/// The bar itself. Pedals are bars in their colours, marks stand up from it.
void draw_timeline(const Gui& gui, const Language& text, const RewindContent& content, RewindState& state) {
    const float u = gui.unit(), height = 54.0f * u, width = ImGui::GetContentRegionAvail().x;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("timeline", ImVec2(width, height));
    const bool hovered = ImGui::IsItemHovered();
    const auto x_of = [&](double time_s) {
        return at.x + width * static_cast<float>(std::clamp(time_s / content.duration_s, 0.0, 1.0));
    };
    if (ImGui::IsItemActive()) {
        state.at_s = content.duration_s * static_cast<double>((ImGui::GetIO().MousePos.x - at.x) / width);
        state.playing = false;
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float top = at.y + 22.0f * u, bottom = at.y + 46.0f * u;
    list->AddRectFilled(ImVec2(at.x, top), ImVec2(at.x + width, bottom), ImGui::GetColorU32(ImGuiCol_FrameBg),
                        5.0f * u);
    const float shown = x_of(content.shown_s);
    list->AddRectFilled(ImVec2(at.x, top), ImVec2(shown, bottom), IM_COL32(255, 255, 255, 26), 5.0f * u);
    for (const viewer::PedalSpan& span : content.pedal) {
        const float from = x_of(span.from_s), to = std::max(from + 2.0f * u, x_of(span.to_s));
        list->AddRectFilled(ImVec2(from, top + 5.0f * u), ImVec2(to, bottom - 5.0f * u),
                            ImGui::GetColorU32(span.coag ? colour::kBlue : colour::kYellow), 2.0f * u);
    }
    const Mark* pointed = nullptr;
    for (const Mark& mark : content.marks) {
        const float x = x_of(mark.time_s);
        const ImU32 tint = ImGui::GetColorU32(colour_of(mark.kind));
        const float size = mark.kind == Mark::Kind::harm ? 8.0f * u : 6.0f * u;
        list->AddLine(ImVec2(x, top - 4.0f * u), ImVec2(x, bottom), tint, 1.5f * u);
        list->AddTriangleFilled(ImVec2(x - size, top - 6.0f * u - size), ImVec2(x + size, top - 6.0f * u - size),
                                ImVec2(x, top - 3.0f * u), tint);
        if (hovered && std::fabs(ImGui::GetIO().MousePos.x - x) < 8.0f * u) pointed = &mark;
    }
    const float now = x_of(state.at_s);
    list->AddRectFilled(ImVec2(now - 2.0f * u, top - 6.0f * u), ImVec2(now + 2.0f * u, bottom + 6.0f * u),
                        ImGui::GetColorU32(colour::kText), 2.0f * u);
    list->AddCircleFilled(ImVec2(now, bottom + 4.0f * u), 8.0f * u, ImGui::GetColorU32(colour::kAccent));
    if (pointed != nullptr)
        ImGui::SetTooltip("%s  %s", clock_text(pointed->time_s).c_str(), describe(text, *pointed).c_str());
}

/// Moments that mattered; a press leads to what caused them.
void draw_moments(const Gui& gui, const Language& text, const RewindContent& content, RewindState& state, float below) {
    if (content.marks.empty()) return;
    const float u = gui.unit();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float row = ImGui::GetStyle().FramePadding.y * 2.0f + gui.fonts().small->FontSize;
    const float whole = static_cast<float>(content.marks.size()) * (row + ImGui::GetStyle().ItemSpacing.y) + 74.0f * u;
    const float height = std::min(whole, screen.y - below - 2.0f * kMargin * u);
    if (begin_panel("moments", ImVec2(screen.x - kMargin * u, kMargin * u), ImVec2(1.0f, 0.0f),
                    ImVec2(std::min(400.0f * u, 0.42f * screen.x), height), 0.8f)) {
        ImGui::TextColored(colour::kAccent, "%s", text("rewind.moments").c_str());
        ImGui::BeginChild("list");
        ImGui::PushFont(gui.fonts().small);
        ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(0.0f, 0.5f));
        for (std::size_t k = 0; k < content.marks.size(); ++k) {
            const Mark& mark = content.marks[k];
            ImGui::PushID(static_cast<int>(k));
            ImGui::PushStyleColor(ImGuiCol_Text, colour_of(mark.kind));
            const std::string label = fmt::format("{:>5}   {}", clock_text(mark.time_s), describe(text, mark));
            if (ImGui::Button(label.c_str(), ImVec2(-1.0f, row))) {
                state.at_s = std::max(0.0, mark.time_s - kBeforeMark_s);
                state.playing = false;
            }
            ImGui::PopStyleColor();
            const float room = ImGui::GetItemRectSize().x - 2.0f * ImGui::GetStyle().FramePadding.x;
            if (ImGui::IsItemHovered() && ImGui::CalcTextSize(label.c_str()).x > room)
                ImGui::SetTooltip("%s", label.c_str());
            ImGui::PopID();
        }
        ImGui::PopStyleVar();
        ImGui::PopFont();
        ImGui::EndChild();
    }
    ImGui::End();
}

}  // namespace

std::string describe(const Language& text, const Mark& mark) {
    std::string words = text(mark.text);
    const std::size_t at = words.find("{0}");
    if (at != std::string::npos) words.replace(at, 3, text(mark.subject));
    return capitalised(words);
}

float rewind_height(const Gui& gui) {
    return (kPanelHeight + 2.0f * kMargin) * gui.unit();
}

namespace {

/// The moment, and the buttons beside it.
RewindChoice draw_controls(const Gui& gui, const Language& text, const RewindContent& content, RewindState& state) {
    const float u = gui.unit(), row = 44.0f * u, left = ImGui::GetCursorPosX(), top = ImGui::GetCursorPosY();
    RewindChoice choice = RewindChoice::none;
    ImGui::PushFont(gui.fonts().large);
    ImGui::TextColored(colour::kAccent, "%s", fine_clock_text(state.at_s).c_str());
    ImGui::PopFont();
    ImGui::SameLine();
    ImGui::SetCursorPosY(top + 11.0f * u);
    ImGui::TextColored(colour::kFaint, "/ %s", clock_text(content.duration_s).c_str());
    ImGui::SetCursorPos(ImVec2(left + 200.0f * u, top));
    const auto step = [&](const std::string& label, double by_s) {
        if (ImGui::Button(label.c_str(), ImVec2(76.0f * u, row))) state.at_s += by_s, state.playing = false;
        ImGui::SameLine();
    };
    step(text("rewind.step_back"), -kStep_s);
    if (ImGui::Button(text(state.playing ? "rewind.stop" : "rewind.play").c_str(), ImVec2(120.0f * u, row)))
        state.playing = !state.playing;
    ImGui::SameLine();
    step(text("rewind.step_on"), kStep_s);
    const float back = ImGui::CalcTextSize(text("rewind.back").c_str()).x + 40.0f * u;
    const float take = ImGui::CalcTextSize(text("rewind.take_over").c_str()).x + 52.0f * u;
    ImGui::SetCursorPosX(ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x - back - take -
                         ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::Button(text("rewind.back").c_str(), ImVec2(back, row))) choice = RewindChoice::back;
    ImGui::SameLine();
    if (main_button(gui, text("rewind.take_over"), ImVec2(take, row))) choice = RewindChoice::take_over;
    return choice;
}

}  // namespace

RewindChoice draw_rewind(const Gui& gui, const Language& text, const RewindContent& content, RewindState& state) {
    const float u = gui.unit();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    RewindChoice choice = RewindChoice::none;
    if (begin_panel("rewind", ImVec2(kMargin * u, screen.y - kMargin * u), ImVec2(0.0f, 1.0f),
                    ImVec2(screen.x - 2.0f * kMargin * u, kPanelHeight * u), 0.86f)) {
        choice = draw_controls(gui, text, content, state);
        draw_timeline(gui, text, content, state);
        const bool there = std::fabs(content.shown_s - state.at_s) < 0.25 || state.playing;
        ImGui::PushFont(gui.fonts().small);
        ImGui::TextColored(colour::kFaint, "%s",
                           text(content.older ? "rewind.older"
                                : there       ? "rewind.hint"
                                              : "rewind.seeking")
                               .c_str());
        ImGui::PopFont();
    }
    ImGui::End();
    draw_moments(gui, text, content, state, rewind_height(gui));
    if (state.playing && state.at_s >= content.duration_s) state.playing = false;
    state.at_s = std::clamp(state.at_s, 0.0, content.duration_s);
    return choice;
}

void draw_opening(const Gui& gui, const Language& text, double waited_s) {
    const float u = gui.unit();
    if (begin_panel("opening", middle_of_screen(), ImVec2(0.5f, 0.5f), ImVec2(520.0f * u, 0.0f), 0.9f)) {
        heading(gui, text("rewind.opening"));
        // It is of unknown length: the bar creeps on, so that it never stands still.
        ImGui::ProgressBar(static_cast<float>(1.0 - std::exp(-0.5 * waited_s)), ImVec2(-1.0f, 14.0f * u), "");
    }
    ImGui::End();
}

}  // namespace calot::window
