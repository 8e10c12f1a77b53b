#include "calot/window/trainer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/viewer/data_files.h"
#include "calot/viewer/language.h"
#include "calot/viewer/lens.h"
#include "calot/viewer/loader.h"
#include "calot/window/glfw_window.h"
#include "calot/window/gui.h"
#include "calot/window/hud.h"
#include "calot/window/open_page.h"
#include "calot/window/picture_thread.h"
#include "calot/window/screens.h"
#include "calot/window/settings.h"
#include "calot/window/sound.h"

namespace calot::window {

namespace {

using viewer::steady_s;

constexpr double kIdleFrame_s = 1.0 / 30.0;  ///< the window is drawn at least so often
constexpr double kTurn_s = 2e-3;             ///< the devices are read at least so often
constexpr double kFullSizzle_kg_per_s = 2.0e-5;

enum class Screen { start, loading, practice, paused, debrief, trouble };

class Trainer {
  public:
    explicit Trainer(const TrainerOptions& options);
    void run();

  private:
    void turn();
    void draw_window();
    void obey_commands();
    void load(int exercise);
    void finish_loading();
    void practise(double dt_s);
    void begin_practice();
    void end_session();
    void ask_for_picture();
    void draw_picture(int width, int height);
    void play_sound();
    void draw_screens();
    void draw_practice();
    void handle(PauseChoice choice);
    void handle(DebriefChoice choice);
    void apply_settings();
    void take_picture(int width, int height);
    bool has_pause() const { return screen_ == Screen::practice || screen_ == Screen::paused; }
    PictureFigures figures() const;

    TrainerOptions options_;
    std::string data_;
    std::string settings_path_;
    Settings settings_;
    viewer::Language text_;
    std::vector<std::string> languages_;
    GlfwWindow window_;
    Gui gui_;
    PictureThread pictures_;
    Sound sound_;

    Screen screen_ = Screen::start;
    bool help_ = false, settings_open_ = false, quit_ = false, settings_changed_ = false, picture_wanted_ = false;
    int exercise_ = 0, patient_ = 0, seed_ = 1, pictures_taken_ = 0;
    std::string trouble_;
    std::unique_ptr<viewer::Loader> loader_;
    double loading_since_s_ = 0.0;
    viewer::Loader::Step loading_step_ = viewer::Loader::Step::scene;
    std::shared_ptr<viewer::Attempt> attempt_;
    std::unique_ptr<viewer::Session> session_;
    std::optional<viewer::Mapping> mapping_;
    std::optional<viewer::Scope> scope_;
    viewer::LensState lens_;
    PictureWish wished_;
    viewer::Debrief debrief_;

    double now_s_ = steady_s(), last_s_ = now_s_, drawn_s_ = 0.0;
    viewer::RateMeter picture_rate_;
    double latency_s_ = 0.0;
    std::int64_t answered_ = 0;
    bool focused_ = true;
};

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
    if (settings_changed_) save_settings(settings_path_, settings_);
}

void Trainer::turn() {
    now_s_ = steady_s();
    const double dt_s = std::min(0.1, now_s_ - std::exchange(last_s_, now_s_));
    obey_commands();
    if (loader_ && loader_->finished()) finish_loading();
    if (has_pause()) practise(dt_s);
    play_sound();
    window_.capture_mouse(screen_ == Screen::practice && !help_);
    ask_for_picture();
    const bool fresh = pictures_.update();
    if (screen_ == Screen::loading && !loader_ && fresh) begin_practice();
    if (const std::string trouble = pictures_.take_trouble(); !trouble.empty()) {
        end_session();
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
    gui_.begin_frame(!window_.captured());
    draw_picture(width, height);
    draw_screens();
    gui_.end_frame();
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
    exercise_ = exercise;
    const viewer::Exercise& chosen = options_.exercises[static_cast<std::size_t>(exercise)];
    SceneWish wish;
    wish.scene = chosen.scene;
    wish.assignments = chosen.assignments;
    wish.any_patient = options_.patients && chosen.patients;
    if (wish.any_patient) {
        wish.seed = static_cast<std::uint64_t>(seed_);
        if (patient_ >= 0) {
            const viewer::Patient& patient = viewer::patients()[static_cast<std::size_t>(patient_)];
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
                                               });
    loading_since_s_ = now_s_;
    loading_step_ = viewer::Loader::Step::scene;
    screen_ = Screen::loading;
}

void Trainer::finish_loading() {
    try {
        session_ = loader_->take();
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
    scope_.emplace(session_->setup().camera);
    lens_ = {};
    answered_ = 0;
    if (options_.make_device) session_->hold(options_.make_device(session_->setup()));
    loading_step_ = viewer::Loader::Step::picture;
    loading_since_s_ = now_s_;
    // The first picture makes the shaders, which may take a while: the loading screen stays until it is there.
    pictures_.show(session_.get());
    pictures_.update();  // one of the session before
}

void Trainer::begin_practice() {
    session_->start();
    screen_ = Screen::practice;
}

void Trainer::practise(double dt_s) {
    viewer::Devices devices = window_.take_devices();
    devices.grasp_toggled = window_.take(Command::grasp);
    if (screen_ != Screen::practice || help_) devices = {};
    mapping_->apply(devices, dt_s, *scope_);
    viewer::Controls& controls = mapping_->controls();
    controls.cut_W = settings_.cut_W;
    controls.coag_W = settings_.coag_W;
    controls.blended_cut = settings_.blended_cut;
    controls.paused = screen_ == Screen::paused || help_;
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
        screen_ = Screen::debrief;
    }
    attempt_.reset();
    mapping_.reset();
    scope_.reset();
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
    if (!session_ || screen_ == Screen::loading || picture.texture == 0) return;
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture.texture)), ImVec2(0.0f, 0.0f),
        ImVec2(static_cast<float>(width), static_cast<float>(height)), ImVec2(0.0f, 1.0f), ImVec2(1.0f, 0.0f));
}

