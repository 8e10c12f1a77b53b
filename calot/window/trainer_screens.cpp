// The trainer's screens: which is drawn, and what follows from what was chosen there.

#include "calot/window/trainer_window.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/window/open_page.h"

namespace calot::window {

namespace {

constexpr double kFullSizzle_kg_per_s = 2.0e-5;
constexpr double kBackFromPause_s = 5.0;  ///< where the timeline stands at first after a pause

}  // namespace

void Trainer::play_sound() {
    viewer::SoundScene scene;
    scene.volume = settings_.muted || screen_ != Screen::practice || help_ ? 0.0 : settings_.volume;
    const viewer::Figures& figures = pictures_.picture().figures;
    const bool active = screen_ == Screen::practice && figures.input.pedal;
    scene.coagulating = active && figures.input.mode == tissue::GeneratorMode::coag;
    scene.cutting = active && !scene.coagulating;
    scene.sizzle = std::sqrt(std::max(0.0, figures.boiling_kg_per_s / kFullSizzle_kg_per_s));
    scene.suction = figures.input.suction;
    scene.irrigation = figures.input.irrigation;
    sound_.set(scene);
}

void Trainer::draw_screens() {
    if (help_ && screen_ != Screen::loading) {
        draw_help(gui_, text_);
        return;
    }
    bool changed = false;
    switch (screen_) {
        case Screen::start:
            if (!settings_open_) draw_start_screen();
            break;
        case Screen::loading:
            if (loader_ && loader_->step() != loading_step_) {
                loading_step_ = loader_->step();
                loading_since_s_ = now_s_;
            }
            draw_loading(gui_, text_, resumed_ ? "loading.resumed" : "loading.title", loading_step_,
                         now_s_ - loading_since_s_);
            break;
        case Screen::practice:
            draw_practice();
            break;
        case Screen::paused:
            draw_practice();
            if (!settings_open_ && !help_) handle(draw_pause(gui_, text_, attempt_ != nullptr));
            break;
        case Screen::debrief:
            handle(draw_debrief(gui_, text_, debrief_, std::filesystem::exists(debrief_.report)));
            break;
        case Screen::questions:
            draw_questions();
            break;
        case Screen::opening:
            draw_opening(gui_, text_, now_s_ - loading_since_s_);
            break;
        case Screen::rewind:
            draw_rewind_screen();
            break;
        case Screen::trouble:
            if (draw_trouble(gui_, text_, trouble_)) screen_ = Screen::start;
            break;
    }
    if (settings_open_ && screen_ != Screen::practice &&
        draw_settings(gui_, text_, languages_, text_("tier." + std::to_string(pictures_.picture().tier)), settings_,
                      changed))
        settings_open_ = false;
    if (changed) {
        settings_changed_ = true;
        apply_settings();
    }
}

void Trainer::draw_start_screen() {
    if (options_.cut_off) {
        const CutOffChoice choice = draw_cut_off(gui_, text_, *options_.cut_off);
        if (choice == CutOffChoice::none) return;
        const viewer::CutOff cut_off = *std::exchange(options_.cut_off, std::nullopt);
        cut_off.close();
        if (choice == CutOffChoice::close) return;
        for (std::size_t k = 0; k < options_.exercises.size(); ++k)
            if (options_.exercises[k].id == cut_off.exercise) exercise_ = selection_.exercise = static_cast<int>(k);
        setup_.reset();
        open_rewind(cut_off.past, Screen::start, 0.0);
        return;
    }
    const StartChoice choice = draw_start(gui_, text_, options_.exercises, options_.patients, selection_);
    if (choice.quit) quit_ = true;
    if (choice.settings) settings_open_ = true;
    if (choice.start) load(selection_.exercise);
}

void Trainer::draw_questions() {
    const QuestionnaireChoice choice = draw_questionnaire(gui_, text_, debrief_.questionnaire, answers_);
    if (choice == QuestionnaireChoice::none) return;
    screen_ = Screen::debrief;
    if (choice == QuestionnaireChoice::skip) return;
    try {
        debrief_.questionnaire.store(answers_.values, answers_.remark.data());
        debrief_.questionnaire.statements.clear();  // answered
    } catch (const InputError& error) {
        trouble_ = error.describe();
        screen_ = Screen::trouble;
    } catch (const std::exception& error) {
        trouble_ = error.what();
        screen_ = Screen::trouble;
    }
}

/// What the device says, a rate from what it counts.
HapticsFigures Trainer::haptics_figures() {
    HapticsFigures figures;
    if (!device_) return figures;
    const haptics::SessionStatus status = device_->status();
    figures.device = status.device.model.empty() ? status.device.name : status.device.model;
    if (!status.open)
        figures.trouble = status.note;
    else if (status.servo.fault != haptics::Fault::none)
        figures.trouble = haptics::describe(status.servo.fault);
    device_rate_.add(now_s_, status.servo.steps - std::exchange(device_steps_, status.servo.steps));
    figures.steps_per_s = device_rate_.per_s();
    figures.force_N = glm::length(status.servo.device_force_N);
    return figures;
}

PictureFigures Trainer::figures() {
    PictureFigures figures;
    figures.pictures_per_s = picture_rate_.per_s();
    figures.draw_ms = 1e3 * pictures_.picture().draw_s;
    figures.latency_ms = 1e3 * latency_s_;
    figures.tier = text_("tier." + std::to_string(pictures_.picture().tier));
    figures.scheduling = session_->real_time() ? text_("pace.real_time") : text_("pace.normal");
    if (const std::string why = session_->why_not_real_time(); !why.empty()) figures.scheduling += ": " + why;
    figures.haptics = haptics_figures();
    return figures;
}

void Trainer::draw_practice() {
    std::vector<viewer::HudLine> lines;
    if (attempt_) lines = attempt_->hud();
    const viewer::Controls& controls = mapping_->controls();
    draw_hud(gui_, text_,
             {pictures_.picture().figures, figures(), settings_,
              options_.exercises[static_cast<std::size_t>(exercise_)].name, lines, mapping_->left_active(),
              controls.suction, controls.irrigation, hands_free_s_ - now_s_});
}

void Trainer::handle(PauseChoice choice) {
    switch (choice) {
        case PauseChoice::none:
            break;
        case PauseChoice::resume:
            screen_ = Screen::practice;
            break;
        case PauseChoice::rewind: {
            end_session();
            if (!debrief_.past.recording.empty()) open_rewind(debrief_.past, Screen::debrief, kBackFromPause_s);
            break;
        }
        case PauseChoice::reset:
            load(exercise_);
            break;
        case PauseChoice::settings:
            settings_open_ = true;
            break;
        case PauseChoice::help:
            help_ = true;
            break;
        case PauseChoice::finish:
            end_session();
            break;
        case PauseChoice::quit:
            quit_ = true;
            break;
    }
}

void Trainer::handle(DebriefChoice choice) {
    if (choice == DebriefChoice::again) load(exercise_);
    if (choice == DebriefChoice::menu) screen_ = Screen::start;
    if (choice == DebriefChoice::report && !open_page(debrief_.report)) {
        trouble_ = fmt::format("{}\n{}", text_("debrief.open_it"), debrief_.report);
        screen_ = Screen::trouble;
    }
    if (choice == DebriefChoice::questions) screen_ = Screen::questions;
    if (choice == DebriefChoice::rewind) open_rewind(debrief_.past, Screen::debrief, 0.0);
}

}  // namespace calot::window
