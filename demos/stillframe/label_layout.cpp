#include "demos/stillframe/label_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace still::command {
namespace {

constexpr double kMarker = 6;  ///< half the side of what a point covers
constexpr double kGap = 3;
constexpr double kFirstRadius = 10, kLastRadius = 400, kRadiusStep = 4;
constexpr int kDirections = 24;
constexpr double kLeaderFrom = 9;

Box around(const LabelledPoint& point) {
    return {point.x - kMarker, point.y - kMarker, 2 * kMarker, 2 * kMarker};
}

/// A box whose side or corner that faces the point is `radius` away from it.
Box boxAt(const LabelledPoint& point, double radius, int direction) {
    const double turn = 2 * std::numbers::pi * direction / kDirections;
    const double cx = std::cos(turn);
    const double cy = -std::sin(turn);
    return {point.x + cx * (radius + point.width / 2) - point.width / 2,
            point.y + cy * (radius + point.height / 2) - point.height / 2, point.width,
            point.height};
}

class Layout {
  public:
    Layout(std::span<const LabelledPoint> points, std::span<const Box> obstacles, const Box& area)
        : points_(points), obstacles_(obstacles), area_(area) {}

    /// A line that crosses other labels is better than a label that covers something.
    PlacedLabel place(size_t index) {
        auto label = search(index, true);
        if (!label) {
            label = search(index, false);
        }
        placed_.push_back(
            label.value_or(labelAt(points_[index], boxAt(points_[index], kFirstRadius, 0))));
        return placed_.back();
    }

  private:
    std::optional<PlacedLabel> search(size_t index, bool free_leader) const {
        const LabelledPoint& point = points_[index];
        for (double radius = kFirstRadius; radius <= kLastRadius; radius += kRadiusStep) {
            for (int direction = 0; direction < kDirections; ++direction) {
                const PlacedLabel label = labelAt(point, boxAt(point, radius, direction));
                if (isFree(label.box) && (!free_leader || leaderIsFree(index, label))) {
                    return label;
                }
            }
        }
        return std::nullopt;
    }
    static PlacedLabel labelAt(const LabelledPoint& point, const Box& box) {
        PlacedLabel label{box, false, 0, 0};
        label.leader_x = std::clamp(point.x, box.x, box.x + box.width);
        label.leader_y = std::clamp(point.y, box.y, box.y + box.height);
        label.leader = std::hypot(label.leader_x - point.x, label.leader_y - point.y) > kLeaderFrom;
        return label;
    }
    bool isFree(const Box& box) const {
        const Box grown{box.x - kGap, box.y - kGap / 2, box.width + 2 * kGap, box.height + kGap};
        return area_.contains(box) &&
               std::none_of(points_.begin(), points_.end(),
                            [&](const LabelledPoint& p) { return grown.overlaps(around(p)); }) &&
               std::none_of(placed_.begin(), placed_.end(),
                            [&](const PlacedLabel& p) { return grown.overlaps(p.box); }) &&
               std::none_of(obstacles_.begin(), obstacles_.end(),
                            [&](const Box& other) { return grown.overlaps(other); });
    }
    /// The line passes neither labels nor other points.
    bool leaderIsFree(size_t index, const PlacedLabel& label) const {
        constexpr int kSteps = 24;
        const LabelledPoint& from = points_[index];
        for (int i = 1; label.leader && i < kSteps; ++i) {
            const double t = double(i) / kSteps;
            const Box dot{from.x + (label.leader_x - from.x) * t,
                          from.y + (label.leader_y - from.y) * t, 0.1, 0.1};
            for (const PlacedLabel& other : placed_) {
                if (dot.overlaps(other.box)) {
                    return false;
                }
            }
        }
        return true;
    }

    std::span<const LabelledPoint> points_;
    std::span<const Box> obstacles_;
    Box area_;
    std::vector<PlacedLabel> placed_;
};

}  // namespace

bool Box::overlaps(const Box& other) const {
    return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
           other.y < y + height;
}

bool Box::contains(const Box& other) const {
    return other.x >= x && other.y >= y && other.x + other.width <= x + width &&
           other.y + other.height <= y + height;
}

std::vector<PlacedLabel> placeLabels(std::span<const LabelledPoint> points,
                                     std::span<const Box> obstacles, const Box& area) {
    Layout layout(points, obstacles, area);
    std::vector<PlacedLabel> labels;
    for (size_t i = 0; i < points.size(); ++i) {
        labels.push_back(layout.place(i));
    }
    return labels;
}

}  // namespace still::command
