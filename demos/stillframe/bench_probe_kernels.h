#pragma once
// Loops that do one thing as fast as the machine's best instruction set does it.

#include <cstddef>
#include <cstdint>

namespace still::command {

struct ProbeKernels {
    /// `bytes` are a multiple of 4096, pointers aligned to 64.
    void (*copy)(const uint8_t* from, uint8_t* to, size_t bytes);
    void (*stream)(const uint8_t* from, uint8_t* to, size_t bytes);
    /// So many rounds of kProbeChains independent operations on vectors; returns the number of
    /// lanes times operations that were done. `sink` has 128 elements: start values, from 64 the
    /// operand, from 96 what keeps the result alive.
    double (*mulHigh)(int rounds, int16_t* sink);
    double (*add)(int rounds, int16_t* sink);
    double (*divide)(int rounds, float* sink);
    /// Texels of 2^18 by pseudo-random indices.
    double (*gather)(const int32_t* texels, int rounds, int32_t* sink);
};
constexpr int kProbeChains = 12;
constexpr int kProbeTexels = 1 << 18;

/// For the best instruction set that is there; without SIMD, all but the copies do nothing.
const ProbeKernels& probeKernels();

}  // namespace still::command
