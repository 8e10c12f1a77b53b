#pragma once
// The latest value from one thread to another, without locks: three slots, of which the writer owns one, the reader
// one, and the third changes hands in one atomic exchange. Neither ever waits; values that nobody took are overwritten.
//
//     writer: fill `back`, swap it with `middle`         reader: if `middle` is new, swap it with `front`, read `front`

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace calot::haptics {

template <class T>
class Mailbox {
    static_assert(std::is_trivially_copyable_v<T>, "values are copied bytewise");

  public:
    /// From the one writing thread.
    void put(const T& value) {
        slots_[back_] = value;
        back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kNew), std::memory_order_acq_rel) & kSlot;
    }
    /// From the one reading thread: true, and the value, when there is one that was not taken yet.
    bool take(T& value) {
        if ((middle_.load(std::memory_order_relaxed) & kNew) == 0) return false;
        front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kSlot;
        value = slots_[front_];
        return true;
    }

  private:
    static constexpr std::uint8_t kNew = 4, kSlot = 3;
    std::array<T, 3> slots_{};
    alignas(64) std::atomic<std::uint8_t> middle_{1};
    alignas(64) std::uint8_t back_ = 0;
    alignas(64) std::uint8_t front_ = 2;
};

}  // namespace calot::haptics
