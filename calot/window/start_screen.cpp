#include "calot/window/start_screen.h"

#include <algorithm>

#include <fmt/format.h>

namespace calot::window {

using viewer::Language;

namespace {

/// One of a list; the chosen one carries a bar at its left edge.
bool list_button(const Gui& gui, const std::string& label, bool chosen, int number) {
    const float u = gui.unit(), width = ImGui::GetContentRegionAvail().x, height = 50.0f * u;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(number);
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.30f, 0.23f, 0.16f, 1.0f));
    const bool pressed = ImGui::Button("##entry", ImVec2(width, height));
    if (chosen) ImGui::PopStyleColor();
    ImGui::PopID();
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (chosen)
        list->AddRectFilled(ImVec2(at.x, at.y + 6 * u), ImVec2(at.x + 4 * u, at.y + height - 6 * u),
                            ImGui::GetColorU32(colour::kAccent), 2.0f * u);
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    list->PushClipRect(at, ImVec2(at.x + width - 8 * u, at.y + height), true);
    list->AddText(ImVec2(at.x + 18 * u, at.y + 0.5f * (height - size.y)), ImGui::GetColorU32(colour::kText),
                  label.c_str());
    list->PopClipRect();
    return pressed;
}

/// A patient: who, and how hard, as filled dots.
bool patient_button(const Gui& gui, const Language& text, const viewer::Patient& patient, bool chosen, int number) {
    const float u = gui.unit();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const bool pressed = list_button(gui, text(patient.about), chosen, number);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const std::string& word = text("difficulty." + std::to_string(patient.difficulty));
    ImGui::PushFont(gui.fonts().small);
    const ImVec2 size = ImGui::CalcTextSize(word.c_str());
    ImGui::PopFont();
    const float middle = at.y + 25.0f * u, right = at.x + width - 18.0f * u;
    list->AddText(gui.fonts().small, gui.fonts().small->FontSize,
                  ImVec2(right - 64.0f * u - size.x, middle - 0.5f * size.y), ImGui::GetColorU32(colour::kFaint),
                  word.c_str());
    for (int dot = 0; dot < 3; ++dot) {
        const ImVec2 centre(right - static_cast<float>(2 - dot) * 20.0f * u - 6.0f * u, middle);
        if (dot < patient.difficulty)
            list->AddCircleFilled(centre, 6.0f * u, ImGui::GetColorU32(colour::kAccent));
        else
            list->AddCircle(centre, 6.0f * u, ImGui::GetColorU32(colour::kFaint), 0, 1.5f * u);
    }
    return pressed;
}

void draw_patients(const Gui& gui, const Language& text, const std::vector<viewer::Patient>& patients,
                   StartSelection& selection) {
    const float u = gui.unit();
    ImGui::TextColored(colour::kFaint, "%s", text("start.patient").c_str());
    const int count = static_cast<int>(patients.size());
    selection.patient = std::min(selection.patient, count - 1);
    for (int k = 0; k < count; ++k)
        if (patient_button(gui, text, patients[static_cast<std::size_t>(k)], k == selection.patient, 100 + k))
            selection.patient = k;
    if (list_button(gui, text("patient.by_seed"), selection.patient < 0, 99)) selection.patient = -1;
    if (selection.patient >= 0) return;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(colour::kFaint, "%s", text("start.seed").c_str());
    ImGui::SameLine();
    ImGui::SetNextItemWidth(220.0f * u);
    ImGui::InputInt("##seed", &selection.seed);
    selection.seed = std::clamp(selection.seed, 0, 1'000'000'000);
}

void draw_chosen(const Gui& gui, const Language& text, const viewer::Exercise& exercise, bool patients,
                 StartSelection& selection, bool& start) {
    const float u = gui.unit();
    heading(gui, text(exercise.name));
    ImGui::BeginChild("about", ImVec2(0.0f, -(60.0f * u + ImGui::GetStyle().ItemSpacing.y)));
    wrapped(text(exercise.about));
    for (const std::string& hint : exercise.hints) {
        ImGui::PushFont(gui.fonts().small);
        ImGui::TextColored(colour::kAccent, "\xe2\x80\x93");
        ImGui::SameLine();
        wrapped(text(hint), colour::kFaint);
        ImGui::PopFont();
    }
    ImGui::Dummy(ImVec2(1.0f, 8.0f * u));
    if (patients && exercise.patients) draw_patients(gui, text, viewer::patients_of(exercise), selection);
    ImGui::EndChild();
    start = main_button(gui, text("start.start"), ImVec2(-1.0f, 60.0f * u));
}

}  // namespace

