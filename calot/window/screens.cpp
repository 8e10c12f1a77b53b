#include "calot/window/screens.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calot/tissue/input.h"
#include "calot/viewer/quality.h"

namespace calot::window {

using viewer::Language;

void draw_loading(const Gui& gui, const Language& text, const char* title, viewer::Loader::Step step, double waited_s) {
    const float u = gui.unit();
    if (begin_panel("loading", middle_of_screen(), ImVec2(0.5f, 0.5f), ImVec2(520.0f * u, 0.0f), 0.9f)) {
        heading(gui, text(title));
        const int done = static_cast<int>(step);
        // A step is of unknown length: the bar creeps on within it, so that it never stands still.
        const double within = 1.0 - std::exp(-waited_s);
        const double share = std::min(1.0, (done + 0.9 * within) / 4.0);
        ImGui::ProgressBar(static_cast<float>(share), ImVec2(-1.0f, 14.0f * u), "");
        ImGui::TextColored(colour::kFaint, "%s", text("loading." + std::to_string(done)).c_str());
    }
    ImGui::End();
}

PauseChoice draw_pause(const Gui& gui, const Language& text, bool rewind) {
    PauseChoice choice = PauseChoice::none;
    if (begin_panel("pause", middle_of_screen(), ImVec2(0.5f, 0.5f), ImVec2(440.0f * gui.unit(), 0.0f), 0.9f)) {
        heading(gui, text("pause.title"));
        if (wide_button(gui, text("pause.resume"))) choice = PauseChoice::resume;
        if (rewind && wide_button(gui, text("pause.rewind"))) choice = PauseChoice::rewind;
        if (wide_button(gui, text("pause.help"))) choice = PauseChoice::help;
        if (wide_button(gui, text("pause.settings"))) choice = PauseChoice::settings;
        if (wide_button(gui, text("pause.reset"))) choice = PauseChoice::reset;
        if (wide_button(gui, text("pause.finish"))) choice = PauseChoice::finish;
        if (wide_button(gui, text("pause.quit"))) choice = PauseChoice::quit;
    }
    ImGui::End();
    return choice;
}

namespace {

bool slider(const Gui& gui, const std::string& name, double& value, float low, float high, const char* format) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(colour::kFaint, "%s", name.c_str());
    ImGui::SameLine(250.0f * gui.unit());
    ImGui::SetNextItemWidth(-1.0f);
    auto shown = static_cast<float>(value);
    const bool changed = ImGui::SliderFloat(("##" + name).c_str(), &shown, low, high, format);
    if (changed) value = static_cast<double>(shown);
    return changed;
}

/// Settings that surgeons know by their names, a click each.
bool choose_preset(const Gui& gui, const Language& text, Settings& settings) {
    bool changed = false;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(colour::kFaint, "%s", text("settings.presets").c_str());
    float at = 250.0f * gui.unit();
    const float gap = 4.0f * gui.unit();
    const float width =
        (ImGui::GetContentRegionMax().x - at + gap) / static_cast<float>(tissue::kGeneratorPresets.size()) - gap;
    ImGui::PushFont(gui.fonts().small);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(2.0f, ImGui::GetStyle().FramePadding.y));
    for (const tissue::GeneratorPreset& preset : tissue::kGeneratorPresets) {
        ImGui::SameLine(at);
        at += width + gap;
        if (!ImGui::Button(preset.name, ImVec2(width, 0.0f))) continue;
        changed = true;
        if (preset.mode == tissue::GeneratorMode::coag) {
            settings.coag_W = preset.power_W;
        } else {
            settings.cut_W = preset.power_W;
            settings.blended_cut = preset.mode == tissue::GeneratorMode::blend;
        }
    }
    ImGui::PopStyleVar();
    ImGui::PopFont();
    return changed;
}

bool choose_language(const Gui& gui, const Language& text, const std::vector<std::string>& languages,
                     Settings& settings) {
    bool changed = false;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(colour::kFaint, "%s", text("settings.language").c_str());
    ImGui::SameLine(250.0f * gui.unit());
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::BeginCombo("##language", text("language." + settings.language).c_str())) {
        for (const std::string& name : languages)
            if (ImGui::Selectable(text("language." + name).c_str(), name == settings.language)) {
                settings.language = name;
                changed = true;
            }
        ImGui::EndCombo();
    }
    return changed;
}

