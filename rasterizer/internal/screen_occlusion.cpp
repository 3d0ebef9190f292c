#include "rasterizer/internal/screen_occlusion.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "rasterizer/fixed.h"

namespace still::internal {

namespace {

constexpr int kRays = 2, kSteps = 4;
/// Additive recurrence of two dimensions (Roberts 2018), times 2^32: from ray to ray.
constexpr uint32_t kNextX = 0xC13FA9A9u, kNextY = 0x91E10DA5u;
/// And of the length of its steps: golden ratio, times 2^32.
constexpr uint32_t kNextLength = 0x9E3779B9u;

/// Square of the sine of the angle over the surface from which on something hides it.
constexpr float kFlat = 0.01f;

/// From the world to the pixels of a frame and back, in floats: what it decides is rough.
struct Projector {
    MatrixF to_pixels, to_world;
    float offset_x, offset_y;  ///< of the sample in its pixel

    explicit Projector(const FrameView& view) {
        const Matrix pixels =
            toPixels(reverseDepth(fromGlm(view.view_projection)), view.width, view.height);
        to_pixels = toFloat(pixels);
        to_world = toFloat(inverse(pixels));
        offset_x = float(kSubpixelHalf + view.jitter_x_fx8) / float(kSubpixelOne);
        offset_y = float(kSubpixelHalf + view.jitter_y_fx8) / float(kSubpixelOne);
    }
    static float row(const MatrixF& m, int r, float x, float y, float z) {
        return (m.m[r][0] * x + m.m[r][1] * y) + (m.m[r][2] * z + m.m[r][3]);
    }
    Float3 placeOf(const GBuffer& gbuffer, int x, int y) const {
        const float px = float(x) + offset_x, py = float(y) + offset_y;
        const float z = std::bit_cast<float>(gbuffer.depth.at(x, y));
        const float inverse_w = 1.0f / row(to_world, 3, px, py, z);
        return {row(to_world, 0, px, py, z) * inverse_w, row(to_world, 1, px, py, z) * inverse_w,
                row(to_world, 2, px, py, z) * inverse_w};
    }
};

/// Whether what is seen at a place above a surface point hides it: something that is near that
/// point, and over its plane by more than the depths of neighbouring pixels can feign.
bool hides(const GBuffer& gbuffer, const Projector& view, const Float3& place,
           const LitPoint& point, float distance) {
    const float w = Projector::row(view.to_pixels, 3, place.x, place.y, place.z);
    if (!(w > 1e-20f)) {
        return false;
    }
    const float inverse_w = 1.0f / w;
    const float px = Projector::row(view.to_pixels, 0, place.x, place.y, place.z) * inverse_w;
    const float py = Projector::row(view.to_pixels, 1, place.x, place.y, place.z) * inverse_w;
    if (!(px >= 0.0f && px < float(gbuffer.width()) && py >= 0.0f &&
          py < float(gbuffer.height()))) {
        return false;
    }
    const int x = int(px), y = int(py);
    const float depth = Projector::row(view.to_pixels, 2, place.x, place.y, place.z) * inverse_w;
    if (!(std::bit_cast<float>(gbuffer.depth.at(x, y)) > depth)) {
        return false;
    }
    const Float3 seen = view.placeOf(gbuffer, x, y);
    const Float3 way{seen.x - point.origin.x, seen.y - point.origin.y, seen.z - point.origin.z};
    const float above = dot(way, point.normal), length2 = dot(way, way);
    return length2 < distance * distance && above > 0.0f && above * above > kFlat * length2;
}

/// Looked for along the way at lengths that are halved.
bool blocked(const GBuffer& gbuffer, const Projector& view, const LitPoint& point,
             const Float3& direction, float end) {
    float length = end;
    for (int step = 0; step < kSteps; ++step) {
        const Float3 place{point.origin.x + direction.x * length,
                           point.origin.y + direction.y * length,
                           point.origin.z + direction.z * length};
        if (hides(gbuffer, view, place, point, end)) {
            return true;
        }
        length = length * 0.5f;
    }
    return false;
}

}  // namespace

void ScreenOcclusion::find(const GBuffer& gbuffer, const FrameView& view, float distance,
                           const PixelNumbers& numbers, Workers& workers) {
    const int width = gbuffer.width(), height = gbuffer.height();
    open_.resize((width + 1) / 2, (height + 1) / 2);
    offset_x_ = int(view.sample & 1u);
    offset_y_ = int((view.sample ^ view.sample >> 1) & 1u);
    const Projector projector(view);
    const PixelRays rays(view);
    const SampleNumbers sample = numbersOfSample(view.sample);
    workers.parallelFor(open_.height(), 4, [&](int begin, int end, int) {
        for (int row = begin; row < end; ++row) {
            for (int column = 0; column < open_.width(); ++column) {
                const int x = std::min(2 * column + offset_x_, width - 1);
                const int y = std::min(2 * row + offset_y_, height - 1);
                if ((gbuffer.id.at(x, y) & kSurfaceMask) == 0) {
                    open_.at(column, row) = kRays;
                    continue;
                }
                const NormalVector n = decodeOctahedral(gbuffer.normal.at(x, y));
                const LitPoint point =
                    rays.pointAt(x, y, std::bit_cast<float>(gbuffer.depth.at(x, y)),
                                 normalized({n.x, n.y, n.z}));
                const PixelNumbers::Tile tile = numbers.tileOf(x, y, sample);
                RandomPair random = tile.at(x, y, kRandomHemisphere);
                uint32_t length = tile.at(x, y, kRandomHoles).x;
                int open = kRays;
                for (int ray = 0; ray < kRays; ++ray) {
                    const Float3 direction = drawHemisphere(point.normal, random);
                    const float end = distance * (0.5f + 0.5f * toUnit(length));
                    open -= blocked(gbuffer, projector, point, direction, end) ? 1 : 0;
                    random = {random.x + kNextX, random.y + kNextY};
                    length += kNextLength;
                }
                open_.at(column, row) = uint8_t(open);
            }
        }
    });
}

float ScreenOcclusion::openAt(const GBuffer& gbuffer, int x, int y) const {
    const int surface = gbuffer.id.at(x, y) & kSurfaceMask;
    // The four pixels that were looked at around this one, the nearest first.
    const int column = std::min((x + 1 - offset_x_) / 2, open_.width() - 1);
    const int row = std::min((y + 1 - offset_y_) / 2, open_.height() - 1);
    int sum = 0, weights = 0;
    for (int dy = 0; dy < 2; ++dy) {
        for (int dx = 0; dx < 2; ++dx) {
            const int c = std::max(column - dx, 0), r = std::max(row - dy, 0);
            const int at_x = std::min(2 * c + offset_x_, gbuffer.width() - 1);
            const int at_y = std::min(2 * r + offset_y_, gbuffer.height() - 1);
            const int far_x = std::min(std::abs(at_x - x), 2);
            const int far_y = std::min(std::abs(at_y - y), 2);
            const bool same = (gbuffer.id.at(at_x, at_y) & kSurfaceMask) == surface;
            const int weight = same ? (2 - far_x) * (2 - far_y) : 0;
            sum += weight * open_.at(c, r);
            weights += weight;
        }
    }
    return weights > 0 ? float(sum) / float(weights * kRays) : 1.0f;
}

}  // namespace still::internal
