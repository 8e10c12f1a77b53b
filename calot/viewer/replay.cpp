#include "calot/viewer/replay.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>

#include "calot/base/error.h"
#include "calot/scene/scene.h"
#include "calot/simulation/recording.h"
#include "calot/training/checkpoints.h"
#include "calot/viewer/session_core.h"

namespace calot::viewer {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kNap = std::chrono::milliseconds(4);
constexpr auto kPictureInterval = std::chrono::milliseconds(33);

/// The run behind a replay: goes to any tick by the shortest way.
class Tape {
  public:
    Tape(const std::string& path, simulation::Recording recording, std::shared_ptr<const simulation::Setup> setup)
        : recording_(std::move(recording)),
          setup_(std::move(setup)),
          checkpoints_((std::filesystem::path(path).parent_path() / "checkpoints.calot").string()),
          run_(std::make_unique<simulation::Simulation>(setup_)),
          initial_(run_->state()),
          picture_(*setup_) {}

    std::int64_t ticks() const { return static_cast<std::int64_t>(recording_.inputs.size()); }
    std::int64_t tick() const { return run_->figures().tick; }

    /// A step of the way to `wish` (1 to ticks()): up to a checkpoint, or on by a frame. False when the run is there.
    bool approach(std::int64_t wish) {
        if (tick() == wish) return false;
        // Instruments are placed by ticks: a state that was read needs one more to be seen.
        const std::int64_t checkpoint = std::max<std::int64_t>(0, checkpoints_.last_before(wish - 1));
        if (tick() > wish || checkpoint > tick()) {
            take(checkpoint);
            advance();
            return true;
        }
        for (std::int64_t k = 0; k < setup_->model.frame_ticks && tick() < wish; ++k)
            if (!advance()) return false;
        return true;
    }
    void fill(Snapshot& snapshot) { fill_snapshot(*run_, last_input(), picture_, snapshot); }

    std::vector<PedalSpan> pedal() const {
        std::vector<PedalSpan> spans;
        const double tick_s = setup_->model.tick_s;
        bool down = false;
        for (std::size_t k = 0; k < recording_.inputs.size(); ++k) {
            const tissue::Input& input = recording_.inputs[k];
            const bool coag = input.mode == tissue::GeneratorMode::coag;
            if (input.pedal && (!down || spans.back().coag != coag))
                spans.push_back({static_cast<double>(k) * tick_s, 0.0, coag});
            if (input.pedal) spans.back().to_s = static_cast<double>(k + 1) * tick_s;
            down = input.pedal;
        }
        return spans;
    }

  private:
    const tissue::Input& last_input() const {
        return recording_.inputs[static_cast<std::size_t>(std::max<std::int64_t>(0, tick() - 1))];
    }
    bool advance() {
        return tick() < ticks() && run_->tick(recording_.inputs[static_cast<std::size_t>(tick())]);
    }
    void take(std::int64_t checkpoint) {
        tissue::State state = initial_;
        training::Aside aside;
        if (checkpoint > 0) checkpoints_.read(checkpoint, state, aside);
        run_.reset();  // first, so that both do not need memory at once
        run_ = std::make_unique<simulation::Simulation>(setup_, std::move(state));
        if (aside.effects.empty()) return;
        Archive effects(std::move(aside.effects));
        run_->archive_effects(effects);
    }

    simulation::Recording recording_;
    std::shared_ptr<const simulation::Setup> setup_;
    training::CheckpointReader checkpoints_;
    std::unique_ptr<simulation::Simulation> run_;
    tissue::State initial_;
    Picture picture_;
};

}  // namespace

Replay::Replay(const std::string& recording, std::shared_ptr<const simulation::Setup> setup)
    : setup_(std::move(setup)), thread_([this, recording] { work(recording); }) {}

Replay::~Replay() {
    closing_ = true;
    thread_.join();
}

std::string Replay::trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
}

void Replay::work(const std::string& recording) {
    std::string trouble;
    try {
        simulation::Recording read = simulation::read_recording(recording);
        if (read.inputs.empty())
            throw InputError(recording, 0, 0, "the recording holds no inputs", "it was cut off within its first second");
        if (!setup_)
            setup_ = std::make_shared<const simulation::Setup>(
                scene::build(scene::parse(read.scene_text, recording + " (its scene)", ".")));
        Tape tape(recording, std::move(read), setup_);
        ticks_ = tape.ticks();
        pedal_ = tape.pedal();
        ready_ = true;
        auto published = Clock::now() - kPictureInterval;
        while (!closing_) {
            const std::int64_t before = tape.tick();
            const bool moved = tape.approach(std::clamp<std::int64_t>(wish_, 1, ticks_));
            // Where it jumped to, and where it arrived, at once; on the way now and then.
            const bool jumped = tape.tick() < before || tape.tick() > before + setup_->model.frame_ticks;
            const auto now = Clock::now();
            const bool due = jumped || now - published >= kPictureInterval;
            if (shown_ != tape.tick() && !snapshots_.waiting() && (due || !moved)) {
                tape.fill(snapshots_.back());
                snapshots_.publish();
                shown_ = tape.tick();
                published = now;
            }
            if (!moved) std::this_thread::sleep_for(kNap);
        }
        return;
    } catch (const InputError& error) {
        trouble = error.describe();
    } catch (const std::exception& error) {
        trouble = error.what();
    }
    const std::lock_guard lock(mutex_);
    trouble_ = trouble;
}

}  // namespace calot::viewer
