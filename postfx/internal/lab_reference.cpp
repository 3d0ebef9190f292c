// The truth that SIMD kernels are tested against: one pixel after the other, no tricks.
//
//   3×3 samples ─► window ─► filtered sample ───────────────────────────┐
//   3×3 motions ─► guide ─► place in history ─► filtered history        │
//                     │          tests ─► weight of history     │       │
//                     └─► window ─► rectified history ◄─────────┘       │
//                                        └──────── blend by alpha ◄─────┘ ─► history, shown image

#include <algorithm>
#include <bit>

#include "postfx/internal/lab_kernels.h"
#include "postfx/internal/lab_pixel.h"

namespace still::lab {
namespace {

/// History's weight after the tests, 256 = full.
int trustOf(const TaaPolicy& p, const Past& past, uint8_t failed) {
    if (!past.found || (failed != 0 && !p.partial)) {
        return 0;
    }
    return 256 >> std::popcount(failed);
}

Share shareOf(const ResolveJob& job, const Past& past, int trust_q8, int speed_fx8) {
    const TaaPolicy& p = job.policy;
    Share share;
    switch (p.blend) {
        case Blend::fixed:
        case Blend::velocity: {
            const int32_t alpha = p.blend == Blend::velocity
                                      ? velocityAlpha(p.alpha_q15, p.velocity_alpha_q15, speed_fx8)
                                      : p.alpha_q15;
            share.alpha_q15 = lessTrust(alpha, trust_q8);
            share.confidence = std::min(trust_q8, 255);
            break;
        }
        case Blend::confidence:
            share.memory = std::min<int32_t>(past.memory + kConfidenceStep, 255) * trust_q8 >> 8;
            share.alpha_q15 = confidenceAlpha(p.alpha_q15, share.memory);
            share.confidence = share.memory;
            break;
        case Blend::mean:
            share.count = std::min(past.memory * trust_q8 >> 8, p.count_cap - 1);
            share.memory = share.count + 1;
            share.alpha_q15 = int32_t(kMeanAlphas.of[share.memory]);
            share.confidence = meanConfidence(share.count, job.constants.count_share_q16);
            break;
    }
    return share;
}

int32_t steadied(const TaaPolicy& p, int32_t alpha_q15, int32_t luma, int32_t history_luma) {
    if (p.anti_flicker == AntiFlicker::none || alpha_q15 == kAlphaOne) {
        return alpha_q15;
    }
    if (p.anti_flicker == AntiFlicker::luma_difference) {
        return steadyAlpha(p, alpha_q15, luma, history_luma);
    }
    return weightedAlpha(alpha_q15, inverseWeight(p, luma), inverseWeight(p, history_luma));
}

Rgb blend(const TaaPolicy& p, const Share& share, const Rgb& history_w24, const Rgb& sample_w24) {
    const bool mean = p.blend == Blend::mean && p.anti_flicker == AntiFlicker::none;
    Rgb result = sample_w24;
    for (int c = 0; c < 3; ++c) {
        if (!mean) {
            result.v[c] = blended(history_w24.v[c], sample_w24.v[c], share.alpha_q15);
        } else if (share.count > 0) {
            result.v[c] = extendedMean(history_w24.v[c], sample_w24.v[c], share.count,
                                       p.sample == SampleFilter::box);
        }
    }
    return result;
}

void storeGuide(const ResolveJob& job, ptrdiff_t at, const Guide& guide) {
    const TaaPolicy& p = job.policy;
    if (p.id_reject) {
        job.next.surface[at] = guide.surface;
    }
    if (needsDepth(p)) {
        job.next.depth[at] = guide.depth;
    }
    if (needsNormal(p)) {
        job.next.normal[at] = guide.normal;
    }
    if (needsMotion(p)) {
        job.next.motion[at] = guide.motion;
    }
}

void storePixel(const ResolveJob& job, int x, int y, const Rgb& colour_w24, const Share& share) {
    const ptrdiff_t at = y * job.history_stride + x, shown_at = y * job.stride + x;
    const Rgb shown = linearOf(job.policy, rounded(colour_w24));
    for (int c = 0; c < 3; ++c) {
        job.next.colour_w24[c][at] = uint32_t(colour_w24.v[c]);
        if (job.shown[c] != nullptr) {
            job.shown[c][shown_at] = uint16_t(shown.v[c]);
        }
    }
    if (needsMemory(job.policy)) {
        job.next.memory[at] = uint8_t(share.memory);
    }
    if (job.confidence != nullptr) {
        job.confidence[shown_at] = uint8_t(share.confidence);
    }
}

void resolvePixel(const ResolveJob& job, int x, int y) {
    const PixelSteps steps = stepsOf(job, x, y);
    storeGuide(job, y * job.history_stride + x, steps.guide);
    storePixel(job, x, y, steps.colour_w24, steps.share);
}

}  // namespace

PixelSteps stepsOf(const ResolveJob& job, int x, int y, PastTaps* taps) noexcept {
    const TaaPolicy& p = job.policy;
    PixelSteps s;
    s.window = loadWindow(job, x, y);
    s.sample_w24 = filteredSample_w24(job, s.window);
    s.guide = findGuide(job, x, y);
    s.past = findPast(job, x, y, s.guide, taps);
    s.history = s.rectified = rounded(s.past.colour_w24);
    const int32_t luma = lumaOf(rounded(s.sample_w24));
    s.failed = s.past.failed;
    if (p.luma_reject_q15 > 0 && differentLumas(luma, lumaOf(s.history), p.luma_reject_q15)) {
        s.failed |= kLumaTest;
    }
    s.speed_fx8 = speedOf(s.guide.motion.x_fx8, s.guide.motion.y_fx8);
    s.clipped = rectify(job, s.window, s.speed_fx8, s.rectified);
    Rgb history_w24 = s.past.colour_w24;
    if (s.clipped) {
        history_w24 = {{s.rectified.v[0] << kFractionBits, s.rectified.v[1] << kFractionBits,
                        s.rectified.v[2] << kFractionBits}};
    }
    s.trust_q8 = trustOf(p, s.past, s.failed);
    s.share = shareOf(job, s.past, s.trust_q8, s.speed_fx8);
    s.share.alpha_q15 = steadied(p, s.share.alpha_q15, luma, lumaOf(s.rectified));
    s.colour_w24 = blend(p, s.share, history_w24, s.sample_w24);
    return s;
}

void fillMargin(const ResolveJob& job, const TileRect& tile) noexcept {
    const ptrdiff_t stride = job.history_stride;
    for (uint32_t* plane : job.next.colour_w24) {
        for (int y = tile.y0; y < tile.y1; ++y) {
            uint32_t* row = plane + y * stride;
            if (tile.x0 == 0) {
                std::fill(row - kMargin, row, row[0]);
            }
            if (tile.x1 == job.width) {
                std::fill(row + job.width, row + job.width + kMargin + 1, row[job.width - 1]);
            }
        }
        const int begin = tile.x0 == 0 ? -kMargin : tile.x0;
        const int end = tile.x1 == job.width ? job.width + kMargin + 1 : tile.x1;
        for (int k = 1; k <= kMargin; ++k) {
            if (tile.y0 == 0) {
                std::copy(plane + begin, plane + end, plane + begin - k * stride);
            }
            if (tile.y1 == job.height) {
                const uint32_t* last = plane + (job.height - 1) * stride;
                std::copy(last + begin, last + end, plane + begin + (job.height - 1 + k) * stride);
            }
        }
    }
}

void resolveTileReference(const ResolveJob& job, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            resolvePixel(job, x, y);
        }
    }
    fillMargin(job, tile);
}

}  // namespace still::lab
