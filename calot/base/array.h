#pragma once
// Arrays of the simulation: 64-byte aligned, sized once at set-up, never grown inside a step.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace calot {

/// Allocates on 64-byte boundaries (a cache line, the widest vector). Large arrays begin at different places within
/// pages: a kernel reads some forty arrays at the same index, and caches have few places for lines that lie alike. They
/// share large pages where the system has these.
void* allocate_apart(std::size_t bytes);
void free_apart(void* p);
/// How many large ones (from 16 KiB) this program has allocated so far. They do not come from operator new.
std::size_t large_arrays_allocated();
/// Bytes of those that are not in the heap and live.
std::size_t large_array_bytes();

template <class T>
struct AlignedAllocator {
    using value_type = T;
    AlignedAllocator() = default;
    template <class U>
    AlignedAllocator(const AlignedAllocator<U>&) {}
    T* allocate(std::size_t n) { return static_cast<T*>(allocate_apart(n * sizeof(T))); }
    void deallocate(T* p, std::size_t) { free_apart(p); }
    template <class U>
    bool operator==(const AlignedAllocator<U>&) const {
        return true;
    }
};

template <class T>
using Array = std::vector<T, AlignedAllocator<T>>;

/// resize() that leaves room for a quarter more when it has to allocate, for what grows by little and little.
template <class Vector>
void resize_with_room(Vector& values, std::size_t size) {
    if (values.capacity() < size) values.reserve(size + size / 4);
    values.resize(size);
}

/// A bit per cell. The words are padded by one, so that `bits` may read past the last cell.
class BitArray {
  public:
    BitArray() = default;
    explicit BitArray(std::int64_t size) : size_(size), words_(static_cast<std::size_t>(size / 64 + 2), 0) {}

    std::int64_t size() const { return size_; }
    bool test(std::int64_t i) const { return (words_[static_cast<std::size_t>(i >> 6)] >> (i & 63)) & 1u; }
    void set(std::int64_t i) { words_[static_cast<std::size_t>(i >> 6)] |= std::uint64_t{1} << (i & 63); }
    void clear(std::int64_t i) { words_[static_cast<std::size_t>(i >> 6)] &= ~(std::uint64_t{1} << (i & 63)); }
    void assign(std::int64_t i, bool value) { value ? set(i) : clear(i); }

    /// The 32 bits from cell i on, cell i in bit 0. i + 32 may exceed size() by up to 64; those bits are 0.
    std::uint32_t bits32(std::int64_t i) const {
        std::uint64_t word;
        std::memcpy(&word, bytes() + (i >> 3), sizeof(word));
        return static_cast<std::uint32_t>(word >> (i & 7));
    }
    std::int64_t count() const {
        std::int64_t total = 0;
        for (std::uint64_t w : words_) total += __builtin_popcountll(w);
        return total;
    }
    const std::uint8_t* bytes() const { return reinterpret_cast<const std::uint8_t*>(words_.data()); }
    const Array<std::uint64_t>& words() const { return words_; }
    Array<std::uint64_t>& words() { return words_; }

  private:
    std::int64_t size_ = 0;
    Array<std::uint64_t> words_;
};

}  // namespace calot
