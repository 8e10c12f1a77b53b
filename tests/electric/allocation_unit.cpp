// Nothing is allocated inside a tick. (Not under AddressSanitizer, which wants its own operator new.)

#ifndef __SANITIZE_ADDRESS__

#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "calot/base/parallel.h"
#include "electric/rig.h"

namespace {
std::atomic<long> g_allocations{0};

void* counted(std::size_t bytes, std::size_t alignment) {
    ++g_allocations;
    void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
}  // namespace

void* operator new(std::size_t bytes) {
    return counted(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return counted(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

namespace calot::electric {

TEST(Allocation, NoneInATick) {
    const ThreadLimit limit(1);
    Rig rig = held_rig(1e-2);
    const long before = g_allocations;
    for (int k = 0; k < 16; ++k) {
        rig.state.hexel_present.clear(rig.model.hexels.index(10 + k, 22, 19));
        rig.solve();
        rig.input.pedal = k % 3 != 0;
        ++rig.state.tick;
    }
    EXPECT_EQ(g_allocations, before);
}

}  // namespace calot::electric

#endif
