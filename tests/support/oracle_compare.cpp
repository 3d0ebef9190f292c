#include "tests/support/oracle_compare.h"

#include <algorithm>

namespace still::test {
namespace {

/// Corners made by clipping are snapped too, so an edge between them may lie this far off.
constexpr double kClippedEdgePx = 1.0 / 128;
/// Depth bound: two float roundings per vertex and those of the plane.
constexpr double kDepthBound = 1e-6;

bool clippedHere(const oracle::Frame& frame, const oracle::Triangle& triangle, int x, int y) {
    return triangle.clipped && frame.nearCreatedEdge(triangle, x, y, kClippedEdgePx);
}

/// Whether one of the surface's triangles may be seen at the pixel.
bool mayBeSeen(const oracle::Frame& frame, int surface, const oracle::Pixel& truth, int x, int y) {
    const auto& all = frame.triangles();
    return std::any_of(all.begin(), all.end(), [&](const oracle::Triangle& t) {
        return t.surface == surface &&
               (clippedHere(frame, t, x, y) ||
                (frame.covers(t, x, y) && truth.depth - frame.depthAt(t, x, y) < kDepthBound));
    });
}

bool agrees(const oracle::Frame& frame, int seen, int x, int y) {
    const oracle::Pixel truth = frame.visible(x, y);
    if (truth.triangle < 0) {
        return seen == 0 || mayBeSeen(frame, seen, truth, x, y);
    }
    const oracle::Triangle& triangle = frame.triangles()[size_t(truth.triangle)];
    return seen == triangle.surface || clippedHere(frame, triangle, x, y) ||
           (seen > 0 && mayBeSeen(frame, seen, truth, x, y));
}

}  // namespace

std::string differenceToOracle(const DrawList& list, const FrameView& view, const GBuffer& fast) {
    const oracle::Frame frame(list, view);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const int seen = int(fast.id.at(x, y) & kSurfaceMask);
            if (!agrees(frame, seen, x, y)) {
                const int triangle = frame.visible(x, y).triangle;
                const int wanted =
                    triangle < 0 ? 0 : int(frame.triangles()[size_t(triangle)].surface);
                return "pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                       ") shows surface " + std::to_string(seen) + ", the oracle sees " +
                       std::to_string(wanted);
            }
        }
    }
    return {};
}

}  // namespace still::test
