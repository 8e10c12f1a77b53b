#include "calot/base/array.h"

#include <atomic>
#include <new>

namespace calot {

namespace {

constexpr std::size_t kLine = 64, kLinesOfPage = 64;
constexpr std::size_t kLarge = 16384;
std::atomic<std::size_t> large_arrays{0};

}  // namespace

// A line before the array holds where the block began.
void* allocate_apart(std::size_t bytes) {
    // Steps of 11 lines visit every line of a page before any comes again.
    const std::size_t lines = bytes < kLarge ? 0 : 11 * large_arrays.fetch_add(1) % kLinesOfPage;
    auto* block = static_cast<char*>(::operator new(bytes + kLine * (1 + lines), std::align_val_t{kLine}));
    char* array = block + kLine * (1 + lines);
    std::memcpy(array - sizeof(block), &block, sizeof(block));
    return array;
}

void free_apart(void* p) {
    if (p == nullptr) return;
    char* block;
    std::memcpy(&block, static_cast<char*>(p) - sizeof(block), sizeof(block));
    ::operator delete(block, std::align_val_t{kLine});
}

}  // namespace calot