bool choose_tier(const Gui& gui, const Language& text, const std::string& tier_now, Settings& settings) {
    const int count = static_cast<int>(viewer::tiers().size());
    bool changed = false;
    auto name = [&](int tier) { return tier < 0 ? text("settings.automatic") : text("tier." + std::to_string(tier)); };
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(colour::kFaint, "%s", text("settings.quality").c_str());
    ImGui::SameLine(250.0f * gui.unit());
    ImGui::SetNextItemWidth(-1.0f);
    const std::string shown = settings.tier < 0 ? fmt::format("{} ({})", name(-1), tier_now) : name(settings.tier);
    if (ImGui::BeginCombo("##tier", shown.c_str())) {
        for (int tier = -1; tier < count; ++tier)
            if (ImGui::Selectable(name(tier).c_str(), tier == settings.tier)) {
                settings.tier = tier;
                changed = true;
            }
        ImGui::EndCombo();
    }
    return changed;
}

}  // namespace

bool draw_settings(const Gui& gui, const Language& text, const std::vector<std::string>& languages,
                   const std::string& tier_now, Settings& settings, bool& changed) {
    bool close = false;
    const float u = gui.unit(), done = 52.0f * u;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ImVec2 size(std::min(660.0f * u, screen.x - 24.0f * u), std::min(624.0f * u, screen.y - 24.0f * u));
    if (begin_panel("settings", middle_of_screen(), ImVec2(0.5f, 0.5f), size, 0.94f)) {
        heading(gui, text("settings.title"));
        ImGui::BeginChild("rows", ImVec2(0.0f, -done - ImGui::GetStyle().ItemSpacing.y));
        changed |= choose_language(gui, text, languages, settings);
        changed |= choose_tier(gui, text, tier_now, settings);
        changed |= choose_preset(gui, text, settings);
        changed |= slider(gui, text("settings.cut"), settings.cut_W, 5.0f, 100.0f, "%.0f W");
        changed |= slider(gui, text("settings.coag"), settings.coag_W, 5.0f, 80.0f, "%.0f W");
        changed |= slider(gui, text("settings.mouse"), settings.hands.mouse, 0.2f, 2.0f, "%.2f");
        double wheel_mm = 1e3 * settings.hands.wheel_m;
        if (slider(gui, text("settings.wheel"), wheel_mm, 0.3f, 5.0f, "%.1f mm")) {
            settings.hands.wheel_m = 1e-3 * wheel_mm;
            changed = true;
        }
        changed |= slider(gui, text("settings.volume"), settings.volume, 0.0f, 1.0f, "%.2f");
        changed |= ImGui::Checkbox(text("settings.blend").c_str(), &settings.blended_cut);
        ImGui::SameLine(250.0f * u);
        changed |= ImGui::Checkbox(text("settings.invert_wheel").c_str(), &settings.hands.invert_wheel);
        changed |= ImGui::Checkbox(text("settings.mute").c_str(), &settings.muted);
        ImGui::SameLine(250.0f * u);
        changed |= ImGui::Checkbox(text("settings.pace").c_str(), &settings.show_pace);
        ImGui::EndChild();
        close = wide_button(gui, text("settings.close"));
    }
    ImGui::End();
    return close;
}

namespace {

const ImVec4& colour_of(viewer::HudLine::Mood mood) {
    return mood == viewer::HudLine::Mood::good  ? colour::kGood
           : mood == viewer::HudLine::Mood::bad ? colour::kBad
                                                : colour::kText;
}

/// What it came to, large, and whether that is the goal.
void draw_outcome(const Gui& gui, const Language& text, const viewer::HudLine& outcome) {
    ImGui::PushFont(gui.fonts().title);
    ImGui::TextColored(colour_of(outcome.mood), "%s", outcome.value.c_str());
    ImGui::PopFont();
    ImGui::SameLine(0.0f, 20.0f * gui.unit());
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 26.0f * gui.unit());
    ImGui::TextColored(colour::kFaint, "%s", text(outcome.name).c_str());
    ImGui::Dummy(ImVec2(1.0f, 4.0f * gui.unit()));
}

