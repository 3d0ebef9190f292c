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
    ptrdiff_t at = 0;  ///< in the current frame's planes
    Motion motion;
    uint16_t surface = 0, depth = 0, expected = 0, normal = 0;
};

/// Tests of history, a bit each.
enum Test : uint8_t {
    kDepthTest = 1,
    kNormalTest = 2,
    kSurfaceTest = 4,
    kMotionTest = 8,
    kLumaTest = 16,
};

/// History at one place.
struct Past {
    bool found = false;
    bool outside = false;  ///< not found because the place is not in the picture
    Rgb colour_w24{};
    int memory = 0;      ///< see HistoryPointers, at the nearest pixel
    uint8_t failed = 0;  ///< Tests, all but that of luminance
};

/// What a filter read of history, for those who ask.
struct PastTaps {
    struct Tap {
        int x = 0, y = 0;  ///< may lie in the margin
        int weight = 0;    ///< of 256; of a cubic filter rounded, of a widened one's nine 28
        bool outside = false;
        uint8_t failed = 0;  ///< HistoryFilter::validated: its own Tests
    };
    Tap tap[16];
    int count = 0;
    int wide_from = 16;  ///< from this one on, they were only read because none before counts
    int place_x_fx8 = 0, place_y_fx8 = 0;  ///< of the pixel's centre in history
};

Guide findGuide(const ResolveJob& job, int x, int y) noexcept;
/// Writes what it read to `taps` unless that is null.
Past findPast(const ResolveJob& job, int x, int y, const Guide& guide,
              PastTaps* taps = nullptr) noexcept;

}  // namespace still::lab
