#include "calot/window/trainer_window.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/viewer/data_files.h"

namespace calot::window {

using viewer::steady_s;

namespace {

constexpr double kIdleFrame_s = 1.0 / 30.0;  ///< the window is drawn at least so often
constexpr double kTurn_s = 2e-3;             ///< the devices are read at least so often
constexpr double kAhead_s = 0.3;             ///< the timeline may be before the picture while it plays
constexpr double kReady_s = 3.0;             ///< to find the hands again after a rewind

}  // namespace

Trainer::Trainer(const TrainerOptions& options)
    : options_(options),
      data_(viewer::data_directory()),
      settings_path_(settings_path()),
      settings_(load_settings(settings_path_)),
      languages_(viewer::Language::available(data_ + "/lang")),
      window_(options.width, options.height, "Calot", options.fullscreen),
      gui_(window_.handle(), window_.content_scale()),
      pictures_(window_.handle(), window_.renderer()) {
    if (!options_.language.empty()) settings_.language = options_.language;
    if (std::find(languages_.begin(), languages_.end(), settings_.language) == languages_.end()) {
        if (!options_.language.empty())
            throw InputError("there is no language file " + data_ + "/lang/" + options_.language + ".toml",
                             "copy en.toml to it and translate, or leave --language out");
        settings_.language = "en";
    }
    apply_settings();
    if (options_.start.empty()) return;
    for (std::size_t k = 0; k < options_.exercises.size(); ++k)
        if (options_.exercises[k].id == options_.start) {
            selection_.exercise = static_cast<int>(k);
            load(static_cast<int>(k));
            return;
        }
    std::string ids;
    for (const viewer::Exercise& exercise : options_.exercises) ids += (ids.empty() ? "" : ", ") + exercise.id;
    throw InputError("there is no exercise \"" + options_.start + "\"", "there are: " + ids);
}

void Trainer::apply_settings() {
    if (text_.name() != settings_.language) text_ = viewer::Language(data_ + "/lang", settings_.language);
    if (mapping_) mapping_->sensitivity() = settings_.hands;
}

void Trainer::run() {
    while (!window_.should_close() && !quit_) {
        window_.poll();
        turn();
    }
    end_session();
    close_rewind();
    if (settings_changed_) save_settings(settings_path_, settings_);
}

void Trainer::turn() {
    now_s_ = steady_s();
    const double dt_s = std::min(0.1, now_s_ - std::exchange(last_s_, now_s_));
    obey_commands();
    if (loader_ && loader_->finished()) finish_loading();
    if (has_pause()) practise(dt_s);
    if (replay_) rewind(dt_s);
    play_sound();
    window_.capture_mouse(screen_ == Screen::practice && !help_);
    ask_for_picture();
    const bool fresh = pictures_.update();
    if (screen_ == Screen::loading && !loader_ && fresh) begin_practice();
    if (const std::string trouble = pictures_.take_trouble(); !trouble.empty()) {
        end_session();
        close_rewind();
        trouble_ = trouble;
        screen_ = Screen::trouble;
    }
    if (!fresh && now_s_ - drawn_s_ < kIdleFrame_s) {
        window_.wait(kTurn_s);
        return;
    }
    draw_window();
    if (!fresh) return;
    const double done_s = steady_s();
    picture_rate_.add(done_s);
    const viewer::Figures& figures = pictures_.picture().figures;
    if (figures.sequence > answered_) {
        answered_ = figures.sequence;
        latency_s_ += 0.1 * (done_s - figures.sampled_s - latency_s_);
    }
}

void Trainer::draw_window() {
    drawn_s_ = now_s_;
    int width = 0, height = 0;
    window_.size(width, height);
    if (width == 0 || height == 0) return;
    glViewport(0, 0, width, height);
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    gui_.begin_frame(!window_.captured(), screen_ != Screen::rewind);
    draw_picture(width, height);
    draw_screens();
    gui_.end_frame();
    window_.type(ImGui::GetIO().WantTextInput);
    if (std::exchange(picture_wanted_, false)) take_picture(width, height);
    window_.swap();
}

void Trainer::obey_commands() {
    const bool focused = window_.focused();
    if (focused_ && !focused && screen_ == Screen::practice) screen_ = Screen::paused;
    focused_ = focused;
    if (window_.take(Command::pause)) {
        if (help_)
            help_ = false;
        else if (settings_open_)
            settings_open_ = false;
        else if (has_pause())
            screen_ = screen_ == Screen::practice ? Screen::paused : Screen::practice;
        else if (screen_ == Screen::rewind)
            handle(RewindChoice::back);
        else if (screen_ == Screen::questions)
            screen_ = Screen::debrief;
    }
    if (window_.take(Command::help)) help_ = !help_;
    if (window_.take(Command::pace)) settings_.show_pace = !settings_.show_pace, settings_changed_ = true;
    if (window_.take(Command::mute)) settings_.muted = !settings_.muted, settings_changed_ = true;
    if (window_.take(Command::fullscreen)) window_.toggle_fullscreen();
    if (window_.take(Command::picture)) picture_wanted_ = true;
    if (window_.take(Command::reset) && has_pause()) {
        load(exercise_);
        return;
    }
    static constexpr std::pair<Command, viewer::Scope::Preset> kPresets[] = {
        {Command::preset1, viewer::Scope::Preset::start},
        {Command::preset2, viewer::Scope::Preset::overview},
        {Command::preset3, viewer::Scope::Preset::close},
        {Command::preset4, viewer::Scope::Preset::from_side}};
    for (const auto& [command, preset] : kPresets)
        if (window_.take(command) && scope_) scope_->go(preset);
    if (window_.take(Command::wipe)) lens_.wipe();
}

void Trainer::load(int exercise) {
    end_session();
    close_rewind();
    resumed_ = false;
    exercise_ = exercise;
    const viewer::Exercise& chosen = options_.exercises[static_cast<std::size_t>(exercise)];
    SceneWish wish;
    wish.scene = chosen.scene;
    wish.assignments = chosen.assignments;
    wish.any_patient = options_.patients && chosen.patients;
    if (wish.any_patient) {
        const std::vector<viewer::Patient>& patients = viewer::patients_of(chosen);
        wish.seed = static_cast<std::uint64_t>(selection_.seed);
        if (selection_.patient >= 0 && selection_.patient < static_cast<int>(patients.size())) {
            const viewer::Patient& patient = patients[static_cast<std::size_t>(selection_.patient)];
            wish.seed = patient.seed;
            wish.assignments.insert(wish.assignments.end(), patient.assignments.begin(), patient.assignments.end());
        }
    }
    loader_ = std::make_unique<viewer::Loader>([make = options_.make_scene, wish] { return make(wish); },
                                               [this, make = chosen.attempt](const simulation::Setup& setup) {
                                                   std::vector<std::shared_ptr<viewer::Observer>> observers;
                                                   if (make) attempt_ = make(setup);
                                                   if (attempt_) observers.push_back(attempt_);
                                                   return observers;
                                               },
                                               options_.prepare);
    loading_since_s_ = now_s_;
    loading_step_ = viewer::Loader::Step::scene;
    screen_ = Screen::loading;
}

void Trainer::finish_loading() {
    try {
        session_ = loader_->take();
        if (loader_->setup()) setup_ = loader_->setup();
    } catch (const InputError& error) {
        trouble_ = error.describe();
    } catch (const std::exception& error) {
        trouble_ = error.what();
    }
    loader_.reset();
    if (!session_) {
        screen_ = Screen::trouble;
        return;
    }
    mapping_.emplace(session_->theatre());
    mapping_->sensitivity() = settings_.hands;
    if (!resumed_) scope_.emplace(session_->setup().camera);
    lens_ = {};
    answered_ = 0;
    if (options_.make_device) session_->hold(device_ = options_.make_device(session_->setup()));
    loading_step_ = viewer::Loader::Step::picture;
    loading_since_s_ = now_s_;
    // The first picture makes the shaders, which may take a while: the loading screen stays until it is there.
    pictures_.show(&session_->snapshots());
    pictures_.update();  // one of the session before
}

void Trainer::begin_practice() {
    session_->start();
    screen_ = Screen::practice;
    hands_free_s_ = resumed_ ? now_s_ + kReady_s : 0.0;
}

void Trainer::practise(double dt_s) {
    viewer::Devices devices = window_.take_devices();
    devices.grasp_toggled = window_.take(Command::grasp);
    if (screen_ != Screen::practice || help_ || counting_down()) devices = {};
    mapping_->apply(devices, dt_s, *scope_);
    viewer::Controls& controls = mapping_->controls();
    controls.cut_W = settings_.cut_W;
    controls.coag_W = settings_.coag_W;
    controls.blended_cut = settings_.blended_cut;
    controls.paused = screen_ == Screen::paused || help_ || counting_down();
    controls.sampled_s = now_s_;
    session_->set(controls);
    if (!controls.paused) lens_.advance(pictures_.picture().figures, scope_->tip_m(), dt_s);
    if (attempt_ && attempt_->done()) end_session();
}

void Trainer::end_session() {
    if (!session_) return;
    pictures_.show(nullptr);
    session_->stop();
    screen_ = Screen::start;
    if (attempt_) {
        debrief_ = attempt_->debrief();
        answers_ = {};
        screen_ = Screen::debrief;
    }
    attempt_.reset();
    mapping_.reset();
    device_.reset();
    session_.reset();
}

void Trainer::ask_for_picture() {
    if (!scope_) return;
    PictureWish wish;
    wish.camera = scope_->camera();
    wish.lens = lens_.look();
    window_.size(wish.width, wish.height);
    wish.tier = settings_.tier;
    if (wish == wished_) return;
    wished_ = wish;
    pictures_.wish(wish);
}

void Trainer::draw_picture(int width, int height) {
    const Picture& picture = pictures_.picture();
    const bool behind = screen_ == Screen::start || screen_ == Screen::loading || screen_ == Screen::trouble;
    if (behind || !scope_ || picture.texture == 0) return;
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture.texture)), ImVec2(0.0f, 0.0f),
        ImVec2(static_cast<float>(width), static_cast<float>(height)), ImVec2(0.0f, 1.0f), ImVec2(1.0f, 0.0f));
}

void Trainer::open_rewind(const viewer::Past& past, Screen back, double from_end_s) {
    past_ = past;
    rewind_back_ = back;
    rewind_from_end_s_ = from_end_s;
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
        for (const Command key : {Command::play, Command::earlier, Command::later, Command::first, Command::last,
                                  Command::enter})
            window_.take(key);  // from before
    }
    if (rewind_.playing)  // no further ahead of the picture than the eye forgives
        rewind_.at_s = std::min({rewind_.at_s + dt_s, static_cast<double>(replay_->shown()) * tick_s + kAhead_s,
                                 duration_s});
    replay_->wish(std::llround(rewind_.at_s / tick_s));
}

/// Goes on from the moment on the timeline, as a new session.
void Trainer::take_over() {
    const std::int64_t tick = std::clamp<std::int64_t>(std::llround(rewind_.at_s / setup_->model.tick_s), 0, replay_->ticks());
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

void Trainer::take_picture(int width, int height) {
    const std::string file = fmt::format("{}/calot-{:03d}.png", options_.pictures, ++pictures_taken_);
    render::write_png(file, read_window(width, height));
}

void run_trainer(const TrainerOptions& options) {
    Trainer(options).run();
}

}  // namespace calot::window
