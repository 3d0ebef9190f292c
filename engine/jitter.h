#pragma once
// Sample positions inside the pixel, exact in 1/256 pixel.

#include <cstdint>

#include "postfx/policy.h"

namespace still {

/// Offset of the sample from the pixel's centre, x right, y down, in 1/256 pixel, −128 … 127.
struct SampleOffset {
    int x_fx8 = 0, y_fx8 = 0;
};

/// Length of the TAA sequence: a centred (0,2)-net in base 2.
constexpr uint32_t kTaaPeriod = 64;

/// Sample `index` (taken modulo kTaaPeriod) of the TAA sequence. A period is a net and has zero
/// mean; sample 0 is the one nearest the pixel's centre; any 8 samples in a row lie evenly, also on
/// a surface that glides slowly under them (up to 0.3 pixel per frame), but runs are not nets.
/// The same as jitterSample(JitterPattern::net64, 256, false, index).
SampleOffset taaSample(uint32_t index);

/// Samples after which a pattern begins again: the number in its name, 1 for none, 64 for r2 and
/// blue_noise. Always a power of two.
uint32_t jitterPeriod(JitterPattern pattern);

constexpr int kMaxJitterScale_fx8 = 1024;

/// Sample `index` of a pattern.
/// `scale_fx8`, 0 … kMaxJitterScale_fx8, multiplies offsets (256 = as they are), rounded half up;
/// what would leave the pixel stays at its edge. `scramble` takes the samples of each period after
/// the first in another order, in which aligned runs of 2, 4, 8 … stay together (those of net16 and
/// net32 are nets). Without it any `period` consecutive samples are the whole set; with it only
/// those of a period are.
/// Zero mean over a period: none, uniform2, rgss4, hammersley, net. Halton begins at index 1, its
/// values are exact and rounded half up. Formulas: jitter.cpp.
SampleOffset jitterSample(JitterPattern pattern, int scale_fx8, bool scramble, uint32_t index);

/// Length of the sequence of temporal upscaling: as many samples for each output pixel as the TAA
/// sequence has, rounded up to a power of two: kTaaPeriod … kMaxUpscalePeriod.
uint32_t upscalePeriod(int ratio_fx8);
constexpr uint32_t kMaxUpscalePeriod = 1024;

/// Sample `index` (taken modulo `period`) of the sequence of upscalePeriod() samples:
/// Owen-scrambled Sobol, whose aligned runs of 2, 4, 8 … are (0,2)-nets, so that every square part
/// of a pixel gets its share early. A mean of up to −1/512 pixel is left, as of ssaaSample().
SampleOffset upscaleSample(uint32_t index, uint32_t period);

/// What a policy asks for: its pattern, but with JitterPattern::net64 and temporal upscaling the
/// sequence above (without `scramble`).
uint32_t policyPeriod(const TaaPolicy& policy);
SampleOffset policySample(const TaaPolicy& policy, uint32_t index);

/// Frames after which a picture that stands still is called finished: of ours, none are left.
inline int finishingSamples(const TaaPolicy& policy) {
    return int(upscalesInTime(policy) ? policyPeriod(policy) : kTaaPeriod);
}

/// Sample `index` of a set of `count` samples for ssaa references; 1 ≤ count ≤ 65536. A single
/// sample is the pixel's centre. Powers of two are (0,2)-nets: up to 128 samples they have zero
/// mean, 256 and more use the full 1/256 grid (mean −1/512 pixel). Other counts are nearly as even.
SampleOffset ssaaSample(uint32_t index, uint32_t count);

}  // namespace still
