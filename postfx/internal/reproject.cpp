#include "postfx/internal/reproject.h"

#include <algorithm>
#include <cstdlib>

#include "postfx/internal/rules.h"

namespace still::taa {
namespace {

enum class Trust : uint8_t { none, suspect, full };

/// What taps are held against.
struct Claim {
    const ResolveJob& job;
    const Owner& owner;
    uint16_t surface;  ///< owner's
    int tolerance;
    bool surface_rests;
};

struct Taps {
    uint32_t weight[4] = {};
    ptrdiff_t at[4] = {};
    Trust trust[4] = {Trust::none, Trust::none, Trust::none, Trust::none};
};

bool inside(const ResolveJob& job, int x, int y) {
    return x >= 0 && x < job.width && y >= 0 && y < job.height;
}

bool stillProves(const Claim& claim, uint16_t stored_surface) {
    return !claim.job.camera_moved && claim.surface_rests && claim.job.restsNow(stored_surface);
}

bool apart(Motion a, Motion b) {
    return std::abs(a.x_fx8 - b.x_fx8) + std::abs(a.y_fx8 - b.y_fx8) >= kApart;
}

/// The surface, depth and normal tests of a tap. Where nothing moves but the camera, the expected
/// depth alone says that it is the same place; otherwise it must be the same surface, too.
Trust trustTap(const Claim& claim, ptrdiff_t at) {
    const HistoryIn& before = claim.job.before;
    const uint16_t stored = before.surface[at];
    const bool rest = claim.surface_rests && claim.job.restsNow(stored);
    if (stored != claim.surface && !rest) {
        return Trust::none;
    }
    if (std::abs(int(before.depth[at]) - int(claim.owner.expected)) <= claim.tolerance) {
        const bool smooth = claim.job.now.normal == nullptr ||
                            similarNormals(before.normal[at], claim.owner.normal);
        return smooth && !claim.job.shading_changed ? Trust::full : Trust::suspect;
    }
    // Which surface is nearest in a window may depend on the jitter alone.
    return rest ? Trust::suspect : Trust::none;
}

void copyTap(const ResolveJob& job, ptrdiff_t at, Past& past) {
    for (int c = 0; c < 3; ++c) {
        past.mean[c] = job.before.mean[c][at];
        past.rest[c] = job.before.rest[c][at];
    }
    past.count = job.before.count[at];
}

/// 4×4 filter, held within the inner 2×2 taps. False when a tap that counts is not fully trusted.
bool cubicTaps(const Claim& claim, int ix, int iy, int fx, int fy, Past& past) {
    const int i0 = fx == 0 ? 0 : -1, i1 = fx == 0 ? 0 : 2;
    const int j0 = fy == 0 ? 0 : -1, j1 = fy == 0 ? 0 : 2;
    const ResolveJob& job = claim.job;
    if (!inside(job, ix + i0, iy + j0) || !inside(job, ix + i1, iy + j1)) {
        return false;
    }
    int count = 255;
    for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i) {
            const ptrdiff_t at = (iy + j) * job.stride + ix + i;
            if (trustTap(claim, at) != Trust::full) {
                return false;
            }
            const bool inner = (i == 0 || i == 1) && (j == 0 || j == 1);
            count = inner ? std::min<int>(count, job.before.count[at]) : count;
        }
    }
    const CubicWeights wx = cubicWeights(fx), wy = cubicWeights(fy);
    past.count = std::min(count, resampledCount(fx, fy));
    for (int c = 0; c < 3; ++c) {
        int low = 65535, high = 0, sum = 0;
        for (int j = j0; j <= j1; ++j) {
            const uint16_t* row = job.before.mean[c] + (iy + j) * job.stride + ix;
            int line = 0;
            for (int i = i0; i <= i1; ++i) {
                line += wx.w[i + 1] * int(row[i]);
                if ((i == 0 || i == 1) && (j == 0 || j == 1)) {
                    low = std::min<int>(low, row[i]);
                    high = std::max<int>(high, row[i]);
                }
            }
            sum += wy.w[j + 1] * roundShift(line, kCubicRowShift);
        }
        const int value = std::clamp(roundShift(sum, kCubicColumnShift), low << kFractionBits,
                                     high << kFractionBits);
        const Sum kept = sumOf(value, past.count);
        past.mean[c] = kept.mean;
        past.rest[c] = kept.rest;
    }
    return true;
}

/// Weighted mean of the taps with at least `needed` trust; `total` is the sum of their weights.
void blendTaps(const ResolveJob& job, const Taps& taps, Trust needed, uint32_t total, int limit,
               Past& past) {
    int count = limit;
    uint64_t sum[3] = {};
    for (int k = 0; k < 4; ++k) {
        if (taps.weight[k] == 0 || taps.trust[k] < needed) {
            continue;
        }
        count = std::min<int>(count, job.before.count[taps.at[k]]);
        for (int c = 0; c < 3; ++c) {
            sum[c] += uint64_t(taps.weight[k]) * job.before.mean[c][taps.at[k]];
        }
    }
    past.count = count;
    for (int c = 0; c < 3; ++c) {
        const int value = int(((sum[c] << kFractionBits) + total / 2) / total);
        const Sum kept = sumOf(value, count);
        past.mean[c] = kept.mean;
        past.rest[c] = kept.rest;
    }
}

