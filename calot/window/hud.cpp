#include "calot/window/hud.h"

#include <cmath>

#include <fmt/format.h>

#include "calot/window/bindings.h"

namespace calot::window {

namespace {

using viewer::HudLine;
using viewer::Language;

constexpr float kMargin = 16.0f;

ImVec4 mood_colour(HudLine::Mood mood) {
    return mood == HudLine::Mood::good ? colour::kGood : mood == HudLine::Mood::bad ? colour::kBad : colour::kText;
}

/// Up to its first comma: what follows says how it is measured.
std::string short_name(const std::string& name) {
    return name.substr(0, name.find(','));
}

/// One half of the generator: its colour, its setting, lit while its pedal is down.
void pedal_box(const Gui& gui, const char* name, double setting_W, const ImVec4& tint, bool lit, float width) {
    const float u = gui.unit(), height = 86.0f * u;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec4 body(tint.x * (lit ? 1.0f : 0.22f), tint.y * (lit ? 1.0f : 0.22f), tint.z * (lit ? 1.0f : 0.22f),
                      1.0f);
    const ImVec4 ink = lit ? ImVec4(0.05f, 0.05f, 0.05f, 1.0f) : colour::kText;
    list->AddRectFilled(at, ImVec2(at.x + width, at.y + height), ImGui::GetColorU32(body), 8.0f * u);
    list->AddRectFilled(ImVec2(at.x + 4 * u, at.y + height - 7 * u),
                        ImVec2(at.x + width - 4 * u, at.y + height - 4 * u), ImGui::GetColorU32(tint), 2.0f * u);
    list->AddText(gui.fonts().small, gui.fonts().small->FontSize, ImVec2(at.x + 12 * u, at.y + 8 * u),
                  ImGui::GetColorU32(ink), name);
    const std::string watts = fmt::format("{:.0f} W", setting_W);
    list->AddText(gui.fonts().large, gui.fonts().large->FontSize, ImVec2(at.x + 12 * u, at.y + 30 * u),
                  ImGui::GetColorU32(ink), watts.c_str());
    ImGui::Dummy(ImVec2(width, height));
}

std::string ohms(double value) {
    return value < 1e4 ? fmt::format("{:.0f} \xce\xa9", value) : fmt::format("{:.0f} k\xce\xa9", 1e-3 * value);
}

/// Beneath the two pedals: their units tell them apart.
void two_values(const std::string& left, const std::string& right) {
    const float room = ImGui::GetContentRegionAvail().x, start = ImGui::GetCursorPosX();
    ImGui::TextUnformatted(left.c_str());
    ImGui::SameLine();
    ImGui::SetCursorPosX(start + room - ImGui::CalcTextSize(right.c_str()).x);
    ImGui::TextUnformatted(right.c_str());
}

void draw_generator(const Gui& gui, const Language& text, const HudContent& content) {
    const float u = gui.unit(), width = 300.0f * u;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const viewer::Figures& shot = content.snapshot;
    const bool cutting = shot.input.pedal && shot.input.mode != tissue::GeneratorMode::coag;
    const bool coagulating = shot.input.pedal && !cutting;
    if (begin_panel("generator", ImVec2(kMargin * u, screen.y - kMargin * u), ImVec2(0.0f, 1.0f),
                    ImVec2(width, 0.0f))) {
        const float half = 0.5f * (width - 2.0f * ImGui::GetStyle().WindowPadding.x - 8.0f * u);
        const std::string cut = text(content.settings.blended_cut ? "generator.blend" : "generator.cut");
        pedal_box(gui, cut.c_str(), content.settings.cut_W, colour::kYellow, cutting, half);
        ImGui::SameLine(0.0f, 8.0f * u);
        pedal_box(gui, text("generator.coag").c_str(), content.settings.coag_W, colour::kBlue, coagulating, half);
        const tissue::GeneratorState& g = shot.generator;
        const bool loaded = g.impedance_Ohm > 0.0 && shot.input.pedal;
        two_values(fmt::format("{:.1f} W", g.power_W),
                   loaded ? ohms(g.impedance_Ohm) : "\xe2\x80\x93 \xce\xa9");
        two_values(fmt::format("{:.0f} V", g.voltage_V), fmt::format("{:.0f} mA", 1e3 * g.current_A));
        if (shot.input.pedal && g.limit >= 0 && g.limit <= 3)  // what the generator is up against
            name_and_value(text("generator.limit"), text("generator.limit." + std::to_string(g.limit)));
        else
            name_and_value(text("generator.limit"), "\xe2\x80\x93");
    }
    ImGui::End();
}

void draw_exercise(const Gui& gui, const Language& text, const HudContent& content) {
    const float u = gui.unit();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    if (begin_panel("exercise", ImVec2(screen.x - kMargin * u, kMargin * u), ImVec2(1.0f, 0.0f),
                    ImVec2(310.0f * u, 0.0f))) {
        wrapped(text(content.exercise), colour::kAccent);
        name_and_value(text("hud.time"), clock_text(content.snapshot.time_s));
        name_and_value(text("hud.force"), fmt::format("{:.2f} N", glm::length(content.snapshot.hook_force_N)),
                       glm::length(content.snapshot.hook_force_N) > 3.0 ? colour::kBad : colour::kText);
        for (const HudLine& each : content.lines) {
            const bool goal = each.share >= 0.0;
            if (goal) ImGui::PushFont(gui.fonts().small);
            name_and_value(short_name(text(each.name)), text(each.value), mood_colour(each.mood));
            if (!goal) continue;
            ImGui::PopFont();
            progress(gui, each.share, each.mood == HudLine::Mood::good ? colour::kGood : colour::kAccent);
        }
    }
    ImGui::End();
}

/// What the hand on a device feels.
void draw_haptics(const Language& text, const HapticsFigures& haptics) {
    if (haptics.device.empty()) return;
    const ImVec4& tint = haptics.trouble.empty() ? colour::kText : colour::kBad;
    name_and_value(text("haptics.device"), haptics.device, tint);
    if (!haptics.trouble.empty()) {
        wrapped(haptics.trouble, colour::kBad);
        return;
    }
    name_and_value(text("haptics.rate"), fmt::format("{:.0f} /s", haptics.steps_per_s),
                   haptics.steps_per_s < 900.0 ? colour::kBad : colour::kGood);
    name_and_value(text("haptics.force"), fmt::format("{:.2f} N", haptics.force_N));
}

void draw_pace(const Gui& gui, const Language& text, const HudContent& content) {
    const float u = gui.unit();
    const viewer::Pace& pace = content.snapshot.pace;
    // Nothing is said of a rate before there is one, nor while time stands still.
    const bool known = pace.ticks_per_s > 0.0 && !content.snapshot.paused, slow = pace.ticks_per_s < 985.0;
    if (begin_panel("pace", ImVec2(kMargin * u, kMargin * u), ImVec2(0.0f, 0.0f), ImVec2(300.0f * u, 0.0f))) {
        ImGui::PushFont(gui.fonts().small);
        if (known)
            name_and_value(text("pace.physics"), fmt::format("{:.0f} /s", pace.ticks_per_s),
                           slow ? colour::kBad : colour::kGood);
        else
            name_and_value(text("pace.physics"), "\xe2\x80\x93");
        name_and_value(text("pace.tick"), fmt::format("{:.2f} ms", 1e-3 * pace.tick_us));
        name_and_value(text("pace.late"), fmt::format("{}", pace.late_ticks));
        name_and_value(text("pace.pictures"), fmt::format("{:.0f} /s", content.figures.pictures_per_s));
        name_and_value(text("pace.latency"), fmt::format("{:.0f} ms", content.figures.latency_ms));
        name_and_value(text("pace.quality"), content.figures.tier);
        wrapped(content.figures.scheduling, colour::kFaint);
        draw_haptics(text, content.figures.haptics);
        ImGui::PopFont();
    }
    ImGui::End();
}

/// What must not be overlooked, at the top: time runs slow, the left hand is active, the simulation stopped.
void draw_banner(const Gui& gui, const Language& text, const HudContent& content) {
    const viewer::Figures& shot = content.snapshot;
    std::string message;
    ImVec4 tint = colour::kAccent;
    if (!shot.status.ok) {
        message = fmt::format("{} ({})", text("banner.stopped"), shot.status.field);
        tint = colour::kBad;
    } else if (!shot.paused && shot.time_s > 1.0 && shot.pace.ticks_per_s > 0.0 && shot.pace.ticks_per_s < 960.0) {
        message = fmt::format("{} {:.0f} %", text("banner.slow"), 0.1 * shot.pace.ticks_per_s);
    } else if (content.left_hand) {
        message = text("banner.left_hand");
    } else if (content.suction || content.irrigation) {
        message = text(content.suction ? "banner.suction" : "banner.irrigation");
    }
    if (message.empty()) return;
    const float u = gui.unit();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float width = ImGui::CalcTextSize(message.c_str()).x + 2.0f * ImGui::GetStyle().WindowPadding.x;
    if (begin_panel("banner", ImVec2(0.5f * screen.x, kMargin * u), ImVec2(0.5f, 0.0f), ImVec2(width, 0.0f), 0.6f))
        ImGui::TextColored(tint, "%s", message.c_str());
    ImGui::End();
}

void draw_hint(const Gui& gui, const Language& text) {
    const float u = gui.unit();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::PushFont(gui.fonts().small);
    const std::string& hint = text("hud.hint");
    const float width = ImGui::CalcTextSize(hint.c_str()).x + 2.0f * ImGui::GetStyle().WindowPadding.x;
    if (begin_panel("hint", ImVec2(screen.x - kMargin * u, screen.y - kMargin * u), ImVec2(1.0f, 1.0f),
                    ImVec2(width, 0.0f), 0.45f))
        ImGui::TextColored(colour::kFaint, "%s", hint.c_str());
    ImGui::End();
    ImGui::PopFont();
}

void draw_help_group(float u, const Language& text, const HelpGroup& group) {
    ImGui::TextColored(colour::kAccent, "%s", text(group.title).c_str());
    for (const HelpLine& each : group.lines) {
        ImGui::TextUnformatted(text(each.keys).c_str());
        ImGui::SameLine(180.0f * u);
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextColored(colour::kFaint, "%s", text(each.text).c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::Dummy(ImVec2(1.0f, 6.0f * u));
}

/// Seconds until hands move again, large, in the middle.
void draw_countdown(const Gui& gui, const Language& text, double left_s) {
    if (left_s <= 0.0) return;
    const float u = gui.unit();
    if (begin_panel("countdown", middle_of_screen(), ImVec2(0.5f, 0.5f), ImVec2(380.0f * u, 0.0f), 0.7f)) {
        const auto centred = [](const std::string& words) {
            const float room = ImGui::GetWindowWidth(), width = ImGui::CalcTextSize(words.c_str()).x;
            ImGui::SetCursorPosX(0.5f * (room - width));
            ImGui::TextUnformatted(words.c_str());
        };
        centred(text("hud.ready"));
        ImGui::PushFont(gui.fonts().title);
        centred(fmt::format("{:.0f}", std::ceil(left_s)));
        ImGui::PopFont();
    }
    ImGui::End();
}

}  // namespace

std::string clock_text(double time_s) {
    const int seconds = static_cast<int>(time_s);
    return fmt::format("{}:{:02d}", seconds / 60, seconds % 60);
}

void draw_hud(const Gui& gui, const Language& text, const HudContent& content) {
    draw_generator(gui, text, content);
    draw_exercise(gui, text, content);
    if (content.settings.show_pace) draw_pace(gui, text, content);
    draw_banner(gui, text, content);
    draw_countdown(gui, text, content.countdown_s);
    draw_hint(gui, text);
}

void draw_help(const Gui& gui, const Language& text) {
    const float u = gui.unit();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ImVec2 size(std::fmin(1060.0f * u, screen.x - 24.0f * u), std::fmin(640.0f * u, screen.y - 24.0f * u));
    if (begin_panel("help", ImVec2(0.5f * screen.x, 0.5f * screen.y), ImVec2(0.5f, 0.5f), size, 0.94f)) {
        ImGui::PushFont(gui.fonts().large);
        ImGui::TextColored(colour::kAccent, "%s", text("help.title").c_str());
        ImGui::PopFont();
        ImGui::PushFont(gui.fonts().small);
        const std::size_t left = 3;  // groups in the left half
        for (const bool second : {false, true}) {
            if (second) ImGui::SameLine();
            ImGui::BeginChild(second ? "right" : "left", ImVec2(0.5f * (size.x - 46.0f * u), 0.0f));
            for (std::size_t k = 0; k < help().size(); ++k)
                if ((k >= left) == second) draw_help_group(u, text, help()[k]);
            ImGui::EndChild();
        }
        ImGui::PopFont();
    }
    ImGui::End();
}

}  // namespace calot::window
