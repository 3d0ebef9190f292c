#pragma once
// Weights with which the nine samples around a pixel make its colour, by their distance from the
// pixel's centre.
//
// Sources: Mitchell and Netravali, "Reconstruction Filters in Computer Graphics" (1988), for
// mitchell, catmull_rom and b_spline; Karis, "High-Quality Temporal Supersampling" (2014), for
// exp(−2.29 x²) and the Blackman-Harris window 3.3 pixels wide; Harris, "On the Use of Windows"
// (1978), for its coefficients; Duchon, "Lanczos Filtering" (1979).

#include <array>
#include <cstdint>

#include "postfx/policy.h"

namespace still::lab {

/// In 1/4096, row by row; the sum is 4096. Samples lie at their pixel's centre plus jitter,
/// −128 … 128. Integer arithmetic, the same everywhere.
std::array<int32_t, 9> sampleWeights(SampleFilter filter, int jitter_x_fx8, int jitter_y_fx8);

}  // namespace still::lab
