#include "engine/internal/camera_drift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace still {
namespace {

/// Where the point infinitely far along (x, y, z) is on the screen, pixels from the centre.
std::optional<std::array<double, 2>> farPoint(const glm::dmat4& view_projection, double x, double y,
                                              double z, int width, int height) {
    const auto row = [&](int i) {
        return view_projection[0][i] * x + view_projection[1][i] * y + view_projection[2][i] * z;
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
    const double x = now[0][3], y = now[1][3], z = now[2][3];  // straight ahead
    const auto here = farPoint(now, x, y, z, width, height);
    const auto there = farPoint(then, x, y, z, width, height);
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
