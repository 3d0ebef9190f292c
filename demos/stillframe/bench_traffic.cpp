#include "demos/stillframe/bench_traffic.h"

#include <algorithm>

namespace still::command {
namespace {

constexpr double kPositionBytes = 12, kIndexBytes = 12;  // per vertex, per triangle
/// Colour 6, depth 4, id 2, normal 4, previous depth 2; and motion, where there is any.
constexpr double kPlaneBytes = 18, kMotionBytes = 4;
/// At the right level of detail, the next pixel's texels lie one to the side.
constexpr double kTexelBytes = 4;
/// Any filter that follows motion: the planes, last frame's depth, normal and id, the history in
/// and out, the picture.
constexpr double kMotionTaaBytes = kPlaneBytes + kMotionBytes + 10 + 2 * 8 + 7;
/// A mean of samples: colour in; sum and count in and out.
constexpr double kStillTaaBytes = 6 + 2 * 10;
constexpr double kOutputBytes = 6 + 3;

struct TilePixels {
    double moving = 0, still = 0, unfinished = 0;  ///< the last of the still ones
};

/// Pixels by what happens in their tiles.
TilePixels countPixels(const FrameResult& result, int sample_cap) {
    TilePixels pixels;
    const GBuffer& g = *result.gbuffer;
    for (size_t i = 0; i < g.tiles.size(); ++i) {
        const int x0 = int(i) % g.tiles_x * kTileSize, y0 = int(i) / g.tiles_x * kTileSize;
        const int x1 = std::min(x0 + kTileSize, g.width());
        const int y1 = std::min(y0 + kTileSize, g.height());
        const double count = double(x1 - x0) * (y1 - y0);
        if (!g.tiles[i].still()) {
            pixels.moving += count;
            continue;
        }
        pixels.still += count;
        for (int y = y0; y < y1 && !result.sample_count.empty(); ++y) {
            const uint8_t* row = result.sample_count.row(y);
            pixels.unfinished += double(std::count_if(
                row + x0, row + x1, [&](uint8_t samples) { return samples < sample_cap; }));
        }
    }
    return pixels;
}

}  // namespace

SceneSize sizeOf(const Scene& scene) {
    SceneSize size;
    size.triangles = double(scene.triangleCount());
    for (const SceneObject& object : scene.objects) {
        size.vertices += scene.meshes[object.mesh].vertexCount();
    }
    return size;
}

StageBytes compulsoryBytes(const SceneSize& scene, const FrameResult& result,
                           const RasterCounters& counters, int sample_cap) {
    if (counters.tiles == 0) {
        return {};  // nothing was drawn
    }
    const TilePixels pixels = countPixels(result, sample_cap);
    const double all = pixels.moving + pixels.still;
    const double shaded = double(counters.pixels_shaded);
    return {scene.vertices * kPositionBytes,
            scene.triangles * kIndexBytes,
            0,
            all * kPlaneBytes + pixels.moving * kMotionBytes + shaded * kTexelBytes,
            0,  // light: rays go where they go
            0,  // denoise: how often a plane is read is a matter of the method
            pixels.moving * kMotionTaaBytes + pixels.unfinished * kStillTaaBytes,
            all * kOutputBytes};
}

}  // namespace still::command
