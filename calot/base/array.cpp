#include "calot/base/array.h"

#include <atomic>
#include <mutex>
#include <new>

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
#include <sys/mman.h>
#endif

namespace calot {

namespace {

constexpr std::size_t kLine = 64, kLinesOfPage = 64;
constexpr std::size_t kLarge = 16384;
std::atomic<std::size_t> large_arrays{0}, large_bytes{0};

/// A stretch of memory that arrays are cut from, one after the other. It is given back when the last of them is.
struct Slab {
    char* begin = nullptr;
    std::size_t bytes = 0, used = 0, arrays = 0;
};

/// What lies in the line before an array: where its memory comes from.
struct Origin {
    char* block = nullptr;
    Slab* slab = nullptr;  ///< null: the heap
    std::size_t bytes = 0;
};
static_assert(sizeof(Origin) <= kLine);

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)

/// Large pages where the system has them: a kernel that reads forty arrays at once misses less often where they are.
constexpr std::size_t kPage = 4096;
constexpr std::size_t kLargePage = std::size_t{1} << 21;
constexpr std::size_t kSlab = 16 * kLargePage;

class Slabs {
  public:
    Origin take(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        bytes = (bytes + kLine - 1) / kLine * kLine;
        if (bytes > kSlab / 4) return cut(*make((bytes + kLargePage - 1) / kLargePage * kLargePage), bytes);
        if (current_ == nullptr || current_->used + bytes > current_->bytes) current_ = make(kSlab);
        return cut(*current_, bytes);
    }
    void give_back(const Origin& origin) {
        const std::lock_guard lock(mutex_);
        Slab* slab = origin.slab;
        // What was taken last is taken again.
        if (origin.block + origin.bytes == slab->begin + slab->used) slab->used -= origin.bytes;
        if (--slab->arrays > 0) return;
        if (slab == current_) current_ = nullptr;
        ::munmap(slab->begin, slab->bytes);
        delete slab;
    }

  private:
    static Origin cut(Slab& slab, std::size_t bytes) {
        char* block = slab.begin + slab.used;
        slab.used += bytes;
        ++slab.arrays;
        // Now, not in the tick that uses a reserve for the first time: the system may take milliseconds to find a large
        // page.
        for (std::size_t k = 0; k < bytes; k += kPage) static_cast<volatile char*>(block)[k] = 0;
        return {block, &slab, bytes};
    }
    static Slab* make(std::size_t bytes) {
        // Begins with a large page: what is before that and what is left behind is given back.
        void* memory = ::mmap(nullptr, bytes + kLargePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (memory == MAP_FAILED) throw std::bad_alloc();
        auto* begin = static_cast<char*>(memory);
        const std::size_t before = (kLargePage - reinterpret_cast<std::uintptr_t>(begin) % kLargePage) % kLargePage;
        if (before > 0) ::munmap(begin, before);
        ::munmap(begin + before + bytes, kLargePage - before);
        ::madvise(begin + before, bytes, MADV_HUGEPAGE);  // no is an answer
        return new Slab{begin + before, bytes, 0, 0};
    }

    std::mutex mutex_;
    Slab* current_ = nullptr;  ///< has room
};

/// Never destroyed: arrays of static objects may outlive it.
Slabs& slabs() {
    static Slabs* all = new Slabs;
    return *all;
}

#endif

Origin take(std::size_t bytes) {
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
    if (bytes >= kLarge) return slabs().take(bytes);
#endif
    return {static_cast<char*>(::operator new (bytes, std::align_val_t{kLine})), nullptr, bytes};
}

}  // namespace

void* allocate_apart(std::size_t bytes) {
    // Steps of 11 lines visit every line of a page before any comes again.
    const std::size_t lines = bytes < kLarge ? 0 : 11 * large_arrays.fetch_add(1) % kLinesOfPage;
    const Origin origin = take(bytes + kLine * (1 + lines));
    if (origin.slab != nullptr) large_bytes += origin.bytes;
    char* array = origin.block + kLine * (1 + lines);
    std::memcpy(array - kLine, &origin, sizeof(origin));
    return array;
}

void free_apart(void* p) {
    if (p == nullptr) return;
    Origin origin;
    std::memcpy(&origin, static_cast<char*>(p) - kLine, sizeof(origin));
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
    if (origin.slab != nullptr) {
        large_bytes -= origin.bytes;
        return slabs().give_back(origin);
    }
#endif
    ::operator delete (origin.block, std::align_val_t{kLine});
}

std::size_t large_arrays_allocated() {
    return large_arrays;
}
std::size_t large_array_bytes() {
    return large_bytes;
}

}  // namespace calot
