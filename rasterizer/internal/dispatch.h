#pragma once
// Picks a kernel for a SimdTarget from a table that HWY_EXPORT made. Highway's own dispatch keeps
// the choice in a global; here the caller decides, so one process can compare all targets.
// Include after hwy/highway.h.

#include <bit>
#include <cstddef>
#include <cstdint>

#include "rasterizer/simd.h"

namespace still::internal {

/// Highway's bit for a target; 0 for scalar and for targets of other architectures.
constexpr int64_t highwayBit(SimdTarget target) {
    switch (target) {
#if HWY_ARCH_X86
        case SimdTarget::ssse3:
            return HWY_SSSE3;
        case SimdTarget::sse4:
            return HWY_SSE4;
        case SimdTarget::avx2:
            return HWY_AVX2;
        case SimdTarget::avx512:
            return HWY_AVX3;
#elif HWY_ARCH_ARM
        case SimdTarget::neon:
            return HWY_NEON;
#elif HWY_ARCH_WASM
        case SimdTarget::wasm:
            return HWY_WASM;
#endif
        default:
            return 0;
    }
}

/// Precondition: `target` is one of availableSimdTargets() and not scalar.
template <class Function, size_t kEntries>
Function pickKernel(Function const (&table)[kEntries], SimdTarget target) {
    if constexpr (kEntries == 1) {
        return table[0];  // one static target, as on WebAssembly
    } else {
        return table[std::countr_zero(uint64_t(HWY_CHOSEN_TARGET_SHIFT(highwayBit(target))))];
    }
}

}  // namespace still::internal
