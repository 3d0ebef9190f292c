#include "postfx/internal/lab_window.h"

#include <algorithm>

namespace still::lab {
namespace {

/// Smallest and largest of the window, or of the samples that share a row or column with the
/// middle.
void extent(const TaaPolicy& p, const Window& window, bool plus, int channel, int32_t& low,
            int32_t& high) {
    low = INT32_MAX;
    high = INT32_MIN;
    for (int k = 0; k < 9; ++k) {
        if (plus && k % 2 == 0 && k != 4) {
            continue;
        }
        const int32_t v = toSpace(p, window.sample[k]).v[channel];
        low = std::min(low, v);
        high = std::max(high, v);
    }
}

Box extentBox(const TaaPolicy& p, const Window& window) {
    Box box;
    for (int c = 0; c < 3; ++c) {
        extent(p, window, false, c, box.low[c], box.high[c]);
        if (p.rectification == Rectification::rounded_clip) {
            int32_t low = 0, high = 0;
            extent(p, window, true, c, low, high);
            box.low[c] = (box.low[c] + low) >> 1;
            box.high[c] = roundShift(box.high[c] + high, 1);
        }
        box.middle[c] = roundShift(box.low[c] + box.high[c], 1);
        box.half[c] = roundShift(box.high[c] - box.low[c], 1);
    }
    return box;
}

/// FrameConstants::sigma_q12 at this speed.
uint32_t sigmaAt(const ResolveJob& job, int speed_fx8) {
    const FrameConstants& k = job.constants;
    if (job.policy.sigma_still_fx8 == 0) {
        return k.sigma_q12;
    }
    const auto slow = uint32_t(std::min<int32_t>(speed_fx8, k.speed_limit_fx8));
    const uint32_t rest_q8 = 256 - ((slow * k.inverse_speed) >> 16);
    const auto wider = int32_t(k.sigma_still_q12) - int32_t(k.sigma_q12);
    return k.sigma_q12 + uint32_t((wider * int32_t(rest_q8 * rest_q8 >> 8)) >> 8);
}

Box statisticsBox(const ResolveJob& job, const Window& window, int speed_fx8) {
    const uint32_t sigma = sigmaAt(job, speed_fx8);
    Box box;
    for (int c = 0; c < 3; ++c) {
        int32_t sum = 0, middle = 0;
        uint32_t squares = 0;
        for (int k = 0; k < 9; ++k) {
            const Rgb& s = window.sample[k];
            const Rgb held{{std::min(s.v[0], kStatisticsMax), std::min(s.v[1], kStatisticsMax),
                            std::min(s.v[2], kStatisticsMax)}};
            const int32_t v = toSpace(job.policy, held).v[c];
            sum += v;
            squares += uint32_t(v * v);
            middle = k == 4 ? v : middle;
        }
        box.middle[c] = meanOfNine(sum, middle);
        box.half[c] = halfWidth(squaredDeviation(squares, sum, box.middle[c]), sigma);
        box.low[c] = box.middle[c] - box.half[c];
        box.high[c] = box.middle[c] + box.half[c];
    }
    return box;
}

bool clampTo(const Box& box, Rgb& colour) {
    bool changed = false;
    for (int c = 0; c < 3; ++c) {
        const int32_t old = colour.v[c];
        colour.v[c] = std::clamp(old, box.low[c], box.high[c]);
        changed |= colour.v[c] != old;
    }
    return changed;
}

/// Moves the colour along the line to the box's middle until it is on the box.
bool clipTo(const Box& box, Rgb& colour) {
    uint32_t half = 1, distance = 1;  // of the channel that is farthest out
    for (int c = 0; c < 3; ++c) {
        const int32_t d = colour.v[c] - box.middle[c];
        const auto away = uint32_t(std::min(d < 0 ? -d : d, kWorkingMax));
        const auto allowed = uint32_t(box.half[c]);
        if (allowed * distance < half * away) {
            half = allowed;
            distance = away;
        }
    }
    if (half == distance) {
        return false;
    }
    const auto share_q12 = int32_t(quotient<12>(half, distance));
    for (int c = 0; c < 3; ++c) {
        const int32_t d = colour.v[c] - box.middle[c];
        colour.v[c] = box.middle[c] + roundShift(d * share_q12, 12);
    }
    return true;
}

}  // namespace

Window loadWindow(const ResolveJob& job, int x, int y) noexcept {
    Window window;
    for (int k = 0; k < 9; ++k) {
        const int i = std::clamp(x + k % 3 - 1, 0, job.width - 1);
        const int j = std::clamp(y + k / 3 - 1, 0, job.height - 1);
        const ptrdiff_t at = j * job.stride + i;
        const Rgb c{{job.now.colour[0][at], job.now.colour[1][at], job.now.colour[2][at]}};
        window.sample[k] = job.policy.tone == Tone::reinhard ? toneIn(c) : c;
    }
    return window;
}

Rgb filteredSample_w24(const ResolveJob& job, const Window& window) noexcept {
    Rgb result;
    for (int c = 0; c < 3; ++c) {
        int32_t sum = 0;
        for (int k = 0; k < 9; ++k) {
            sum += job.constants.sample_weight_q12[k] * window.sample[k].v[c];
        }
        result.v[c] = std::clamp<int32_t>(roundShift(sum, 12 - kFractionBits), 0, kWorkingMax_w24);
    }
    return result;
}

Box boxOf(const ResolveJob& job, const Window& window, int speed_fx8) noexcept {
    const TaaPolicy& p = job.policy;
    return usesStatistics(p) ? statisticsBox(job, window, speed_fx8) : extentBox(p, window);
}

bool rectify(const ResolveJob& job, const Window& window, int speed_fx8, Rgb& history) noexcept {
    const TaaPolicy& p = job.policy;
    if (p.rectification == Rectification::off) {
        return false;
    }
    const Box box = boxOf(job, window, speed_fx8);
    Rgb colour = toSpace(p, history);
    const bool changed = clips(p) ? clipTo(box, colour) : clampTo(box, colour);
    history = changed ? fromSpace(p, colour) : history;
    return changed;
}

}  // namespace still::lab