/// Equal-weight mean of the fully trusted pixels in the 3×3 window around (x, y).
void blendWindow(const Claim& claim, int x, int y, int limit, Past& past) {
    const ResolveJob& job = claim.job;
    int n = 0, count = limit;
    uint32_t sum[3] = {};
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            const ptrdiff_t at = (y + j) * job.stride + x + i;
            if (!inside(job, x + i, y + j) || trustTap(claim, at) != Trust::full) {
                continue;
            }
            ++n;
            count = std::min<int>(count, job.before.count[at]);
            for (int c = 0; c < 3; ++c) {
                sum[c] += job.before.mean[c][at];
            }
        }
    }
    if (n < kWindowTaps) {
        return;
    }
    past.count = count;
    for (int c = 0; c < 3; ++c) {
        const int value = int(((sum[c] << kFractionBits) + uint32_t(n) / 2) / uint32_t(n));
        const Sum kept = sumOf(value, count);
        past.mean[c] = kept.mean;
        past.rest[c] = kept.rest;
    }
}

void collectTaps(const Claim& claim, int ix, int iy, int fx, int fy, Taps& taps) {
    for (int k = 0; k < 4; ++k) {
        const int i = k & 1, j = k >> 1;
        taps.weight[k] = uint32_t((i != 0 ? fx : 256 - fx) * (j != 0 ? fy : 256 - fy));
        taps.at[k] = (iy + j) * claim.job.stride + ix + i;
        if (taps.weight[k] != 0 && inside(claim.job, ix + i, iy + j)) {
            taps.trust[k] = trustTap(claim, taps.at[k]);
        }
    }
}

}  // namespace

Owner findOwner(const ResolveJob& job, int x, int y) noexcept {
    // Columns first, then the best of the three columns, as the SIMD kernel does it. Ties: middle
    // before top before bottom, middle before left before right.
    const auto better = [&](ptrdiff_t a, ptrdiff_t b) {
        return job.now.depth[b] > job.now.depth[a] ? b : a;
    };
    const auto column = [&](int cx) {
        const ptrdiff_t centre = y * job.stride + cx;
        ptrdiff_t best = centre;
        best = y > 0 ? better(best, centre - job.stride) : best;
        return y + 1 < job.height ? better(best, centre + job.stride) : best;
    };
    ptrdiff_t best = column(x);
    best = x > 0 ? better(best, column(x - 1)) : best;
    best = x + 1 < job.width ? better(best, column(x + 1)) : best;

    const ptrdiff_t centre = y * job.stride + x;
    Owner owner;
    owner.id = job.now.id[best];
    owner.depth = logDepth16(job.now.depth[best]);
    owner.expected = job.now.depth_before[best];
    owner.motion = job.now.motion[best];
    owner.normal = job.now.normal != nullptr ? compactNormal(job.now.normal[best]) : uint16_t{0};
    owner.slope =
        job.now.id[centre] == owner.id ? owner.depth - logDepth16(job.now.depth[centre]) : 0;
    return owner;
}

Past findPast(const ResolveJob& job, int x, int y, const Owner& owner) noexcept {
    Past past;
    if (owner.motion.x_fx8 == kNoHistory) {
        return past;
    }
    const ptrdiff_t centre = y * job.stride + x;
    const Claim claim{job, owner, uint16_t(owner.id & kSurfaceMask),
                      kDepthTolerance + kSlopeFactor * owner.slope, (owner.id & kMovedBit) == 0};
    if (stillProves(claim, job.before.surface[centre])) {
        copyTap(job, centre, past);
        past.proven = !job.shading_changed;
        past.suspect = job.shading_changed;
        return past;
    }
    const int px = x * 256 + owner.motion.x_fx8, py = y * 256 + owner.motion.y_fx8;
    const int ix = px >> 8, iy = py >> 8, fx = px & 255, fy = py & 255;
    Taps taps;
    collectTaps(claim, ix, iy, fx, fy, taps);
    uint32_t full = 0, likely = 0;
    for (int k = 0; k < 4; ++k) {
        full += taps.trust[k] == Trust::full ? taps.weight[k] : 0;
        likely += taps.trust[k] != Trust::none ? taps.weight[k] : 0;
    }
    past.suspect = full < kMinWeight && likely >= kMinWeight;
    if (fx == 0 && fy == 0) {
        if (likely != 0) {
            copyTap(job, taps.at[0], past);
        }
    } else if (full != kFullWeight || !cubicTaps(claim, ix, iy, fx, fy, past)) {
        if (full >= kMinWeight) {
            blendTaps(job, taps, Trust::full, full, resampledCount(fx, fy), past);
        } else if (likely >= kMinWeight) {
            blendTaps(job, taps, Trust::suspect, likely, resampledCount(fx, fy), past);
        }
    }
    if (past.count == 0) {
        blendWindow(claim, (px + 128) >> 8, (py + 128) >> 8, kWindowCount, past);
    }
    if (job.now.id[centre] != owner.id && apart(job.now.motion[centre], owner.motion)) {
        past.count = std::min(past.count, kEdgeCount);
        past.suspect = true;
    }
    return past;
}

}  // namespace still::taa
