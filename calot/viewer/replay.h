#pragma once
// A stored run, looked at again: any moment of it, from checkpoints and inputs, in a thread of its own.
//
// Whoever drags a timeline wants a picture at once and the very moment soon after. So the nearest checkpoint before the
// wish is shown first, and the run goes on from there to the wish: a second of ticks at most. A wish ahead of where the
// run is, with no checkpoint in between, just lets it go on: playing is wishing ever further.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "calot/base/triple_buffer.h"
#include "calot/simulation/simulation.h"
#include "calot/viewer/snapshot.h"

namespace calot::viewer {

/// A span of the run with the pedal down.
struct PedalSpan {
    double from_s = 0.0, to_s = 0.0;
    bool coag = false;
};

class Replay {
  public:
    /// Opens the recording in its thread. `setup`: of its scene if there is one already; null: built anew.
    explicit Replay(const std::string& recording, std::shared_ptr<const simulation::Setup> setup = nullptr);
    ~Replay();
    Replay(const Replay&) = delete;
    Replay& operator=(const Replay&) = delete;

    /// Whether what follows can be asked; until then the run is being opened.
    bool ready() const { return ready_; }
    /// What went wrong, for people; empty: nothing. Then ready() stays as it was.
    std::string trouble() const;

    std::int64_t ticks() const { return ticks_; }
    const std::vector<PedalSpan>& pedal() const { return pedal_; }
    std::shared_ptr<const simulation::Setup> setup() const { return setup_; }
    /// Its checkpoints are of an older version: going back means running from the start.
    bool older() const { return older_; }
    /// The state after this many ticks is wished for, 1 to ticks(). Never waits.
    void wish(std::int64_t tick) { wish_ = tick; }
    /// Ticks of the newest snapshot.
    std::int64_t shown() const { return shown_; }

    TripleBuffer<Snapshot>& snapshots() { return snapshots_; }

  private:
    void work(const std::string& recording);

    std::shared_ptr<const simulation::Setup> setup_;
    std::int64_t ticks_ = 0;
    std::vector<PedalSpan> pedal_;
    bool older_ = false;
    TripleBuffer<Snapshot> snapshots_;
    std::atomic<std::int64_t> wish_{1}, shown_{0};
    std::atomic<bool> ready_{false}, closing_{false};
    mutable std::mutex mutex_;  ///< of trouble_
    std::string trouble_;
    std::thread thread_;
};

}  // namespace calot::viewer
