#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "demos/inspect/canvas.h"
#include "demos/inspect/lines.h"
#include "demos/inspect/story_text.h"

namespace still::inspect {
namespace {

constexpr Rgb8 kPaper{24, 24, 28};
constexpr Rgb8 kAxis{80, 80, 90};
constexpr Rgb8 kBox{200, 200, 210};
constexpr Rgb8 kEdge{120, 120, 130};
constexpr Rgb8 kInk{255, 255, 255};
constexpr Rgb8 kCross{255, 70, 60};

enum class Mark { dot, cross, ring, disc, square };

struct Point {
    StoryColour ycocg{};
    Rgb8 colour{};
    Mark mark = Mark::dot;
};

Point pointOf(const StoryColour& rgb, Tone tone, Mark mark) {
    return {toStoryYcocg(rgb), shownColour(rgb, tone), mark};
}

std::vector<Point> pointsOf(const PixelStory& story, Tone tone) {
    std::vector<Point> points;
    if (story.source == PixelSource::gathered) {
        for (const PixelTap& tap : story.taps) {
            points.push_back(
                pointOf(tap.colour, Tone::linear, tap.used == 0 ? Mark::cross : Mark::dot));
        }
        points.push_back(pointOf(story.output, Tone::linear, Mark::square));
        return points;
    }
    for (const StoryColour& colour : story.window) {
        points.push_back(pointOf(colour, tone, Mark::dot));
    }
    if (story.source == PixelSource::blended) {
        const BlendStory& blend = story.blend;
        points.push_back(pointOf(blend.history, tone, Mark::ring));
        points.push_back(pointOf(blend.rectified, tone, Mark::disc));
        StoryColour result{};
        for (size_t c = 0; c < 3; ++c) {
            result[c] = blend.rectified[c] + int(int64_t{blend.sample[c] - blend.rectified[c]} *
                                                 blend.alpha_q15 / 32768);
        }
        points.push_back(pointOf(result, tone, Mark::square));
    } else {
        points.push_back(pointOf(story.output, Tone::linear, Mark::square));
    }
    return points;
}

/// Of small marks; large ones have twice this.
int markRadius(int side) {
    return std::max(1, side / 48);
}

/// One side of the space: a chroma across, luma up, the same scale for both.
struct Side {
    ImageView<Rgb8> out;
    int left, size;
    size_t across;  ///< channel: 1 Co, 2 Cg
    double middle_x, middle_y, scale;

    int x(const StoryColour& c) const {
        return left + int(size / 2.0 + (c[across] - middle_x) * scale);
    }
    int y(const StoryColour& c) const { return int(size / 2.0 - (c[0] - middle_y) * scale); }

    void rectangle(const StoryColour& low, const StoryColour& high) const {
        const int x0 = x(low), x1 = x(high), y0 = y(high), y1 = y(low);
        fillRectangle(out, x0, y0, x1 - x0 + 1, 1, kBox);
        fillRectangle(out, x0, y1, x1 - x0 + 1, 1, kBox);
        fillRectangle(out, x0, y0, 1, y1 - y0 + 1, kBox);
        fillRectangle(out, x1, y0, 1, y1 - y0 + 1, kBox);
    }
    void draw(const Point& point) const {
        const int px = x(point.ycocg), py = y(point.ycocg);
        const int r = markRadius(size);
        for (int dy = -2 * r; dy <= 2 * r; ++dy) {
            for (int dx = -2 * r; dx <= 2 * r; ++dx) {
                if (const auto colour = inkAt(point, dx, dy, r)) {
                    fillRectangle(out, px + dx, py + dy, 1, 1, *colour);
                }
            }
        }
    }
    /// The mark around its middle; dots are filled with their own colour and have a white edge.
    static std::optional<Rgb8> inkAt(const Point& point, int dx, int dy, int r) {
        const int distance2 = dx * dx + dy * dy, large = 2 * r;
        const int widest = std::max(std::abs(dx), std::abs(dy));
        switch (point.mark) {
            case Mark::dot:
                if (distance2 > (r + 1) * (r + 1)) {
                    return std::nullopt;
                }
                return distance2 > r * r ? kEdge : point.colour;
            case Mark::cross:
                return widest <= r && std::abs(dx) == std::abs(dy) ? std::optional(kCross)
                                                                   : std::nullopt;
            case Mark::ring:
                return distance2 > large * large || distance2 < (large - 2) * (large - 2)
                           ? std::nullopt
                           : std::optional(kInk);
            case Mark::disc:
                if (distance2 > large * large) {
                    return std::nullopt;
                }
                return distance2 < (large - 1) * (large - 1) ? point.colour : kInk;
            case Mark::square:
                return widest > r + 1 ? std::nullopt
                                      : std::optional(widest > r ? kInk : point.colour);
        }
        return std::nullopt;
    }
};

struct Extent {
    StoryColour low, high;
    void add(const StoryColour& c) {
        for (size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], c[i]);
            high[i] = std::max(high[i], c[i]);
        }
    }
};

}  // namespace

Image<Rgb8> storyPlot(const PickedStory& story, int side) {
    Image<Rgb8> picture(2 * side, side);
    const ImageView<Rgb8> out = picture.view();
    fillRectangle(out, 0, 0, 2 * side, side, kPaper);
    fillRectangle(out, side, 0, 1, side, kAxis);
    if (!story.taa || story.taa->source == PixelSource::none) {
        return picture;
    }
    const std::vector<Point> points = pointsOf(*story.taa, story.mode.policy.tone);
    const StoryBox& box = story.taa->box_ycocg;
    Extent extent{box.low, box.high};
    for (const Point& point : points) {
        extent.add(point.ycocg);
    }
    int widest = 64;  // a flat window is not blown up to noise
    for (size_t c = 0; c < 3; ++c) {
        widest = std::max(widest, extent.high[c] - extent.low[c]);
    }
    for (const size_t across : {size_t{1}, size_t{2}}) {
        const Side view{.out = out,
                        .left = across == 1 ? 0 : side,
                        .size = side,
                        .across = across,
                        .middle_x = (extent.low[across] + extent.high[across]) / 2.0,
                        .middle_y = (extent.low[0] + extent.high[0]) / 2.0,
                        .scale = (side - 4.0 * (markRadius(side) + 1)) / widest};
        view.rectangle(box.low, box.high);
        for (const Point& point : points) {
            view.draw(point);
        }
    }
    return picture;
}

}  // namespace still::inspect
