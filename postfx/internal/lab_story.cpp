// Tells what lab_reference.cpp does.

#include <algorithm>

#include "postfx/internal/lab_pixel.h"
#include "postfx/internal/story_parts.h"

namespace still::lab {
namespace {

StoryColour told(const Rgb& c) {
    return {c.v[0], c.v[1], c.v[2]};
}

Verdict verdictOf(uint8_t failed) {
    if ((failed & kDepthTest) != 0) {
        return Verdict::depth;
    }
    if ((failed & kNormalTest) != 0) {
        return Verdict::normal;
    }
    if ((failed & kSurfaceTest) != 0) {
        return Verdict::id;
    }
    if ((failed & kMotionTest) != 0) {
        return Verdict::velocity;
    }
    return failed != 0 ? Verdict::colour : Verdict::taken;
}

Verdict verdictOf(const PastTaps::Tap& tap) {
    return tap.outside ? Verdict::off_screen : verdictOf(tap.failed);
}

/// What the 2×2 taps of HistoryFilter::validated lost by their own tests.
StoryLoss lossOfTaps(const PastTaps& taps) {
    int lost[kVerdicts] = {};
    int total = 0;
    for (int i = 0; i < std::min(taps.count, taps.wide_from); ++i) {
        lost[size_t(verdictOf(taps.tap[i]))] += taps.tap[i].weight;
        total += taps.tap[i].weight;
    }
    return total > 0 ? largestLoss(lost, total) : StoryLoss{};
}

StoryLoss lossOf(const ResolveJob& job, const PixelSteps& steps, const PastTaps& taps) {
    if (steps.failed != 0 && steps.past.found) {
        return {verdictOf(steps.failed), std::min(256 - steps.trust_q8, 255)};
    }
    if (steps.past.outside) {
        return {Verdict::off_screen, 255};
    }
    const StoryLoss loss = lossOfTaps(taps);
    if (steps.past.found) {
        return loss;
    }
    const bool tested = job.policy.history == HistoryFilter::validated && loss.lost != 0;
    return {tested ? loss.reason : Verdict::no_history, 255};
}

/// Working colours of history to what people see.
StoryColour pastColour(const ResolveJob& job, ptrdiff_t at) {
    Rgb w24{};
    for (int c = 0; c < 3; ++c) {
        w24.v[c] = int32_t(job.before.colour_w24[c][at]);
    }
    return told(linearOf(job.policy, rounded(w24)));
}

/// The samples that the pixel's own colour was filtered from.
void tellWindow(const ResolveJob& job, const PixelSteps& steps, PixelStory& story) {
    for (int k = 0; k < 9; ++k) {
        const int weight = roundShift(job.constants.sample_weight_q12[k], 4);
        if (weight == 0) {
            continue;
        }
        const int dx = k % 3 - 1, dy = k / 3 - 1;
        const int x = std::clamp(story.x + dx, 0, job.width - 1);
        const int y = std::clamp(story.y + dy, 0, job.height - 1);
        const ptrdiff_t at = y * job.stride + x;
        PixelTap tap;
        tap.x = x;
        tap.y = y;
        tap.from_centre_x_fx8 = dx * 256 + story.jitter_x_fx8;
        tap.from_centre_y_fx8 = dy * 256 + story.jitter_y_fx8;
        tap.surface = job.now.id[at] & kSurfaceMask;
        tap.depth = int(logDepth16(job.now.depth[at]));
        tap.colour = told(linearOf(job.policy, steps.window.sample[k]));
        tap.weight = weight;
        tap.used = roundShift(weight * steps.share.alpha_q15, 15);
        story.taps.push_back(tap);
    }
}

PixelTap pastTap(const ResolveJob& job, const PastTaps& taps, const PastTaps::Tap& from) {
    PixelTap tap;
    tap.age = 1;
    tap.x = from.x;
    tap.y = from.y;
    tap.from_centre_x_fx8 = from.x * 256 - taps.place_x_fx8;
    tap.from_centre_y_fx8 = from.y * 256 - taps.place_y_fx8;
    tap.weight = from.weight;
    tap.verdict = verdictOf(from);
    if (from.outside) {
        return tap;
    }
    // The margin repeats the border's colours and knows nothing else.
    const bool inside = from.x >= 0 && from.x < job.width && from.y >= 0 && from.y < job.height;
    const ptrdiff_t at = from.y * job.history_stride + from.x;
    tap.colour = pastColour(job, at);
    tap.surface = inside && job.policy.id_reject ? int(job.before.surface[at]) : -1;
    tap.depth = inside && needsDepth(job.policy) ? int(job.before.depth[at]) : -1;
    return tap;
}

/// What was read of history. Taps that count share what those that do not have lost.
void tellPast(const ResolveJob& job, const PixelSteps& steps, const PastTaps& taps,
              PixelStory& story) {
    const Verdict verdict = verdictOf(steps.failed);
    const int share_q15 = kAlphaOne - steps.share.alpha_q15;
    int counted = 0;
    for (int i = 0; i < taps.count; ++i) {
        const bool counts = verdictOf(taps.tap[i]) == Verdict::taken;
        counted += counts ? taps.tap[i].weight : 0;
    }
    for (int i = 0; i < taps.count; ++i) {
        PixelTap tap = pastTap(job, taps, taps.tap[i]);
        if (tap.verdict == Verdict::taken) {
            tap.verdict = verdict;
            tap.used = roundShift(tap.weight * share_q15 / counted, 7);
        }
        story.taps.push_back(tap);
    }
}

/// The box in RGB and in YCoCg.
void tellBox(const ResolveJob& job, const Window& window, int speed_fx8, StoryBox& rgb,
             StoryBox& ycocg) {
    const Box box = boxOf(job, window, speed_fx8);
    const StoryBox exact{{box.low[0], box.low[1], box.low[2]},
                         {box.high[0], box.high[1], box.high[2]},
                         {box.middle[0], box.middle[1], box.middle[2]}};
    const bool is_ycocg = job.policy.space == ColourSpace::ycocg;
    rgb = is_ycocg ? boxAround(exact, fromStoryYcocg) : exact;
    ycocg = is_ycocg ? exact : boxAround(exact, toStoryYcocg);
}

BlendStory blendOf(const ResolveJob& job, const PixelSteps& steps) {
    return {.sample = told(rounded(steps.sample_w24)),
            .history = told(steps.history),
            .rectified = told(steps.rectified),
            .rectifies = job.policy.rectification != Rectification::off,
            .clipped = steps.clipped && steps.past.found,
            .alpha_q15 = steps.share.alpha_q15,
            .trust_q8 = steps.trust_q8,
            .memory = steps.past.memory};
}

Rgb heldInRange(const StoryColour& c) {
    return {{std::clamp<int32_t>(c[0], 0, kWorkingMax), std::clamp<int32_t>(c[1], 0, kWorkingMax),
             std::clamp<int32_t>(c[2], 0, kWorkingMax)}};
}

StoryColour boxColour(const ResolveJob& job, const PixelSteps& steps, StoryPlane plane) {
    StoryBox rgb, ycocg;
    tellBox(job, steps.window, steps.speed_fx8, rgb, ycocg);
    const StoryColour& colour = plane == StoryPlane::box_low    ? rgb.low
                                : plane == StoryPlane::box_high ? rgb.high
                                                                : rgb.middle;
    return told(linearOf(job.policy, heldInRange(colour)));
}

StoryColour planeColour(const ResolveJob& job, StoryPlane plane, int x, int y) {
    if (plane == StoryPlane::history) {
        return job.has_history ? pastColour(job, y * job.history_stride + x) : StoryColour{};
    }
    const PixelSteps steps = stepsOf(job, x, y);
    if (plane != StoryPlane::reprojected && plane != StoryPlane::rectified) {
        return boxColour(job, steps, plane);
    }
    if (!steps.past.found) {
        return {};
    }
    const bool rectified = plane == StoryPlane::rectified;
    return told(linearOf(job.policy, rectified ? steps.rectified : steps.history));
}

}  // namespace

PixelStory tellPixel(const ResolveJob& job, int jitter_x_fx8, int jitter_y_fx8, int x, int y) {
    PastTaps taps;
    const PixelSteps steps = stepsOf(job, x, y, &taps);
    const ptrdiff_t at = y * job.stride + x, guide = steps.guide.at;
    const Current& now = job.now;
    PixelStory story;
    story.source = PixelSource::blended;
    story.x = x;
    story.y = y;
    story.jitter_x_fx8 = jitter_x_fx8;
    story.jitter_y_fx8 = jitter_y_fx8;
    story.raw = {now.colour[0][at], now.colour[1][at], now.colour[2][at]};
    story.output = told(linearOf(job.policy, rounded(steps.colour_w24)));
    story.owner.surface = now.id[guide] & kSurfaceMask;
    story.owner.depth = int(logDepth16(now.depth[guide]));
    story.owner.expected = now.depth_before[guide];
    story.owner.motion = steps.guide.motion;
    story.owner.moved = (now.id[guide] & kMovedBit) != 0;
    story.frames = steps.past.found ? 2 : 1;
    story.confidence = steps.share.confidence;
    const StoryLoss loss = lossOf(job, steps, taps);
    story.reason = loss.reason;
    story.lost = loss.lost;
    for (size_t k = 0; k < 9; ++k) {
        story.window[k] = told(steps.window.sample[k]);
    }
    tellBox(job, steps.window, steps.speed_fx8, story.box_rgb, story.box_ycocg);
    story.blend = blendOf(job, steps);
    tellWindow(job, steps, story);
    tellPast(job, steps, taps, story);
    return story;
}

void tellRow(const ResolveJob& job, StoryPlane plane, int y, uint16_t* const rows[3]) {
    for (int x = 0; x < job.width; ++x) {
        const StoryColour colour = planeColour(job, plane, x, y);
        for (size_t c = 0; c < 3; ++c) {
            rows[c][x] = uint16_t(colour[c]);
        }
    }
}

void tellRejections(const ResolveJob& job, int y, Verdict* reasons, uint8_t* lost) {
    for (int x = 0; x < job.width; ++x) {
        PastTaps taps;
        const StoryLoss loss = lossOf(job, stepsOf(job, x, y, &taps), taps);
        reasons[x] = loss.reason;
        lost[x] = uint8_t(loss.lost);
    }
}

}  // namespace still::lab
