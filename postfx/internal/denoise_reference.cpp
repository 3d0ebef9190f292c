// The denoiser, one pixel after the other: the truth that its lanes are tested against.

#include <array>

#include "postfx/internal/denoise_kernels.h"
#include "postfx/internal/denoise_rules.h"

namespace still::denoising {
namespace {

bool inside(const Job& job, int x, int y) {
    return x >= 0 && x < job.width && y >= 0 && y < job.height;
}

/// What the past says about a pixel.
struct Found {
    float light[kChannels] = {};
    float square[kParts] = {};
    float count[kParts] = {};
    float age[kParts] = {};
    float weight = 0;
    bool exact = false;  ///< one pixel's, not resampled
};

struct Wanted {
    int surface = 0, depth = 0, tolerance = 0;
    float normal[3] = {};
    float cosine = kPastCosine;
};

bool fits(const Job& job, const Wanted& wanted, ptrdiff_t at) {
    const Past& past = job.before;
    if (past.surface[at] != wanted.surface ||
        std::abs(int(past.depth[at]) - wanted.depth) > wanted.tolerance) {
        return false;
    }
    const float cosine = wanted.normal[0] * past.normal[0][at] +
                         wanted.normal[1] * past.normal[1][at] +
                         wanted.normal[2] * past.normal[2][at];
    return cosine >= wanted.cosine;
}

void add(const Past& past, ptrdiff_t at, float weight, Found& found) {
    for (int c = 0; c < kChannels; ++c) {
        found.light[c] += weight * past.light[c][at];
    }
    for (int p = 0; p < kParts; ++p) {
        found.square[p] += weight * past.square[p][at];
        found.count[p] += weight * float(past.count[p][at]);
        found.age[p] += weight * float(past.age[p][at]);
    }
    found.weight += weight;
}

void divide(Found& found) {
    const float share = 1.0f / found.weight;
    for (float& v : found.light) {
        v *= share;
    }
    for (int p = 0; p < kParts; ++p) {
        found.square[p] *= share;
        found.count[p] *= share;
        found.age[p] *= share;
    }
}

Found findPast(const Job& job, int x, int y) {
    Found found;
    const ptrdiff_t at = y * job.stride + x;
    const Motion motion = job.motion[at];
    if (!job.has_past || motion.x_fx8 == kNoHistory) {
        return found;
    }
    Wanted wanted{
        job.now.surface[at], job.depth_before[at],
        pastTolerance(std::bit_cast<float>(job.depth[at]), job.step[0][at], job.step[1][at])};
    for (int c = 0; c < 3; ++c) {
        wanted.normal[c] = job.now.normal[c][at];
    }
    const Wanted strict = wanted;
    if (motion == Motion{}) {  // what its samples hit within the pixel is averaged
        wanted.tolerance = 65535;
        wanted.cosine = -2;
    }
    const int px = x * 256 + motion.x_fx8, py = y * 256 + motion.y_fx8;
    const int ix = px >> 8, iy = py >> 8, fx = px & 255, fy = py & 255;
    int total = 0;
    for (int tap = 0; tap < 4; ++tap) {
        const int i = tap & 1, j = tap >> 1;
        const int weight = (i != 0 ? fx : 256 - fx) * (j != 0 ? fy : 256 - fy);
        const ptrdiff_t from = (iy + j) * job.stride + ix + i;
        if (weight != 0 && inside(job, ix + i, iy + j) && fits(job, wanted, from)) {
            add(job.before, from, float(weight), found);
            total += weight;
        }
    }
    found.exact = total == 65536 && fx == 0 && fy == 0;
    if (total < kEnoughPast) {
        found = {};
        const int nx = (px + 128) >> 8, ny = (py + 128) >> 8;
        for (int j = ny - 1; j <= ny + 1; ++j) {
            for (int i = nx - 1; i <= nx + 1; ++i) {
                if (inside(job, i, j) && fits(job, strict, j * job.stride + i)) {
                    add(job.before, j * job.stride + i, 1.0f, found);
                }
            }
        }
    }
    if (found.weight > 0) {
        divide(found);
    }
    return found;
}

/// For how long the pixel has stood still.
int stillFor(const Job& job, ptrdiff_t at) {
    const bool rests = job.has_past && job.motion[at] == Motion{};
    return rests ? std::min(job.before.still[at] + 1, 255) : 0;
}

/// Whether the other surface was put aside since the pixel has stood still and its light is as it
/// is.
bool otherHolds(const Job& job, ptrdiff_t at, int still) {
    const uint32_t past = job.frame - job.other.stored[at];
    return job.other.surface[at] == job.now.surface[at] && past < uint32_t(still) &&
           past <= job.before.age[0][at] && past <= job.before.age[1][at];
}

/// What the pixel showed a frame ago becomes the other surface, and the other one the past.
void turn(const Job& job, ptrdiff_t at, int still, Found& found) {
    const Other& other = job.other;
    const Past& past = job.before;
    const bool known = otherHolds(job, at, still);
    if (known) {
        for (int c = 0; c < kChannels; ++c) {
            found.light[c] = other.light[c][at];
        }
        for (int p = 0; p < kParts; ++p) {
            found.square[p] = other.square[p][at];
            found.count[p] = float(other.count[p][at]);
            found.age[p] = float(past.age[p][at]);
        }
        found.weight = 1;
        found.exact = true;
    }
    if (past.surface[at] == 0) {
        return;
    }
    for (int c = 0; c < kChannels; ++c) {
        other.light[c][at] = past.light[c][at];
    }
    for (int p = 0; p < kParts; ++p) {
        other.square[p][at] = past.square[p][at];
        other.count[p][at] = past.count[p][at];
        found.count[p] = known ? found.count[p] : std::min(found.count[p], kBorrowed);
    }
    other.surface[at] = past.surface[at];
    other.stored[at] = job.frame;
}

void clear(const Job& job, ptrdiff_t at) {
    job.now.still[at] = uint8_t(stillFor(job, at));
    for (int c = 0; c < kChannels; ++c) {
        job.now.light[c][at] = 0;
        job.first.light[c][at] = 0;
    }
    for (int p = 0; p < kParts; ++p) {
        job.now.square[p][at] = 0;
        job.now.count[p][at] = 0;
        job.now.age[p][at] = 0;
        job.first.variance[p][at] = 0;
    }
    job.light_age[at] = 255;
}

}  // namespace

void blendPixel(const Job& job, int x, int y) noexcept {
    const ptrdiff_t at = y * job.stride + x;
    if (job.now.surface[at] == 0) {
        clear(job, at);
        return;
    }
    Found found = findPast(job, x, y);
    const int still = stillFor(job, at);
    if (still > 0 && job.before.surface[at] != job.now.surface[at]) {
        turn(job, at, still, found);
    }
    int light_age = 255;
    for (int p = 0; p < kParts; ++p) {
        const BlockChange change = changeAt(job, p, x, y);
        const float longest = float(found.exact ? kLongest : kLongestMoving);
        const float past_count = std::min(found.count[p], longest - 1);
        const float even = 1.0f / (past_count + 1.0f);
        const float share = found.weight > 0 ? even + (1.0f - even) * change.unsure : 1.0f;
        float sample[3];
        for (int c = 0; c < 3; ++c) {
            sample[c] = float(job.noisy[3 * p + c][at]);
            const float past = found.light[3 * p + c] * change.ratio;
            const float mean = past + (sample[c] - past) * share;
            job.now.light[3 * p + c][at] = mean;
            job.first.light[3 * p + c][at] = toPlane(mean);
        }
        const float bright = luminance(sample[0], sample[1], sample[2]);
        const float past_square = found.square[p] * (change.ratio * change.ratio);
        job.now.square[p][at] = past_square + (bright * bright - past_square) * share;
        job.now.count[p][at] = uint8_t(int(1.0f / share + 0.5f));
        const float drift = std::max(std::abs(change.ratio - 1.0f), change.unsure * kDriftPart);
        const float bound = drift > 0 ? std::min(255.0f, kAgeDrift / drift) : 255.0f;
        const bool grown_up = still == kYoungFrames && found.count[p] <= float(kYoungFrames);
        const float older = std::min(found.age[p] + 1, grown_up ? float(kYoungKept) : 255.0f);
        const float age = std::min(older, bound);
        job.now.age[p][at] = uint8_t(int((found.weight > 0 ? age : 255.0f) + 0.5f));
        light_age = std::min(light_age, int(job.now.age[p][at]));
    }
    job.light_age[at] = uint8_t(light_age);
    job.now.still[at] = uint8_t(still);
}

namespace {

float pastLuminance(const Job& job, int part, ptrdiff_t at) {
    return luminance(job.now.light[3 * part][at], job.now.light[3 * part + 1][at],
                     job.now.light[3 * part + 2][at]);
}

bool alike(const Job& job, ptrdiff_t a, ptrdiff_t b) {
    const float cosine = job.now.normal[0][a] * job.now.normal[0][b] +
                         job.now.normal[1][a] * job.now.normal[1][b] +
                         job.now.normal[2][a] * job.now.normal[2][b];
    return job.now.surface[b] != 0 && cosine >= kPastCosine &&
           std::abs(int(job.now.depth[a]) - int(job.now.depth[b])) <= kAroundTolerance;
}

/// Of one sample, from the pixels around.
float variedAround(const Job& job, int part, int x, int y) {
    const ptrdiff_t at = y * job.stride + x;
    float total = 0, sum = 0, squares = 0;
    for (int j = std::max(y - kAround, 0); j <= std::min(y + kAround, job.height - 1); ++j) {
        for (int i = std::max(x - kAround, 0); i <= std::min(x + kAround, job.width - 1); ++i) {
            const ptrdiff_t from = j * job.stride + i;
            if (alike(job, at, from)) {
                total += 1;
                sum += pastLuminance(job, part, from);
                squares += job.now.square[part][from];
            }
        }
    }
    const float mean = sum / total;
    const float off = pastLuminance(job, part, at) - mean;
    return std::max(kOutlier * (off * off), squares / total - mean * mean);
}

/// Reversed depth is flat over a flat surface: the smaller of the differences to both sides is the
/// surface's own.
float stepAt(const Job& job, ptrdiff_t at, ptrdiff_t next, bool first, bool last) {
    const auto z = [&](ptrdiff_t i) { return std::bit_cast<float>(job.depth[i]); };
    if (first && last) {
        return 0;
    }
    const float ahead = last ? z(at) - z(at - next) : z(at + next) - z(at);
    const float back = first ? ahead : z(at) - z(at - next);
    return std::abs(back) < std::abs(ahead) ? back : ahead;
}

}  // namespace

void guidesReference(const Job& job, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const ptrdiff_t at = y * job.stride + x;
            job.now.surface[at] = job.id[at] & kSurfaceMask;
            job.now.depth[at] = logDepth16(job.depth[at]);
            const NormalVector n = decodeOctahedral(job.normal[at]);
            const float length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
            const float scale = job.now.surface[at] == 0 ? 0.0f : 1.0f / length;
            job.now.normal[0][at] = n.x * scale;
            job.now.normal[1][at] = n.y * scale;
            job.now.normal[2][at] = n.z * scale;
            job.step[0][at] = stepAt(job, at, 1, x == 0, x + 1 == job.width);
            job.step[1][at] = stepAt(job, at, job.stride, y == 0, y + 1 == job.height);
        }
    }
}

