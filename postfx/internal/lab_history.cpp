#include "postfx/internal/lab_history.h"

#include <algorithm>

namespace still::lab {
namespace {

/// The larger, the sooner a pixel's motion is used.
int32_t guideKey(const ResolveJob& job, ptrdiff_t at) {
    if (job.policy.dilation == Dilation::nearest_depth) {
        return int32_t(job.now.depth[at]);
    }
    const int32_t x = job.now.motion[at].x_fx8, y = job.now.motion[at].y_fx8;
    return x == kNoHistory ? -1 : int32_t((uint32_t(x * x) + uint32_t(y * y)) >> 1);
}

/// Columns first, then the best of the three columns, as lanes do it. Ties: middle before top
/// before bottom, middle before left before right.
ptrdiff_t guideAt(const ResolveJob& job, int x, int y) {
    const auto better = [&](ptrdiff_t a, ptrdiff_t b) {
        return guideKey(job, b) > guideKey(job, a) ? b : a;
    };
    const auto column = [&](int cx) {
        const ptrdiff_t centre = y * job.stride + cx;
        ptrdiff_t best = centre;
        best = y > 0 ? better(best, centre - job.stride) : best;
        return y + 1 < job.height ? better(best, centre + job.stride) : best;
    };
    ptrdiff_t best = column(x);
    best = x > 0 ? better(best, column(x - 1)) : best;
    return x + 1 < job.width ? better(best, column(x + 1)) : best;
}

/// A place in history: whole pixels and fractions.
struct Place {
    int x, y, fx, fy;
    ptrdiff_t at;       ///< of (x, y)
    ptrdiff_t nearest;  ///< pixel
};

uint8_t failedTests(const ResolveJob& job, const Guide& guide, ptrdiff_t at) {
    const TaaPolicy& p = job.policy;
    const HistoryIn& before = job.before;
    int failed = 0;
    if (needsDepth(p) && differentDepths(before.depth[at], guide.expected, p.depth_reject_q15)) {
        failed |= kDepthTest;
    }
    if (needsNormal(p) &&
        differentNormals(before.normal[at], guide.normal, job.constants.normal_square_q15)) {
        failed |= kNormalTest;
    }
    if (p.id_reject && before.surface[at] != guide.surface) {
        failed |= kSurfaceTest;
    }
    return uint8_t(failed);
}

int32_t bilinear(const uint32_t* colour, ptrdiff_t stride, const Place& place) {
    const auto fx = uint32_t(place.fx), fy = uint32_t(place.fy);
    const auto row = [&](const uint32_t* p) { return (p[0] * (256 - fx) + p[1] * fx + 128) >> 8; };
    const uint32_t* top = colour + place.at;
    return int32_t((row(top) * (256 - fy) + row(top + stride) * fy + 128) >> 8);
}

/// 4×4 taps, or the twelve without the corners.
int32_t catmullRom(const TaaPolicy& p, const uint32_t* colour, ptrdiff_t stride,
                   const Place& place) {
    const CubicWeights wx = cubicWeights(place.fx), wy = cubicWeights(place.fy);
    const bool corners = p.history == HistoryFilter::catmull_rom16;
    int32_t sum = 0, low = INT32_MAX, high = 0;
    for (int j = 0; j < 4; ++j) {
        int32_t row = 0;
        for (int i = 0; i < 4; ++i) {
            const bool inner_column = i == 1 || i == 2, inner_row = j == 1 || j == 2;
            const auto tap = int32_t(colour[place.at + (j - 1) * stride + i - 1]);
            row += corners || inner_column || inner_row ? wx.w[i] * roundShift(tap, kTapShift) : 0;
            if (inner_column && inner_row) {
                low = std::min(low, tap);
                high = std::max(high, tap);
            }
        }
        sum += wy.w[j] * roundShift(row, kCubicBits);
    }
    int32_t value = roundShift(sum, kCubicColumnShift);
    if (!corners) {
        value += roundShift(roundShift(value, kTapShift) * cornerGain(wx, wy), 16 - kTapShift);
    }
    return p.dering ? std::clamp(value, low, high) : std::clamp<int32_t>(value, 0, kWorkingMax_w24);
}

/// Sum of weighted taps, to be divided by the weights' sum.
struct Sum {
    uint32_t colour[3] = {}, weight = 0;
};

bool inside(const ResolveJob& job, int x, int y) {
    return x >= 0 && x < job.width && y >= 0 && y < job.height;
}

void note(PastTaps* taps, const PastTaps::Tap& tap) {
    if (taps != nullptr && tap.weight != 0) {
        taps->tap[taps->count++] = tap;
    }
}

/// `told` is the tap's weight in PastTaps.
void addTap(const ResolveJob& job, const Guide& guide, int x, int y, uint32_t weight, Sum& sum,
            PastTaps* taps, int told) {
    if (!inside(job, x, y)) {
        note(taps, {.x = x, .y = y, .weight = told, .outside = true});
        return;
    }
    const ptrdiff_t at = y * job.history_stride + x;
    const uint8_t failed = failedTests(job, guide, at);
    note(taps, {.x = x, .y = y, .weight = told, .failed = failed});
    if (failed != 0) {
        return;
    }
    sum.weight += weight;
    for (int c = 0; c < 3; ++c) {
        sum.colour[c] += weight * job.before.colour_w24[c][at];
    }
}

/// 2×2 taps, then 3×3 around the nearest pixel, as far as they pass the tests. False when none
/// does.
bool validated(const ResolveJob& job, const Guide& guide, const Place& place, int nearest_x,
               int nearest_y, Rgb& colour, PastTaps* taps) {
    Sum sum;
    for (int k = 0; k < 4; ++k) {
        const int i = k & 1, j = k >> 1;
        const int weight =
            ((i != 0 ? place.fx : 256 - place.fx) * (j != 0 ? place.fy : 256 - place.fy)) >> 8;
        addTap(job, guide, place.x + i, place.y + j, uint32_t(weight), sum, taps, weight);
    }
    const bool widen = sum.weight == 0;
    if (taps != nullptr && widen) {
        taps->wide_from = taps->count;
    }
    for (int k = 0; k < 9 && widen; ++k) {
        addTap(job, guide, nearest_x + k % 3 - 1, nearest_y + k / 3 - 1, 1, sum, taps, 28);
    }
    for (int c = 0; c < 3 && sum.weight != 0; ++c) {
        colour.v[c] = int32_t(highProduct(sum.colour[c], kReciprocals.of[sum.weight]));
    }
    return sum.weight != 0;
}

/// Motion by whole pixels is copied, whatever the filter: no bit is lost at rest.
HistoryFilter filterAt(const TaaPolicy& p, const Place& place) {
    return place.fx == 0 && place.fy == 0 ? HistoryFilter::nearest : p.history;
}

Rgb filtered(const ResolveJob& job, const Place& place) {
    Rgb colour;
    for (int c = 0; c < 3; ++c) {
        const uint32_t* plane = job.before.colour_w24[c];
        switch (filterAt(job.policy, place)) {
            case HistoryFilter::nearest:
                colour.v[c] = int32_t(plane[place.nearest]);
                break;
            case HistoryFilter::bilinear:
            case HistoryFilter::validated:
                colour.v[c] = bilinear(plane, job.history_stride, place);
                break;
            case HistoryFilter::catmull_rom5:
            case HistoryFilter::catmull_rom16:
                colour.v[c] = catmullRom(job.policy, plane, job.history_stride, place);
                break;
        }
    }
    return colour;
}

/// What filtered() reads, in taps of 4×4 around the place.
void noteFilter(const TaaPolicy& p, const Place& place, int nearest_x, int nearest_y,
                PastTaps& taps) {
    const HistoryFilter filter = filterAt(p, place);
    if (filter == HistoryFilter::nearest) {
        note(&taps, {.x = nearest_x, .y = nearest_y, .weight = 256});
        return;
    }
    const bool cubic = filter != HistoryFilter::bilinear;
    const int low = cubic ? 0 : 1, high = cubic ? 3 : 2;
    const CubicWeights wx =
        cubic ? cubicWeights(place.fx) : CubicWeights{{0, 4 * (256 - place.fx), 4 * place.fx, 0}};
    const CubicWeights wy =
        cubic ? cubicWeights(place.fy) : CubicWeights{{0, 4 * (256 - place.fy), 4 * place.fy, 0}};
    for (int j = low; j <= high; ++j) {
        for (int i = low; i <= high; ++i) {
            const bool corner = (i == 0 || i == 3) && (j == 0 || j == 3);
            if (!corner || filter == HistoryFilter::catmull_rom16) {
                note(&taps, {.x = place.x + i - 1,
                             .y = place.y + j - 1,
                             .weight = roundShift(wx.w[i] * wy.w[j], 2 * kCubicBits - 8)});
            }
        }
    }
}

}  // namespace

Guide findGuide(const ResolveJob& job, int x, int y) noexcept {
    const TaaPolicy& p = job.policy;
    const ptrdiff_t at = p.dilation == Dilation::centre ? y * job.stride + x : guideAt(job, x, y);
    Guide guide;
    guide.at = at;
    guide.motion = job.now.motion[at];
    if (p.id_reject) {
        guide.surface = job.now.id[at] & kSurfaceMask;
    }
    if (needsDepth(p)) {
        guide.depth = logDepth16(job.now.depth[at]);
        guide.expected = job.now.depth_before[at];
    }
    if (needsNormal(p)) {
        guide.normal = compactNormal(job.now.normal[at]);
    }
    return guide;
}

Past findPast(const ResolveJob& job, int x, int y, const Guide& guide, PastTaps* taps) noexcept {
    const TaaPolicy& p = job.policy;
    const int px = x * 256 + guide.motion.x_fx8, py = y * 256 + guide.motion.y_fx8;
    Past past;
    if (!job.has_history || guide.motion.x_fx8 == kNoHistory) {
        return past;
    }
    past.outside =
        px < -128 || py < -128 || px >= job.width * 256 - 128 || py >= job.height * 256 - 128;
    if (past.outside) {
        return past;
    }
    const int near_x = (px + 128) >> 8, near_y = (py + 128) >> 8;
    if (taps != nullptr) {
        taps->place_x_fx8 = px;
        taps->place_y_fx8 = py;
    }
    Place place{px >> 8, py >> 8, px & 255, py & 255, 0, near_y * job.history_stride + near_x};
    place.at = place.y * job.history_stride + place.x;
    if (p.history == HistoryFilter::validated) {
        past.found = validated(job, guide, place, near_x, near_y, past.colour_w24, taps);
    } else {
        if (taps != nullptr) {
            noteFilter(p, place, near_x, near_y, *taps);
        }
        past.found = true;
        past.colour_w24 = filtered(job, place);
        past.failed = failedTests(job, guide, place.nearest);
    }
    if (needsMotion(p)) {
        const Motion old = job.before.motion[place.nearest];
        const bool differ = differentMotions(guide.motion.x_fx8 - old.x_fx8,
                                             guide.motion.y_fx8 - old.y_fx8, p.velocity_reject_fx8);
        past.failed = uint8_t(past.failed | (differ ? kMotionTest : 0));
    }
    past.memory = needsMemory(p) ? job.before.memory[place.nearest] : 0;
    return past;
}

}  // namespace still::lab
