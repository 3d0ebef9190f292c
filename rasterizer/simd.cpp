#include "rasterizer/simd.h"

#if STILL_SIMD
#include <hwy/highway.h>

#include "rasterizer/internal/dispatch.h"
#endif

namespace still {

std::string_view name(SimdTarget target) {
    switch (target) {
        case SimdTarget::scalar:
            return "scalar";
        case SimdTarget::ssse3:
            return "ssse3";
        case SimdTarget::sse4:
            return "sse4";
        case SimdTarget::avx2:
            return "avx2";
        case SimdTarget::avx512:
            return "avx512";
        case SimdTarget::neon:
            return "neon";
        case SimdTarget::wasm:
            return "wasm";
    }
    return "unknown";
}

std::vector<SimdTarget> availableSimdTargets() {
    std::vector<SimdTarget> targets{SimdTarget::scalar};
#if STILL_SIMD
    // Where there is one static target, as on WebAssembly, nobody has to be asked.
    int64_t usable = HWY_TARGETS;
    if constexpr (HWY_TARGETS != HWY_STATIC_TARGET) {
        usable &= hwy::SupportedTargets();
    }
    for (SimdTarget target : {SimdTarget::ssse3, SimdTarget::sse4, SimdTarget::avx2,
                              SimdTarget::avx512, SimdTarget::neon, SimdTarget::wasm}) {
        if ((usable & internal::highwayBit(target)) != 0) {
            targets.push_back(target);
        }
    }
#endif
    return targets;
}

SimdTarget bestSimdTarget() {
#if STILL_SIMD
    // Asking the processor takes half a millisecond in a virtual machine.
    static const SimdTarget best = availableSimdTargets().back();
    return best;
#else
    return SimdTarget::scalar;
#endif
}

}  // namespace still
