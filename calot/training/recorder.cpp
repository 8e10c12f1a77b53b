#include "calot/training/recorder.h"

#include <chrono>

namespace calot::training {

namespace {

constexpr auto kNap = std::chrono::milliseconds(20);
constexpr auto kFlush = std::chrono::milliseconds(150);
constexpr auto kSync = std::chrono::milliseconds(1000);

}  // namespace

Recorder::Recorder(const std::string& folder, const std::string& program_version, const std::string& scene_text,
                   const tissue::State& initial, const Prefix& prefix)
    : ring_(kRing),
      recording_(folder + "/recording.calot", program_version, scene_text, initial),
      checkpoints_(folder + "/checkpoints.calot", initial) {
    slot_.state = initial;  // the memory for copies
    if (prefix.recording != nullptr) {
        recording_.adopt(*prefix.recording, prefix.ticks);
        checkpoints_.adopt(prefix.checkpoints, prefix.ticks);
    }
    thread_ = std::thread([this] { work(); });
}

Recorder::~Recorder() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
}

void Recorder::after_tick(const simulation::Simulation& run, const tissue::Input& input,
                          const std::function<Aside()>& aside) {
    const std::size_t put = put_.load(std::memory_order_relaxed);
    while (put - got_.load(std::memory_order_acquire) >= kRing) {
        if (failed_) return;
        std::this_thread::yield();
    }
    ring_[put % kRing] = input;
    put_.store(put + 1, std::memory_order_release);
    const std::int64_t tick = run.figures().tick;
    if (tick % kTicksPerCheckpoint != 0 || !can_be_stored(run.model(), tick)) return;
    if (slot_.full.load(std::memory_order_acquire)) return;  // the disk is slow: this one is left out
    slot_.state = run.state();
    slot_.aside = aside();
    slot_.inputs = put + 1;
    slot_.full.store(true, std::memory_order_release);
}

void Recorder::drain() {
    const std::size_t put = put_.load(std::memory_order_acquire);
    std::size_t got = got_.load(std::memory_order_relaxed);
    // After `put`: while the slot is not full, no input past the one that will fill it has been seen.
    const bool full = slot_.full.load(std::memory_order_acquire);
    // The slot's hashes belong right after the input that led to it.
    const std::size_t stop = full && slot_.inputs <= put ? slot_.inputs : put;
    for (; got < stop; ++got) recording_.add(ring_[got % kRing]);
    got_.store(got, std::memory_order_release);
    if (full && got == slot_.inputs) write_slot();
}

void Recorder::write_slot() {
    recording_.flush(slot_.state);
    checkpoints_.add(slot_.state, slot_.aside);
    slot_.full.store(false, std::memory_order_release);
}

void Recorder::work() {
    using Clock = std::chrono::steady_clock;
    auto flushed = Clock::now(), synced = flushed;
    try {
        for (;;) {
            const bool last = stopping_;
            drain();
            const auto now = Clock::now();
            if (last || now - flushed >= kFlush) {
                recording_.flush();
                flushed = now;
            }
            if (last || now - synced >= kSync) {
                recording_.sync();
                synced = now;
            }
            if (last && !slot_.full && got_ == put_) return;
            if (!last) std::this_thread::sleep_for(kNap);
        }
    } catch (...) {
        error_ = std::current_exception();
        failed_ = true;
    }
}

void Recorder::finish(const tissue::State& state) {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    if (error_) std::rethrow_exception(error_);
    recording_.flush(state);
    recording_.finish(state);
    recording_.sync();
}

std::string Recorder::trouble() const {
    if (!failed_) return "";
    try {
        std::rethrow_exception(error_);
    } catch (const std::exception& error) {
        return error.what();
    }
}

}  // namespace calot::training