void Trainer::play_sound() {
    viewer::SoundScene scene;
    scene.volume = settings_.muted || screen_ != Screen::practice || help_ ? 0.0 : settings_.volume;
    const viewer::Figures& figures = pictures_.picture().figures;
    const bool active = screen_ == Screen::practice && figures.input.pedal;
    scene.coagulating = active && figures.input.mode == tissue::GeneratorMode::coag;
    scene.cutting = active && !scene.coagulating;
    scene.sizzle = std::sqrt(std::max(0.0, figures.boiling_kg_per_s / kFullSizzle_kg_per_s));
    scene.suction = figures.fluids.suction;
    scene.irrigation = figures.fluids.irrigation;
    sound_.set(scene);
}

void Trainer::draw_screens() {
    if (help_ && screen_ != Screen::loading) {
        draw_help(gui_, text_);
        return;
    }
    bool changed = false;
    switch (screen_) {
        case Screen::start: {
            if (settings_open_) break;
            const StartChoice choice = draw_start(gui_, text_, options_.exercises, patient_, seed_, options_.patients);
            if (choice.quit) quit_ = true;
            if (choice.settings) settings_open_ = true;
            if (choice.exercise >= 0) load(choice.exercise);
            break;
        }
        case Screen::loading:
            if (loader_ && loader_->step() != loading_step_) {
                loading_step_ = loader_->step();
                loading_since_s_ = now_s_;
            }
            draw_loading(gui_, text_, loading_step_, now_s_ - loading_since_s_);
            break;
        case Screen::practice:
            draw_practice();
            break;
        case Screen::paused:
            draw_practice();
            if (!settings_open_ && !help_) handle(draw_pause(gui_, text_));
            break;
        case Screen::debrief:
            handle(draw_debrief(gui_, text_, debrief_));
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

PictureFigures Trainer::figures() const {
    PictureFigures figures;
    figures.pictures_per_s = picture_rate_.per_s();
    figures.draw_ms = 1e3 * pictures_.picture().draw_s;
    figures.latency_ms = 1e3 * latency_s_;
    figures.tier = text_("tier." + std::to_string(pictures_.picture().tier));
    figures.scheduling = session_->scheduling();
    return figures;
}

void Trainer::draw_practice() {
    std::vector<viewer::HudLine> lines;
    if (attempt_) lines = attempt_->hud();
    const viewer::Controls& controls = mapping_->controls();
    draw_hud(gui_, text_,
             {pictures_.picture().figures, figures(), settings_,
              options_.exercises[static_cast<std::size_t>(exercise_)].name, lines, mapping_->left_active(),
              controls.suction, controls.irrigation});
}

void Trainer::handle(PauseChoice choice) {
    switch (choice) {
        case PauseChoice::none:
            break;
        case PauseChoice::resume:
            screen_ = Screen::practice;
            break;
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
    if (choice == DebriefChoice::report) open_page(debrief_.report);
}

void Trainer::take_picture(int width, int height) {
    const std::string file = fmt::format("{}/calot-{:03d}.png", options_.pictures, ++pictures_taken_);
    render::write_png(file, read_window(width, height));
}

}  // namespace

void run_trainer(const TrainerOptions& options) {
    Trainer(options).run();
}

}  // namespace calot::window
