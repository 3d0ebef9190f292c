#include "engine/internal/camera_drift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/internal/tracks.h"

namespace still {
namespace {

/// Where the point (x, y, z), or with w = 0 what lies infinitely far along it, is on the screen,
/// pixels from the centre.
std::optional<std::array<double, 2>> onScreen(const glm::dmat4& view_projection,
                                              const glm::dvec4& p, int width, int height) {
    const auto row = [&](int i) {
        return view_projection[0][i] * p.x + view_projection[1][i] * p.y +
               view_projection[2][i] * p.z + view_projection[3][i] * p.w;
    };
    const double w = row(3);
    if (!(w > 0)) {
        return std::nullopt;
    }
    return std::array{row(0) / w * (0.5 * width), row(1) / w * (-0.5 * height)};
}

}  // namespace

int withinPixel(int64_t offset_fx8) {
    return int((offset_fx8 + 128) & 255) - 128;
}

SampleOffset driftAfter(SampleOffset drift, const CameraState& camera, const CameraState& before,
                        int width, int height) {
    const glm::dmat4& now = camera.view_projection;
    const glm::dmat4& then = before.view_projection;
    if (now == then) {
        return {};
    }
    // Infinitely far straight ahead. A parallel projection has no such place: under it near and far
    // slide alike, and the middle of what it shows stands for both.
    const glm::dvec4 ahead = isParallel(now) ? glm::dvec4(originOf(now), 1)
                                             : glm::dvec4(now[0][3], now[1][3], now[2][3], 0);
    const auto here = onScreen(now, ahead, width, height);
    const auto there = onScreen(then, ahead, width, height);
    if (!here || !there) {
        return drift;
    }
    const auto moved = [&](size_t axis, int old_fx8) {
        constexpr double kFarthest = 1e6;  // pixels
        const double d = std::clamp((*there)[axis] - (*here)[axis], -kFarthest, kFarthest);
        return withinPixel(old_fx8 + int64_t(std::floor(d * 256 + 0.5)));
    };
    return {moved(0, drift.x_fx8), moved(1, drift.y_fx8)};
}

}  // namespace still
