// The trainer's rewinding: a run that is over, on a timeline, and going on from a moment of it.

#include "calot/window/trainer_window.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <tuple>
#include <utility>

namespace calot::window {

namespace {

constexpr double kAhead_s = 0.3;  ///< the timeline may be before the picture while it plays
constexpr double kKeyStep_s = 1.0;
// The mouse as the hand on the laparoscope, while nothing is held.
constexpr double kTurnPerHeight_rad = 0.35, kLensPerHeight_rad = 3.0, kDeeperPerNotch_m = 4e-3;

}  // namespace

void Trainer::open_rewind(const viewer::Past& past, Screen back, double from_end_s) {
    past_ = past;
    rewind_back_ = back;
    rewind_from_end_s_ = from_end_s;
    if (past.marks.empty() && past.find_marks) marks_ = std::async(std::launch::async, past.find_marks);
    loading_since_s_ = now_s_;
    replay_ = std::make_unique<viewer::Replay>(past.recording, setup_);
    screen_ = Screen::opening;
}

void Trainer::close_rewind() {
    if (!replay_) return;
    pictures_.show(nullptr);
    replay_.reset();
}

/// The replay follows the timeline, as far as it can.
void Trainer::rewind(double dt_s) {
    if (const std::string trouble = replay_->trouble(); !trouble.empty()) {
        close_rewind();
        trouble_ = trouble;
        screen_ = Screen::trouble;
        return;
    }
    if (!replay_->ready()) return;
    const double tick_s = replay_->setup()->model.tick_s;
    const double duration_s = static_cast<double>(replay_->ticks()) * tick_s;
    if (screen_ == Screen::opening) {
        screen_ = Screen::rewind;
        setup_ = replay_->setup();
        if (!scope_) scope_.emplace(setup_->camera);
        rewind_ = {std::max(0.0, duration_s - rewind_from_end_s_), false};
        lens_ = {};
        pictures_.show(&replay_->snapshots());
        for (const Command key :
             {Command::play, Command::earlier, Command::later, Command::first, Command::last, Command::enter})
            window_.take(key);  // from before
    }
    if (rewind_.playing)  // no further ahead of the picture than the eye forgives
        rewind_.at_s =
            std::min({rewind_.at_s + dt_s, static_cast<double>(replay_->shown()) * tick_s + kAhead_s, duration_s});
    replay_->wish(std::llround(rewind_.at_s / tick_s));
}

/// Goes on from the moment on the timeline, as a new session.
void Trainer::take_over() {
    const std::int64_t tick =
        std::clamp<std::int64_t>(std::llround(rewind_.at_s / setup_->model.tick_s), 0, replay_->ticks());
    close_rewind();
    resumed_ = true;
    loader_ = std::make_unique<viewer::Loader>([this, resume = past_.resume, tick, setup = setup_] {
        viewer::Loader::Start start;
        std::tie(start.run, attempt_) = resume(tick, setup);
        start.observers = {attempt_};
        return start;
    });
    loading_since_s_ = now_s_;
    loading_step_ = viewer::Loader::Step::tissue;
    screen_ = Screen::loading;
}

/// What happened in a session whose program ended before it could tell.
void Trainer::take_marks() {
    if (!marks_.valid() || marks_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    try {
        past_.marks = marks_.get();
    } catch (const std::exception&) {
        // The timeline has the pedal at least.
    }
}

void Trainer::draw_rewind_screen() {
    take_marks();
    const double tick_s = setup_->model.tick_s;
    handle(draw_rewind(gui_, text_,
                       {static_cast<double>(replay_->ticks()) * tick_s, static_cast<double>(replay_->shown()) * tick_s,
                        replay_->pedal(), past_.marks, replay_->older()},
                       rewind_));
    if (screen_ != Screen::rewind) return;
    look_about();
    obey_timeline_keys();
}

void Trainer::obey_timeline_keys() {
    const double before_s = rewind_.at_s, end_s = static_cast<double>(replay_->ticks()) * setup_->model.tick_s;
    if (window_.take(Command::earlier)) rewind_.at_s -= kKeyStep_s;
    if (window_.take(Command::later)) rewind_.at_s += kKeyStep_s;
    if (window_.take(Command::first)) rewind_.at_s = 0.0;
    if (window_.take(Command::last)) rewind_.at_s = end_s;
    rewind_.at_s = std::clamp(rewind_.at_s, 0.0, end_s);
    if (rewind_.at_s != before_s) rewind_.playing = false;
    if (window_.take(Command::play)) rewind_.playing = !rewind_.playing;
    if (window_.take(Command::enter)) take_over();
}

/// The mouse turns the laparoscope where no panel is under it.
void Trainer::look_about() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse) return;
    const auto height = static_cast<double>(io.DisplaySize.y);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left))
        scope_->turn(-kTurnPerHeight_rad * static_cast<double>(io.MouseDelta.x) / height,
                     kTurnPerHeight_rad * static_cast<double>(io.MouseDelta.y) / height);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right))
        scope_->rotate_lens(kLensPerHeight_rad * static_cast<double>(io.MouseDelta.x) / height);
    scope_->advance(kDeeperPerNotch_m * static_cast<double>(io.MouseWheel));
}

void Trainer::handle(RewindChoice choice) {
    if (choice == RewindChoice::take_over) take_over();
    if (choice != RewindChoice::back) return;
    close_rewind();
    screen_ = rewind_back_;
}

}  // namespace calot::window
