#pragma once
// One pixel of the laboratory, step by step. Scalar truth.

#include "postfx/internal/lab_history.h"
#include "postfx/internal/lab_job.h"
#include "postfx/internal/lab_rules.h"
#include "postfx/internal/lab_window.h"
#include "postfx/story.h"

namespace still::lab {

/// How a pixel is blended and what is remembered of it.
struct Share {
    int32_t alpha_q15 = kAlphaOne;
    int count = 0;  ///< Blend::mean: samples that history stands for
    int memory = 0;
    int confidence = 0;
};

struct PixelSteps {
    Window window;
    Rgb sample_w24;
    Guide guide;
    Past past;
    int speed_fx8 = 0;
    uint8_t failed = 0;      ///< Tests
    Rgb history, rectified;  ///< working colours before and after the box
    bool clipped = false;    ///< … which differ
    int trust_q8 = 0;        ///< history's weight after the tests, 256 = full
    Share share;
    Rgb colour_w24;  ///< the result
};

/// Reads and does not write, so it may be asked again. Taps as in findPast().
PixelSteps stepsOf(const ResolveJob& job, int x, int y, PastTaps* taps = nullptr) noexcept;

inline Rgb rounded(const Rgb& colour_w24) {
    return {{roundShift(colour_w24.v[0], kFractionBits), roundShift(colour_w24.v[1], kFractionBits),
             roundShift(colour_w24.v[2], kFractionBits)}};
}

/// Working colour to linear fx12.
inline Rgb linearOf(const TaaPolicy& p, const Rgb& working) {
    return p.tone == Tone::reinhard ? toneOut(working) : working;
}

// lab_story.cpp: what stepsOf() says, told. `job` is the frame's once more; nothing is written
// through it. The jitter is that of LaboratoryFrame.
PixelStory tellPixel(const ResolveJob& job, int jitter_x_fx8, int jitter_y_fx8, int x, int y);
/// Row y of a plane; `rows` point to its first pixels.
void tellRow(const ResolveJob& job, StoryPlane plane, int y, uint16_t* const rows[3]);
void tellRejections(const ResolveJob& job, int y, Verdict* reasons, uint8_t* lost);

}  // namespace still::lab
