#include "calot/haptics/session.h"

#include <chrono>
#include <cmath>

namespace calot::haptics {

namespace {

bool pressed(const DeviceSample& sample, int button) {
    return button >= 0 && button < 32 && (sample.buttons >> button & 1u) != 0;
}

}  // namespace

Session::Session(std::unique_ptr<HapticDevice> device, const SessionOptions& options)
    : device_(std::move(device)),
      options_(options),
      servo_(*device_, options.servo),
      coupling_(options.coupling, options.mapping, options.hook) {
    shared_.device = device_->info();
}

Session::~Session() {
    stop();
}

void Session::start() {
    if (!options_.threads || keeper_.joinable()) return;
    stop_ = false;
    keeper_ = std::thread([this] { keep_going(); });
}

void Session::stop() {
    if (keeper_.joinable()) {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            stop_ = true;
        }
        wake_.notify_all();
        keeper_.join();
    }
    stop_servo();
    if (open_) device_->close();
    open_ = false;
    const std::lock_guard<std::mutex> lock(mutex_);
    shared_.open = false;
}

bool Session::drive(tissue::Input& input) {
    servo_.take_hand(hand_);
    if (!hand_.present || !finite_) {
        coupling_.place(input.hook);
        ToolMessage message;
        message.finite = finite_;
        servo_.put_tool(message);
        return false;
    }
    if (!coupling_.anchored()) coupling_.place(input.hook);
    const bool clutch = pressed(hand_.sample, options_.clutch_button);
    input.hook = coupling_.advance(hand_, clutch, tissue_force_N_, options_.tick_s);
    if (pressed(hand_.sample, options_.pedal_button)) input.pedal = true;
    servo_.put_tool(coupling_.message(hand_));
    return true;
}

void Session::feel(const tissue::State& state) {
    tissue_force_N_ = state.hook_force_N;
    const double sum = tissue_force_N_.x + tissue_force_N_.y + tissue_force_N_.z;
    finite_ = state.status.ok && std::isfinite(sum);
    if (finite_) return;
    tissue_force_N_ = Vec3(0.0);
    ToolMessage message;
    message.finite = false;
    servo_.put_tool(message);
}

void Session::rest() {
    servo_.take_hand(hand_);
    coupling_.let_go();
    tissue_force_N_ = Vec3(0.0);
    servo_.put_tool({});
}

SessionStatus Session::status() {
    const std::lock_guard<std::mutex> lock(mutex_);
    servo_.take_state(shared_.servo);
    shared_.note = open_note_.empty() ? policy_note_ : open_note_;
    return shared_;
}

void Session::keep() {
    if (open_ && servo_.lost()) {
        stop_servo();
        device_->close();
        open_ = false;
        servo_.restart();
    }
    if (open_) return;
    const std::string trouble = device_->open();
    open_ = trouble.empty();
    if (open_) servo_.restart();
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        shared_.open = open_;
        open_note_ = trouble;
        if (open_) {
            shared_.device = device_->info();
            ++shared_.connections;
        }
    }
    if (open_) start_servo();
}

void Session::keep_going() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!stop_) {
        lock.unlock();
        keep();
        lock.lock();
        // An open device is looked at often, so that one that was unplugged is let go at once.
        const auto wait = std::chrono::duration<double>(open_ ? 0.02 : options_.retry_s);
        wake_.wait_for(lock, wait, [this] { return stop_; });
    }
}

void Session::start_servo() {
    if (!options_.threads) return;
    device_clock_ =
        device_->start_clock([](void* self) { static_cast<Session*>(self)->servo_.step(monotonic_s()); }, this);
    if (device_clock_) return;
    servo_thread_.start(
        options_.servo_period_s, options_.priority, [this](double now_s) { servo_.step(now_s); },
        [this](const std::string& note) {
            const std::lock_guard<std::mutex> lock(mutex_);
            policy_note_ = note;
        });
}

void Session::stop_servo() {
    if (device_clock_) device_->stop_clock();
    device_clock_ = false;
    servo_thread_.stop();
}

}  // namespace calot::haptics
