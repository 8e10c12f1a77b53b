#pragma once
// A thread that calls a function a thousand times a second, on time: absolute deadlines (clock_nanosleep), so that
// periods do not add up their errors, and the real-time policy where the system permits it. It sleeps between calls and
// never spins: a spinner on a real-time policy starves whatever shares its core.

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace calot::haptics {

/// Seconds on the clock that deadlines and devices are timed by (CLOCK_MONOTONIC).
double monotonic_s();

/// Gives the calling thread the real-time policy (SCHED_FIFO). Returns an empty text, or why not and what to do.
std::string ask_for_real_time(int priority);

class PeriodicThread {
  public:
    PeriodicThread() = default;
    ~PeriodicThread() { stop(); }
    PeriodicThread(const PeriodicThread&) = delete;
    PeriodicThread& operator=(const PeriodicThread&) = delete;

    /// Calls `work(monotonic_s())` every `period_s` until stop(). Periods that were missed are not made up for.
    /// `priority` 0: no real-time policy. `granted(note)` is called once from the thread, with ask_for_real_time's
    /// answer.
    void start(double period_s, int priority, std::function<void(double)> work,
               std::function<void(const std::string&)> granted = {});
    /// Ends the thread after the present call. Not from the thread itself.
    void stop();
    bool running() const { return thread_.joinable(); }

  private:
    std::thread thread_;
    std::atomic<bool> stop_{false};
};

}  // namespace calot::haptics
