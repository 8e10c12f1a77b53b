#pragma once
// Hands the newest value from one thread to another. Neither ever waits: the writer always has a slot to write, the
// reader keeps what it reads for as long as it likes, values that nobody took in time are skipped.
//
//     writer: fill back(), publish()         reader: if (update()) look at front()

#include <array>
#include <atomic>
#include <cstdint>

namespace calot {

template <class T>
class TripleBuffer {
  public:
    /// For the writing thread: the slot to fill. It holds an older value, whose memory can be used again.
    T& back() { return slot_[back_]; }
    /// For the writing thread: back() becomes the newest value.
    void publish() { back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex; }

    /// For the reading thread: takes the newest value if there is one that it has not seen. True then.
    bool update() {
        if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
        front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
        return true;
    }
    /// For the reading thread: the value last taken.
    T& front() { return slot_[front_]; }
    const T& front() const { return slot_[front_]; }

    /// All slots, for whoever prepares them before both threads begin.
    std::array<T, 3>& slots() { return slot_; }

    /// The same by copy: from the writing thread ...
    void put(const T& value) {
        back() = value;
        publish();
    }
    /// ... and from the reading one: true, and the value, when there is one that was not taken yet.
    bool take(T& value) {
        if (!update()) return false;
        value = front();
        return true;
    }

    /// Whether a value waits that the reader has not taken; any thread.
    bool waiting() const { return (middle_.load(std::memory_order_relaxed) & kFresh) != 0; }

  private:
    static constexpr std::uint32_t kIndex = 3, kFresh = 4;
    // Cache lines of their own, so that one thread's stores do not slow the other's loads.
    std::array<T, 3> slot_{};
    alignas(64) std::uint32_t back_ = 0;                ///< the writer's
    alignas(64) std::uint32_t front_ = 1;               ///< the reader's
    alignas(64) std::atomic<std::uint32_t> middle_{2};  ///< between them; kFresh when the reader has not seen it
};

}  // namespace calot
