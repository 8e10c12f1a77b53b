// A heat step allocates nothing. Operators new of this test program count; sanitizers keep their own.

#include <atomic>
#include <cstdlib>
#include <new>

#include "calot/base/parallel.h"
#include "thermal/burn_bodies.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
std::atomic<long> allocations{0};

void* allocate(std::size_t bytes, std::size_t alignment) {
    ++allocations;
    if (void* p = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)) return p;
    throw std::bad_alloc();
}
}  // namespace

// Not inlined: the compiler would see free() meet what it takes for another operator new.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
    return allocate(bytes, 16);
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return allocate(bytes, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    std::free(p);
}

namespace calot::thermal {

TEST(HeatAllocations, StepsDoNotAllocate) {
    const ThreadLimit limit(1);
    HeatRun run(burn_model());
    while (run.state.tick < 800) {
        if (run.state.tick % 8 == 0) heat_spot(run, run.state.tick);
        const long before = allocations;
        run.tick();
        ASSERT_EQ(allocations - before, 0) << "tick " << run.state.tick;
    }
    EXPECT_GT(run.state.hexels_burnt, 0);
}

}  // namespace calot::thermal

#endif