void blendReference(const Job& job, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            blendPixel(job, x, y);
        }
    }
}

void varianceReference(const Job& job, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            const ptrdiff_t at = y * job.stride + x;
            if (job.now.surface[at] == 0) {
                continue;
            }
            for (int p = 0; p < kParts; ++p) {
                const float count = float(job.now.count[p][at]);
                const float mean = pastLuminance(job, p, at);
                const float own = std::max(0.0f, job.now.square[p][at] - mean * mean);
                job.first.variance[p][at] =
                    count < kShort ? variedAround(job, p, x, y) / count : own / (count - 1);
            }
        }
    }
}

namespace {

/// Variance of the 3×3 around a pixel, the border's repeated.
float smoothVariance(const Job& job, const float* variance, int x, int y) {
    float sum = 0;
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            const int nx = std::clamp(x + i, 0, job.width - 1);
            const int ny = std::clamp(y + j, 0, job.height - 1);
            sum += kSmooth[i + 1] * kSmooth[j + 1] * variance[ny * job.stride + nx];
        }
    }
    return sum;
}

float luminanceOf(const FilterPlanes& planes, int part, ptrdiff_t at) {
    return luminance(float(planes.light[3 * part][at]), float(planes.light[3 * part + 1][at]),
                     float(planes.light[3 * part + 2][at]));
}

