#pragma once
// A running session: physics at a thousand ticks a second in a thread of its own, hands in, snapshots out. It knows no
// window and waits for nobody: the window draws what it finds.
//
//     viewer::Session session(std::make_unique<simulation::Simulation>(setup), {.observers = {score}});
//     session.start();
//     ... session.set(controls); if (session.update()) draw(session.snapshot());
//     session.stop();

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "calot/base/triple_buffer.h"
#include "calot/viewer/session_core.h"
#include "calot/viewer/tick_clock.h"

namespace calot::viewer {

struct SessionOptions {
    std::vector<std::shared_ptr<Observer>> observers;
    double picture_interval_s = 1.0 / 60.0;  ///< snapshots are not made more often
    bool real_time = true;                   ///< ask for SCHED_FIFO
};

class Session {
  public:
    explicit Session(std::unique_ptr<simulation::Simulation> run, SessionOptions options = {});
    ~Session();

    /// Before start(): a haptic device for the right hand. The session starts and stops it.
    void hold(std::shared_ptr<haptics::Session> device);
    void start();
    /// Ends the thread after its tick and tells the observers. Nothing runs afterwards.
    void stop();

    /// For the window's thread: the newest wishes. Never waits.
    void set(const Controls& controls);
    /// For the window's thread: takes the newest snapshot if there is one that it has not seen. Never waits.
    bool update() { return snapshots_.update(); }
    const Snapshot& snapshot() const { return snapshots_.front(); }
    /// The same for one who draws whatever comes.
    TripleBuffer<Snapshot>& snapshots() { return snapshots_; }

    const simulation::Setup& setup() const { return core_.run().setup(); }
    const Theatre& theatre() const { return core_.theatre(); }
    /// Whether the thread got real-time priority (SCHED_FIFO); if it did not, why, for people.
    bool real_time() const { return scheduling_ == 1; }
    std::string why_not_real_time() const;

  private:
    void work();
    void book(double begun_s, double ended_s);
    void begin_picture(const Controls& controls);
    void publish();

    SessionOptions options_;
    SessionCore core_;
    std::shared_ptr<haptics::Session> device_;
    TripleBuffer<Controls> controls_;
    TripleBuffer<Snapshot> snapshots_;
    TickClock clock_;
    RateMeter rate_;
    Pace pace_;
    double longest_us_ = 0.0, longest_since_s_ = 0.0;
    std::atomic<bool> stopping_{false};
    std::atomic<int> scheduling_{0};  ///< 0 unknown, 1 real-time, else an errno, negative
    std::thread thread_;
};

/// Seconds of the steady clock.
double steady_s();

}  // namespace calot::viewer