StartChoice draw_start(const Gui& gui, const Language& text, const std::vector<viewer::Exercise>& exercises,
                       bool patients, StartSelection& selection) {
    const float u = gui.unit();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    StartChoice choice;
    const float gap = 12.0f * u, whole = std::min(1180.0f * u, screen.x - 2.0f * gap);
    const float height = std::min(760.0f * u, screen.y - 2.0f * gap);
    const float left = std::clamp(0.36f * whole, std::min(280.0f * u, 0.45f * whole), 420.0f * u);
    const ImVec2 at(0.5f * (screen.x - whole), 0.5f * (screen.y - height));
    if (begin_panel("start", at, ImVec2(0.0f, 0.0f), ImVec2(left, height), 0.86f)) {
        ImGui::PushFont(gui.fonts().title);
        ImGui::TextUnformatted("Calot");
        ImGui::PopFont();
        wrapped(text("start.subtitle"), colour::kFaint);
        ImGui::Dummy(ImVec2(1.0f, 8.0f * u));
        ImGui::PushFont(gui.fonts().small);
        const ImVec2 notice =
            ImGui::CalcTextSize(text("start.notice").c_str(), nullptr, false, ImGui::GetContentRegionAvail().x);
        ImGui::PopFont();
        const float below = 2.0f * 46.0f * u + 3.0f * ImGui::GetStyle().ItemSpacing.y + notice.y;
        ImGui::BeginChild("list", ImVec2(0.0f, -below));
        for (std::size_t k = 0; k < exercises.size(); ++k)
            if (list_button(gui, text(exercises[k].name), static_cast<int>(k) == selection.exercise,
                            static_cast<int>(k)) &&
                static_cast<int>(k) != selection.exercise) {
                selection.exercise = static_cast<int>(k);
                selection.patient = 0;
            }
        ImGui::EndChild();
        choice.settings = wide_button(gui, text("start.settings"), 46.0f);
        choice.quit = wide_button(gui, text("start.quit"), 46.0f);
        ImGui::PushFont(gui.fonts().small);
        wrapped(text("start.notice"), colour::kFaint);
        ImGui::PopFont();
    }
    ImGui::End();
    if (begin_panel("chosen", ImVec2(at.x + left + gap, at.y), ImVec2(0.0f, 0.0f), ImVec2(whole - left - gap, height),
                    0.86f))
        draw_chosen(gui, text, exercises[static_cast<std::size_t>(selection.exercise)], patients, selection,
                    choice.start);
    ImGui::End();
    return choice;
}

CutOffChoice draw_cut_off(const Gui& gui, const Language& text, const viewer::CutOff& cut_off) {
    CutOffChoice choice = CutOffChoice::none;
    if (begin_panel("cut off", middle_of_screen(), ImVec2(0.5f, 0.5f), ImVec2(560.0f * gui.unit(), 0.0f), 0.94f)) {
        heading(gui, text("cut_off.title"));
        wrapped(text(cut_off.title));
        if (cut_off.started_utc.size() >= 16)  // 2026-01-31T14:05:00Z
            name_and_value(text("cut_off.started"),
                           cut_off.started_utc.substr(0, 10) + "  " + cut_off.started_utc.substr(11, 5));
        wrapped(text("cut_off.about"), colour::kFaint);
        ImGui::Dummy(ImVec2(1.0f, 8.0f * gui.unit()));
        if (main_button(gui, text("cut_off.look"), ImVec2(-1.0f, 52.0f * gui.unit()))) choice = CutOffChoice::look;
        if (wide_button(gui, text("cut_off.close"))) choice = CutOffChoice::close;
    }
    ImGui::End();
    return choice;
}

}  // namespace calot::window