/// A measure, what it was, and what it brought.
void draw_part(const Gui& gui, const Language& text, const viewer::HudLine& part) {
    if (part.detail.empty()) {
        name_and_value(capitalised(text(part.name)), text(part.value), colour_of(part.mood));
        return;
    }
    const float start = ImGui::GetCursorPosX(), room = ImGui::GetContentRegionAvail().x;
    const auto at_right = [&](const std::string& words, float right, const ImVec4& tint) {
        ImGui::SameLine();
        ImGui::SetCursorPosX(start + right - ImGui::CalcTextSize(words.c_str()).x);
        ImGui::TextColored(tint, "%s", words.c_str());
    };
    ImGui::TextColored(colour::kFaint, "%s", text(part.name).c_str());
    at_right(part.detail, room - 80.0f * gui.unit(), colour::kText);
    at_right(part.value, room, colour_of(part.mood));
}

}  // namespace

DebriefChoice draw_debrief(const Gui& gui, const Language& text, const viewer::Debrief& debrief, bool report_ready) {
    DebriefChoice choice = DebriefChoice::none;
    const float u = gui.unit(), row = 52.0f * u, spacing = ImGui::GetStyle().ItemSpacing.y;
    const bool rewind = !debrief.past.recording.empty();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float width = std::min((debrief.outcome.value.empty() ? 640.0f : 760.0f) * u, screen.x - 24.0f * u);
    if (begin_panel("debrief", middle_of_screen(), ImVec2(0.5f, 0.5f), ImVec2(width, 0.0f), 0.92f)) {
        heading(gui, text(debrief.title.empty() ? "debrief.title" : debrief.title));
        if (!debrief.outcome.value.empty()) draw_outcome(gui, text, debrief.outcome);
        const float line = ImGui::GetTextLineHeightWithSpacing();
        const float below = (rewind ? 3.0f : 2.0f) * (row + spacing) + ImGui::GetCursorPosY() + 60.0f * u;
        const float lines = std::min(line * static_cast<float>(debrief.lines.size()) + 4.0f * u, screen.y - below);
        if (!debrief.lines.empty()) {
            ImGui::BeginChild("lines", ImVec2(0.0f, std::max(3.0f * line, lines)));
            for (const viewer::HudLine& each : debrief.lines) draw_part(gui, text, each);
            ImGui::EndChild();
        }
        ImGui::Dummy(ImVec2(1.0f, 4.0f * u));
        if (rewind && main_button(gui, text("debrief.rewind"), ImVec2(-1.0f, row))) choice = DebriefChoice::rewind;
        const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
        int placed = 0;
        const auto button = [&](bool there, const char* key, DebriefChoice what) {
            if (!there) return;
            if (placed++ % 2 == 1) ImGui::SameLine();
            if (ImGui::Button(text(key).c_str(), ImVec2(half, row))) choice = what;
        };
        button(!debrief.questionnaire.statements.empty(), "debrief.questions", DebriefChoice::questions);
        ImGui::BeginDisabled(!report_ready);
        button(!debrief.report.empty(), report_ready ? "debrief.report" : "debrief.report_soon", DebriefChoice::report);
        ImGui::EndDisabled();
        button(true, "debrief.again", DebriefChoice::again);
        button(true, "debrief.menu", DebriefChoice::menu);
    }
    ImGui::End();
    return choice;
}

bool draw_trouble(const Gui& gui, const Language& text, const std::string& message) {
    bool close = false;
    if (begin_panel("trouble", middle_of_screen(), ImVec2(0.5f, 0.5f), ImVec2(720.0f * gui.unit(), 0.0f), 0.95f)) {
        heading(gui, text("trouble.title"));
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextUnformatted(message.c_str());
        ImGui::PopTextWrapPos();
        close = wide_button(gui, text("trouble.close"));
    }
    ImGui::End();
    return close;
}

}  // namespace calot::window
