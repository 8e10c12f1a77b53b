// The one place for wide arithmetic: Google Highway with run-time dispatch, so that one binary serves every x86-64
// (SSE4, AVX2, AVX-512), Arm and WebAssembly. A kernel file reads:
//
//   #undef HWY_TARGET_INCLUDE
//   #define HWY_TARGET_INCLUDE "calot/room/kernel_simd.cpp"   // this very file, compiled once per instruction set
//   #include <hwy/foreach_target.h>
//   #include "calot/base/simd.h"
//
//   HWY_BEFORE_NAMESPACE();
//   namespace calot::room { namespace HWY_NAMESPACE {
//   void kernel(...) { const simd::Floats d; ... }
//   } }
//   HWY_AFTER_NAMESPACE();
//
//   #if HWY_ONCE
//   namespace calot::room {
//   HWY_EXPORT(kernel);
//   void kernel(...) { HWY_DYNAMIC_DISPATCH(kernel)(...); }
//   }
//   #endif
#include <hwy/highway.h>

// No include guard in the usual sense: this part is compiled once per instruction set.
#if defined(CALOT_BASE_SIMD_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CALOT_BASE_SIMD_H_
#undef CALOT_BASE_SIMD_H_
#else
#define CALOT_BASE_SIMD_H_
#endif

#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace calot {
namespace HWY_NAMESPACE {
namespace simd {

namespace hn = hwy::HWY_NAMESPACE;

/// Widest vector of floats, at most 16 lanes.
using Floats = hn::CappedTag<float, 16>;

/// Mask of the lanes of `d` from a bit array: lane k is bit (index + k). `bytes` must be readable for 4 bytes from there.
template <class D>
HWY_INLINE hn::Mask<D> mask_at(D d, const std::uint8_t* bytes, std::int64_t index) {
    std::uint32_t word;
    std::memcpy(&word, bytes + (index >> 3), sizeof(word));
    word >>= (index & 7);
    std::uint8_t lanes[8] = {};
    std::memcpy(lanes, &word, sizeof(word));
    return hn::LoadMaskBits(d, lanes);
}

/// The lanes of `d` from a bit array, as the low bits of an integer: 0 means that the whole group can be skipped.
template <class D>
HWY_INLINE std::uint32_t bits_at(D d, const std::uint8_t* bytes, std::int64_t index) {
    std::uint32_t word;
    std::memcpy(&word, bytes + (index >> 3), sizeof(word));
    return (word >> (index & 7)) & ((1u << hn::Lanes(d)) - 1u);
}

/// The lanes of `d` from sixteen bits, from bit `lane` on.
template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, std::uint16_t bits, int lane) {
    const std::uint64_t word = static_cast<std::uint64_t>(bits) >> lane;  // LoadMaskBits may read eight bytes
    return hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&word));
}

}  // namespace simd
}  // namespace HWY_NAMESPACE
}  // namespace calot
HWY_AFTER_NAMESPACE();

#endif
