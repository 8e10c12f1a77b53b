#pragma once
// Content hashes (XXH3, 64 bits) of arrays and states.

#include <cstdint>
#include <span>

#include <xxhash.h>

namespace calot {

inline std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed = 0) {
    return XXH3_64bits_withSeed(data, bytes, seed);
}

}  // namespace calot
