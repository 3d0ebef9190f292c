#pragma once
// What the stories of both methods share.

#include "postfx/story.h"

namespace still {

/// What a pixel lost of its past: PixelStory::reason, PixelStory::lost.
struct StoryLoss {
    Verdict reason = Verdict::taken;
    int lost = 0;
};

/// From the weights that each verdict took, of `total` > 0; lost[Verdict::taken] does not count.
inline StoryLoss largestLoss(const int lost[kVerdicts], int total) {
    StoryLoss loss;
    int all = 0, largest = 0;
    for (int v = 1; v < kVerdicts; ++v) {
        all += lost[v];
        if (lost[v] > largest) {
            largest = lost[v];
            loss.reason = Verdict(v);
        }
    }
    loss.lost = all * 255 / total;
    return loss;
}

/// The box around the corners of another one, seen in another space.
StoryBox boxAround(const StoryBox& box, StoryColour (*to)(const StoryColour&));

}  // namespace still
