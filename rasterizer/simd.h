#pragma once
// Which instruction set the kernels run on. All give the same bytes; `scalar` is the plain C++
// that defines them.

#include <string_view>
#include <vector>

namespace still {

enum class SimdTarget { scalar, ssse3, sse4, avx2, avx512, neon, wasm };

/// The names people type and read: "scalar", "ssse3", …
std::string_view name(SimdTarget target);

/// Targets that are compiled in and that this CPU runs, worst first; scalar is always there.
std::vector<SimdTarget> availableSimdTargets();

/// The last one of availableSimdTargets().
SimdTarget bestSimdTarget();

}  // namespace still
