#include "postfx/internal/gather_story.h"

#include <algorithm>

#include "postfx/internal/gather_pixel.h"

namespace still::taa {
namespace {

StoryColour told(const int rgb[3]) {
    return {rgb[0], rgb[1], rgb[2]};
}

StoryColour shownAt(const Job& job, ptrdiff_t at) {
    return {job.shown[0][at], job.shown[1][at], job.shown[2][at]};
}

StoryColour sampleAt(const SlotIn& slot, ptrdiff_t at) {
    return {plusOffset(slot.colour[0][at]), plusOffset(slot.colour[1][at]),
            plusOffset(slot.colour[2][at])};
}

std::array<StoryColour, 9> windowAt(const Job& job, int x, int y) {
    std::array<StoryColour, 9> window;
    for (int k = 0; k < 9; ++k) {
        const int i = std::clamp(x + k % 3 - 1, 0, job.width - 1);
        const int j = std::clamp(y + k / 3 - 1, 0, job.height - 1);
        const ptrdiff_t at = j * job.stride + i;
        window[size_t(k)] = {job.now.colour[0][at], job.now.colour[1][at], job.now.colour[2][at]};
    }
    return window;
}

StoryBox extentOf(const std::array<StoryColour, 9>& window) {
    StoryBox box{window[0], window[0], {}};
    for (size_t c = 0; c < 3; ++c) {
        for (const StoryColour& colour : window) {
            box.low[c] = std::min(box.low[c], colour[c]);
            box.high[c] = std::max(box.high[c], colour[c]);
        }
        box.middle[c] = (box.low[c] + box.high[c] + 1) >> 1;
    }
    return box;
}

StoryBox ycocgExtentOf(std::array<StoryColour, 9> window) {
    std::transform(window.begin(), window.end(), window.begin(), toStoryYcocg);
    return extentOf(window);
}

/// Only the taps of the frames before.
Taps pastOf(const Taps& all) {
    Taps past;
    for (int i = all.fresh; i < all.count; ++i) {
        const Tap& tap = all.tap[i];
        past.tap[past.count++] = tap;
        past.moments.add(tap.weight, tap.ex, tap.ey);
    }
    return past;
}

/// The pixel without this frame's samples.
StoryColour colourOfPast(const Job& job, int x, int y) {
    GatherSteps steps;
    gatherTaps(job, x, y, steps);
    int behind[3] = {}, rgb[3] = {};
    const bool separate = steps.window.apart && fit(pastOf(steps.far), nullptr, behind);
    return fit(pastOf(steps.own), separate ? behind : nullptr, rgb) ? told(rgb) : StoryColour{};
}

StoryLoss lossOf(const Sightings& own) {
    if (own.frames < 2) {
        return {Verdict::no_history, 255};
    }
    int lost[kVerdicts] = {};
    for (int i = 0; i < own.count; ++i) {
        const Sighting& s = own.at[i];
        lost[int(s.verdict)] += s.age > 0 ? s.weight : 0;
    }
    lost[int(own.end)] += kFrameWeight * (own.frames - own.end_age);
    return largestLoss(lost, kFrameWeight * (own.frames - 1));
}

/// Adds what a way has met. `taps` are those of `sightings` that count.
void tellWay(const Job& job, const Sightings& sightings, const Taps& taps, bool far, bool separate,
             PixelStory& story) {
    const Tilt tilt = taps.moments.w >= 2 ? tiltOf(taps.moments) : Tilt{};
    int next = 0;
    for (int i = 0; i < sightings.count; ++i) {
        const Sighting& s = sightings.at[i];
        PixelTap tap;
        tap.age = s.age;
        tap.x = s.x;
        tap.y = s.y;
        tap.from_centre_x_fx8 = s.ex * 4;
        tap.from_centre_y_fx8 = s.ey * 4;
        tap.layer = s.layer;
        tap.along_far = far;
        tap.weight = s.weight;
        tap.verdict = s.verdict;
        if (s.verdict != Verdict::off_screen) {
            const SlotIn& slot = job.slot[s.age];
            const ptrdiff_t at = s.y * job.stride + s.x;
            tap.surface = slot.id[at] & int(kSurfaceMask);
            tap.depth = plusOffset(slot.depth[at]);
            tap.colour = sampleAt(slot, at);
        }
        if (s.verdict == Verdict::taken) {
            const Tap& counted = taps.tap[next++];
            tap.recoloured = !far && separate && counted.behind;
            const bool used = taps.moments.w >= 2 && (!far || separate);
            tap.used = used ? tiltedWeight(counted.weight, tilt, counted.ex, counted.ey) : 0;
        }
        story.taps.push_back(tap);
    }
}

void tellGathered(const Job& job, int x, int y, PixelStory& story) {
    GatherSteps steps;
    PixelSightings met;
    gatherTaps(job, x, y, steps, &met);
    gatherColour(job, x, y, steps);
    story.output = told(steps.rgb);
    story.layered = steps.window.layered;
    story.apart = steps.window.apart;
    story.frames = met.own.frames;
    story.spatial_q8 = steps.spatial_q8;
    story.count = roundShift(steps.own.moments.w, 8);
    const StoryLoss loss = lossOf(met.own);
    story.reason = loss.reason;
    story.lost = loss.lost;
    tellWay(job, met.own, steps.own, false, steps.separate, story);
    tellWay(job, met.far, steps.far, true, steps.separate, story);
}

StoryOwner ownerAt(const Job& job, int x, int y) {
    const Owner owner = inferOwner(job, x, y, seenOwner(job, x, y));
    return {.surface = owner.surface,
            .depth = owner.depth,
            .expected = owner.expected,
            .motion = owner.motion,
            .moved = owner.moved,
            .inferred = owner.inferred};
}

}  // namespace

PixelStory tellPixel(const Job& job, PixelSource source, int x, int y) {
    const ptrdiff_t at = y * job.stride + x;
    PixelStory story;
    story.source = source;
    story.x = x;
    story.y = y;
    story.raw = {job.now.colour[0][at], job.now.colour[1][at], job.now.colour[2][at]};
    story.owner = ownerAt(job, x, y);
    story.window = windowAt(job, x, y);
    story.box_rgb = extentOf(story.window);
    story.box_ycocg = ycocgExtentOf(story.window);
    if (source == PixelSource::gathered) {
        tellGathered(job, x, y, story);
        return story;
    }
    story.output = shownAt(job, at);
    story.count = job.shown_count[at];
    story.finished = source == PixelSource::mean && story.count >= job.sample_cap;
    story.frames = 1;
    const StoryLoss loss = tellLoss(job, source, x, y);
    story.reason = loss.reason;
    story.lost = loss.lost;
    story.spatial_q8 = source == PixelSource::first ? kFrameWeight : 0;
    return story;
}

StoryColour tellColour(const Job& job, StoryPlane plane, PixelSource source, int x, int y) {
    const ptrdiff_t at = y * job.stride + x;
    switch (plane) {
        case StoryPlane::history:
            return source == PixelSource::mean ? shownAt(job, at)
                   : job.frames > 1            ? sampleAt(job.slot[1], at)
                                               : StoryColour{};
        case StoryPlane::reprojected:
        case StoryPlane::rectified:
            return source == PixelSource::mean       ? shownAt(job, at)
                   : source == PixelSource::gathered ? colourOfPast(job, x, y)
                                                     : StoryColour{};
        case StoryPlane::box_low:
            return extentOf(windowAt(job, x, y)).low;
        case StoryPlane::box_high:
            return extentOf(windowAt(job, x, y)).high;
        case StoryPlane::box_middle:
            break;
    }
    return extentOf(windowAt(job, x, y)).middle;
}

StoryLoss tellLoss(const Job& job, PixelSource source, int x, int y) {
    if (source == PixelSource::mean) {
        return {};
    }
    if (source == PixelSource::first) {
        return {Verdict::no_history, 255};
    }
    GatherSteps steps;
    PixelSightings met;
    gatherTaps(job, x, y, steps, &met);
    return lossOf(met.own);
}

}  // namespace still::taa
