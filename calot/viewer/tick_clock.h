#pragma once
// Simulated against wall time: which tick is due when, and what is done when ticks come late. It reads no clock itself.
//
// Ticks are due one interval apart. A late one is made up for at once, up to kMostLag_s; beyond that the schedule moves
// back, so that simulated time runs slower than the wall's, visibly, instead of ever more ticks piling up.

#include <cstdint>

namespace calot::viewer {

class TickClock {
  public:
    static constexpr double kMostLag_s = 8e-3;

    explicit TickClock(double tick_s = 1e-3) : tick_s_(tick_s) {}

    /// The next tick is due at `now_s`. Also after a pause: what passed meanwhile is not made up for.
    void start(double now_s) { next_due_s_ = now_s; }

    /// When the next tick is due.
    double next_due_s() const { return next_due_s_; }

    /// Books the next tick as begun at `now_s`, and moves the schedule back when it came too late.
    void begin_tick(double now_s);

    std::int64_t ticks() const { return ticks_; }
    /// Ticks that began more than one interval after they were due.
    std::int64_t late_ticks() const { return late_ticks_; }
    /// Wall time that simulated time has fallen behind for good.
    double lost_s() const { return lost_s_; }

  private:
    double tick_s_;
    double next_due_s_ = 0.0;
    double lost_s_ = 0.0;
    std::int64_t ticks_ = 0;
    std::int64_t late_ticks_ = 0;
};

/// Events a second over the last second or so.
class RateMeter {
  public:
    /// One event, or `count` of them, at `now_s` (not before the last).
    void add(double now_s, std::int64_t count = 1);
    double per_s() const { return per_s_; }
    /// The next event begins a new second: what lies between was a pause.
    void restart() { since_s_ = -1.0, count_ = 0; }

  private:
    static constexpr double kSpan_s = 0.5;
    double since_s_ = -1.0;
    std::int64_t count_ = 0;
    double per_s_ = 0.0;
};

}  // namespace calot::viewer
