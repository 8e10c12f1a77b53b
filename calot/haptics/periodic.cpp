#include "calot/haptics/periodic.h"

#include <cerrno>
#include <cstring>
#include <ctime>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

namespace calot::haptics {

double monotonic_s() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string ask_for_real_time(int priority) {
    sched_param parameters{};
    parameters.sched_priority = priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    if (error == 0) return "";
    return fmt::format(
        "no real-time policy ({}): expect late steps on a busy machine; allow it with `ulimit -r {}` or "
        "rtprio in /etc/security/limits.conf",
        std::strerror(error), priority);
}

void PeriodicThread::start(double period_s, int priority, std::function<void(double)> work,
                           std::function<void(const std::string&)> granted) {
    stop();
    stop_.store(false);
    thread_ = std::thread([this, period_s, priority, work = std::move(work), granted = std::move(granted)] {
        prctl(PR_SET_TIMERSLACK, 1);  // otherwise sleeps end up to 50 us late
        const std::string note = priority > 0 ? ask_for_real_time(priority) : "";
        if (granted) granted(note);
        const auto period_ns = static_cast<long long>(period_s * 1e9);
        timespec now{};
        clock_gettime(CLOCK_MONOTONIC, &now);
        long long due_ns = now.tv_sec * 1'000'000'000LL + now.tv_nsec;
        while (!stop_.load(std::memory_order_relaxed)) {
            work(monotonic_s());
            due_ns += period_ns;
            clock_gettime(CLOCK_MONOTONIC, &now);
            const long long now_ns = now.tv_sec * 1'000'000'000LL + now.tv_nsec;
            if (now_ns >= due_ns) {
                due_ns = now_ns;  // late: go on from here
                continue;
            }
            timespec due{};
            due.tv_sec = static_cast<time_t>(due_ns / 1'000'000'000LL);
            due.tv_nsec = static_cast<long>(due_ns % 1'000'000'000LL);
            while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
            }
        }
    });
}

void PeriodicThread::stop() {
    if (!thread_.joinable()) return;
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
}

}  // namespace calot::haptics