void filterPixel(const Job& job, const FilterPlanes& in, const FilterPlanes& out, int pass,
                 int parts, int x, int y) {
    const ptrdiff_t at = y * job.stride + x;
    const int stride = 1 << pass;
    const float depth = std::bit_cast<float>(job.depth[at]);
    const float step_x = job.step[0][at] * float(stride), step_y = job.step[1][at] * float(stride);
    const float plane_scale = planeScale(depth, step_x, step_y, float(stride));
    float here[kParts] = {}, scale[kParts] = {};
    float total[kParts] = {}, square[kParts] = {}, sum[kChannels] = {};
    for (int p = 0; p < kParts; ++p) {
        if (!filters(parts, p)) {
            continue;
        }
        here[p] = luminanceOf(in, p, at);
        scale[p] =
            1.0f / (kSigmas[p] * std::sqrt(smoothVariance(job, in.variance[p], x, y)) + kLeastSpan);
        total[p] = kCentre;
        square[p] = kCentre * kCentre * in.variance[p][at];
        for (int c = 3 * p; c < 3 * p + 3; ++c) {
            sum[c] = kCentre * float(in.light[c][at]);
        }
    }
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            const int nx = x + i * stride, ny = y + j * stride;
            if ((i == 0 && j == 0) || !inside(job, nx, ny)) {
                continue;
            }
            const ptrdiff_t from = ny * job.stride + nx;
            const float dx = job.now.normal[0][at] - job.now.normal[0][from];
            const float dy = job.now.normal[1][at] - job.now.normal[1][from];
            const float dz = job.now.normal[2][at] - job.now.normal[2][from];
            const float off = std::bit_cast<float>(job.depth[from]) -
                              (depth + float(i) * step_x + float(j) * step_y);
            const float shape = kWindow[i + 1] * kWindow[j + 1] *
                                fallOff((dx * dx + dy * dy + dz * dz) * (1.0f / kNormalReach)) *
                                fallOff(std::abs(off) * plane_scale);
            for (int p = 0; p < kParts; ++p) {
                if (!filters(parts, p)) {
                    continue;
                }
                const float difference = std::abs(luminanceOf(in, p, from) - here[p]);
                const float weight = shape * fallOff(difference * scale[p]);
                total[p] += weight;
                square[p] += weight * weight * in.variance[p][from];
                for (int c = 3 * p; c < 3 * p + 3; ++c) {
                    sum[c] += weight * float(in.light[c][from]);
                }
            }
        }
    }
    for (int p = 0; p < kParts; ++p) {
        if (!filters(parts, p)) {
            continue;
        }
        const float share = 1.0f / total[p];
        out.variance[p][at] = square[p] * (share * share);
        for (int c = 3 * p; c < 3 * p + 3; ++c) {
            out.light[c][at] = toPlane(sum[c] * share);
        }
    }
}

}  // namespace

void filterReference(const Job& job, const FilterPlanes& in, const FilterPlanes& out, int pass,
                     int parts, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            filterPixel(job, in, out, pass, parts, x, y);
        }
    }
}

}  // namespace still::denoising
