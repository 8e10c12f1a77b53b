#include "calot/viewer/session.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

namespace calot::viewer {

namespace {

using Clock = std::chrono::steady_clock;

/// The session sleeps while it is paused, and wakes so often to look whether it still is.
constexpr double kPausedInterval_s = 4e-3;
/// Of the thread's time that pictures may take: where they are dear, there are fewer of them.
constexpr double kPictureShare = 0.15, kLongestRest_s = 0.05;
/// Some 0.25 ms: a picture of the standard scene is full after a dozen ticks.
constexpr std::size_t kVerticesATick = 2560, kAllVertices = static_cast<std::size_t>(-1) / 2;
constexpr int kRealTimePriority = 10;
constexpr double kTickMean = 0.02;  ///< share of the newest tick in the mean

void sleep_until(double time_s) {
    std::this_thread::sleep_until(
        Clock::time_point(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s))));
}

/// 1, or minus the errno that says why not.
int ask_for_real_time() {
    sched_param parameters{};
    parameters.sched_priority = kRealTimePriority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    return error == 0 ? 1 : -error;
}

}  // namespace

double steady_s() {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

Session::Session(std::unique_ptr<simulation::Simulation> run, SessionOptions options)
    : options_(std::move(options)), core_(std::move(run), options_.observers), clock_(core_.run().model().tick_s) {
    Controls& first = controls_.back();
    first.right = core_.theatre().right_start;
    first.left = core_.theatre().left_start;
    controls_.publish();
    // Something to draw from the first moment on, and memory for what comes.
    for (Snapshot& snapshot : snapshots_.slots()) core_.fill(snapshot);
    snapshots_.publish();
}

Session::~Session() {
    stop();
}

void Session::hold(std::shared_ptr<haptics::Session> device) {
    device_ = std::move(device);
    core_.hold(device_);
}

void Session::start() {
    if (device_) device_->start();
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
}

void Session::stop() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    if (device_) device_->stop();
    core_.end();
}

void Session::set(const Controls& controls) {
    controls_.back() = controls;
    controls_.publish();
}

std::string Session::why_not_real_time() const {
    const int code = scheduling_;
    return code < 0 ? std::strerror(-code) : "";
}

void Session::book(double begun_s, double ended_s) {
    const double tick_us = 1e6 * (ended_s - begun_s);
    pace_.tick_us += kTickMean * (tick_us - pace_.tick_us);
    longest_us_ = std::max(longest_us_, tick_us);
    if (ended_s - longest_since_s_ > 1.0) {
        pace_.longest_us = longest_us_;
        longest_us_ = 0.0;
        longest_since_s_ = ended_s;
    }
    rate_.add(ended_s);
    pace_.ticks_per_s = rate_.per_s();
    pace_.late_ticks = clock_.late_ticks();
    pace_.lost_s = clock_.lost_s();
}

void Session::begin_picture(const Controls& controls) {
    Snapshot& snapshot = snapshots_.back();
    core_.begin(snapshot);
    snapshot.sequence = controls.sequence;
    snapshot.sampled_s = controls.sampled_s;
    snapshot.paused = controls.paused;
}

void Session::publish() {
    snapshots_.back().pace = pace_;
    snapshots_.publish();
}

void Session::work() {
    if (options_.real_time) scheduling_ = ask_for_real_time();
    bool paused = true;
    double picture_due_s = 0.0;
    bool filling = false;   // a picture is begun and not yet full
    double spent_us = 0.0;  // on it
    while (!stopping_) {
        controls_.update();
        const Controls& controls = controls_.front();
        double now_s = steady_s();
        if (controls.paused || !core_.run().figures().status.ok) {
            paused = true;
            core_.rest();
            if (now_s >= picture_due_s) {
                begin_picture(controls);
                core_.go_on(snapshots_.back(), kAllVertices);
                filling = false;
                publish();
                picture_due_s = now_s + 0.1;
            }
            sleep_until(now_s + kPausedInterval_s);
            continue;
        }
        if (std::exchange(paused, false)) {
            clock_.start(now_s);
            rate_.restart();
        }
        if (now_s < clock_.next_due_s()) {
            sleep_until(clock_.next_due_s());
            now_s = steady_s();
        }
        clock_.begin_tick(now_s);
        core_.tick(controls);
        const double begun_s = now_s;
        now_s = steady_s();
        book(begun_s, now_s);
        // A picture is made when the last one has been taken, so that a slow window costs the physics nothing; and a
        // few vertices after each tick, so that no tick waits for a whole one.
        if (filling) {
            filling = !core_.go_on(snapshots_.back(), kVerticesATick);
            if (!filling) {
                const double ended_s = steady_s();
                pace_.picture_us = std::exchange(spent_us, 0.0) + 1e6 * (ended_s - now_s);
                const double rest_s = std::min(kLongestRest_s, 1e-6 * pace_.picture_us / kPictureShare);
                picture_due_s = std::max(picture_due_s, ended_s + rest_s);
                publish();
            }
        } else if (now_s >= picture_due_s && !snapshots_.waiting()) {
            begin_picture(controls);
            filling = true;
            picture_due_s = now_s + options_.picture_interval_s;
        } else {
            continue;
        }
        spent_us += 1e6 * (steady_s() - now_s);
    }
}

}  // namespace calot::viewer
