#pragma once
// A session without its clock and its thread: hands and physics tick by tick, snapshots on demand.

#include <memory>
#include <vector>

#include "calot/haptics/session.h"
#include "calot/simulation/simulation.h"
#include "calot/viewer/controls.h"
#include "calot/viewer/hand.h"
#include "calot/viewer/observer.h"
#include "calot/viewer/picture.h"
#include "calot/viewer/snapshot.h"

namespace calot::viewer {

/// Where the hands' ports are and how far they reach, for a scene.
struct Theatre {
    Reach right, left;
    HandTarget right_start, left_start;
};
Theatre theatre_of(const simulation::Setup& setup);

/// The same with both hands where a run has them: it goes on from there.
Theatre theatre_of(const simulation::Simulation& run);

/// What does not come from the hands: picture (to be placed), generator, forces, blood.
void fill_snapshot(const simulation::Simulation& run, const tissue::Input& input, Picture& picture, Snapshot& snapshot);
/// The same, but for what tissue looks like: Picture::go_on.
void begin_snapshot(const simulation::Simulation& run, const tissue::Input& input, Picture& picture,
                    Snapshot& snapshot);

/// Fills the snapshot and turns controls into inputs, tick by tick; no clock, no thread. What the thread of a Session
/// runs, and what tests drive.
class SessionCore {
  public:
    SessionCore(std::unique_ptr<simulation::Simulation> run, std::vector<std::shared_ptr<Observer>> observers);
    ~SessionCore() { end(); }
    SessionCore(const SessionCore&) = delete;
    SessionCore& operator=(const SessionCore&) = delete;

    /// From now on a haptic device has the hook whenever a hand is on it; the controls have it otherwise.
    void hold(std::shared_ptr<haptics::Session> device) { device_ = std::move(device); }
    /// Instead of ticks while the session pauses.
    void rest() {
        if (device_) device_->rest();
    }

    /// One tick of hands and physics. False once the simulation's status is not ok.
    bool tick(const Controls& controls);
    void fill(Snapshot& snapshot);  ///< to be placed
    /// The same, a few vertices after every tick. True when it is full.
    void begin(Snapshot& snapshot);
    bool go_on(Snapshot& snapshot, std::size_t vertices) {
        return picture_.go_on(*run_, vertices, snapshot.moment, snapshot.view);
    }
    /// Tells the observers that this was all, once.
    void end();

    const simulation::Simulation& run() const { return *run_; }
    const Theatre& theatre() const { return theatre_; }

  private:
    tissue::Input input_for(const Controls& controls);
    void follow_device(const Controls& controls);

    std::unique_ptr<simulation::Simulation> run_;
    std::vector<std::shared_ptr<Observer>> observers_;
    Theatre theatre_;
    HeldInstrument right_, left_;
    double jaw_;  ///< of the grasper, 0 closed ... 1 wide open
    std::shared_ptr<haptics::Session> device_;
    Picture picture_;
    tissue::Input input_;
    double boiling_kg_per_s_ = 0.0;
    bool ended_ = false;
};

}  // namespace calot::viewer
