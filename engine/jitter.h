#pragma once
// Sample positions inside the pixel, exact in 1/256 pixel.

#include <cstdint>

namespace still {

/// Offset of the sample from the pixel's centre, x right, y down, in 1/256 pixel, −128 … 127.
struct SampleOffset {
    int x_fx8 = 0, y_fx8 = 0;
};

/// Length of the TAA sequence: a centred (0,2)-net in base 2.
constexpr uint32_t kTaaPeriod = 64;

/// Sample `index` (taken modulo kTaaPeriod) of the TAA sequence; any 2^k aligned run of samples is
/// itself a (0,2)-net, and the offsets of a period have zero mean.
SampleOffset taaSample(uint32_t index);

/// Sample `index` of a set of `count` samples for ssaa references; 1 ≤ count ≤ 65536. A single
/// sample is the pixel's centre. Powers of two are (0,2)-nets: up to 128 samples they have zero
/// mean, 256 and more use the full 1/256 grid (mean −1/512 pixel). Other counts are nearly as even.
SampleOffset ssaaSample(uint32_t index, uint32_t count);

}  // namespace still
