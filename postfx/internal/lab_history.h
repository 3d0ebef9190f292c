#pragma once
// Where a pixel's history lies, what colour it has there, and whether it is believed. Scalar truth.
//
// Sources: Karis 2014 and Pedersen 2016 for motion dilation; Catmull and Rom, "A Class of Local
// Interpolating Splines" (1974); Jimenez, "Filmic SMAA" (SIGGRAPH 2016), for the filter without
// corners; Schied et al., "Spatiotemporal Variance-Guided Filtering" (HPG 2017), for taps that are
// tested one by one, 2×2 first, then 3×3.

#include "postfx/internal/lab_job.h"
#include "postfx/internal/lab_rules.h"

namespace still::lab {

/// The pixel of the 3×3 window whose motion is used. Facts the policy does not read stay 0.
struct Guide {
    Motion motion;
    uint16_t surface = 0, depth = 0, expected = 0, normal = 0;
};

/// History at one place.
struct Past {
    bool found = false;
    Rgb colour_w24{};
    int memory = 0;  ///< see HistoryPointers, at the nearest pixel
    int failed = 0;  ///< tests of depth, normal, surface and motion
};

Guide findGuide(const ResolveJob& job, int x, int y) noexcept;
Past findPast(const ResolveJob& job, int x, int y, const Guide& guide) noexcept;

}  // namespace still::lab
