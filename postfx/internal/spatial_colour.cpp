#include "postfx/internal/spatial_colour.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "rasterizer/draw_list.h"
#include "rasterizer/fixed.h"

namespace still::spatial {
namespace {

constexpr int kLeastContrast = 8;  ///< of 255; darker and fainter edges are not seen
constexpr int kReach = 16;         ///< pixels searched along an edge, each way

/// √(luma · 16), rounded down; 4096 → 255.
constexpr std::array<uint8_t, kColourOne + 1> makeRoots() {
    std::array<uint8_t, kColourOne + 1> roots{};
    int root = 0;
    for (int v = 0; v <= kColourOne; ++v) {
        while (root < 255 && (root + 1) * (root + 1) <= v * 16) {
            ++root;
        }
        roots[size_t(v)] = uint8_t(root);
    }
    return roots;
}
constexpr std::array<uint8_t, kColourOne + 1> kRoots = makeRoots();

/// Brightness around a pixel; outside the border pixels repeat.
class Brightness {
  public:
    explicit Brightness(ImageView<const uint8_t> plane) : plane_(plane) {}
    int at(int x, int y) const {
        return plane_.row(std::clamp(y, 0, plane_.height - 1))[std::clamp(x, 0, plane_.width - 1)];
    }

  private:
    ImageView<const uint8_t> plane_;
};

struct Window {
    int nw, n, ne, w, centre, e, sw, s, se;

    int range() const { return std::max({n, w, centre, e, s}) - std::min({n, w, centre, e, s}); }
};

Window windowAt(const Brightness& light, int x, int y) {
    return {light.at(x - 1, y - 1), light.at(x, y - 1), light.at(x + 1, y - 1),
            light.at(x - 1, y),     light.at(x, y),     light.at(x + 1, y),
            light.at(x - 1, y + 1), light.at(x, y + 1), light.at(x + 1, y + 1)};
}

/// The neighbour to blend with, and how much of it.
struct Blend {
    int dx = 0, dy = 0;
    int share_q10 = 0;
};

bool isHorizontal(const Window& p) {
    const int across_rows = std::abs(p.nw + p.sw - 2 * p.w) +
                            2 * std::abs(p.n + p.s - 2 * p.centre) +
                            std::abs(p.ne + p.se - 2 * p.e);
    const int across_columns = std::abs(p.nw + p.ne - 2 * p.n) +
                               2 * std::abs(p.w + p.e - 2 * p.centre) +
                               std::abs(p.sw + p.se - 2 * p.s);
    return across_rows >= across_columns;
}

/// For pixels that stand out alone: 3/4 of smoothstep² of the share of the contrast by which the
/// pixel differs from its neighbourhood.
int pointShare(const Window& p) {
    const int sides = p.n + p.s + p.w + p.e, corners = p.nw + p.ne + p.sw + p.se;
    const int difference = std::abs(2 * sides + corners - 12 * p.centre);
    const int s = std::min(difference * 1024 / (12 * p.range()), 1024);
    const int smooth = (s * s >> 10) * (3 * 1024 - 2 * s) >> 10;
    return (smooth * smooth >> 10) * 3 / 4;
}

/// Follows the edge both ways to where the brightness across it changes; near its end on this side
/// the other side takes up to half of the pixel.
int edgeShare(const Brightness& light, int x, int y, Blend side, int centre) {
    const int along_x = side.dy != 0 ? 1 : 0, along_y = 1 - along_x;
    const auto pair = [&](int d) {
        const int px = x + d * along_x, py = y + d * along_y;
        return light.at(px, py) + light.at(px + side.dx, py + side.dy);
    };
    const int here = pair(0);
    const int step = std::abs(here - 2 * centre);
    const auto walk = [&](int direction, int& change) {
        int distance = 1;
        for (;; ++distance) {
            change = pair(direction * distance) - here;
            if (2 * std::abs(change) >= step || distance == kReach) {
                return distance;
            }
        }
    };
    int change_before = 0, change_after = 0;
    const int before = walk(-1, change_before), after = walk(+1, change_after);
    const int change = before < after ? change_before : change_after;
    if ((change < 0) == (2 * centre - here < 0)) {
        return 0;  // the line bends the other way here: its other pixels are blended
    }
    return 512 - std::min(before, after) * 1024 / (before + after);
}

Blend blendAt(const Brightness& light, const Window& p, int x, int y) {
    Blend blend;
    const bool horizontal = isHorizontal(p);
    const int before = std::abs((horizontal ? p.n : p.w) - p.centre);
    const int after = std::abs((horizontal ? p.s : p.e) - p.centre);
    const int side = before >= after ? -1 : 1;
    blend.dx = horizontal ? 0 : side;
    blend.dy = horizontal ? side : 0;
    blend.share_q10 = std::max(edgeShare(light, x, y, blend, p.centre), pointShare(p));
    return blend;
}

/// Marks the pixels that stand out of their four neighbours. Plain enough for compilers to make
/// vectors of it.
void markContrasts(ImageView<const uint8_t> brightness, int y, uint8_t* marks) {
    const int last = brightness.width - 1;
    const uint8_t* here = brightness.row(y);
    const uint8_t* above = brightness.row(std::max(y - 1, 0));
    const uint8_t* below = brightness.row(std::min(y + 1, brightness.height - 1));
    const auto stands = [&](int left, int x, int right) {
        const uint8_t most = std::max(std::max(std::max(here[left], here[right]), here[x]),
                                      std::max(above[x], below[x]));
        const uint8_t least = std::min(std::min(std::min(here[left], here[right]), here[x]),
                                       std::min(above[x], below[x]));
        return uint8_t(uint8_t(most - least) >= std::max<uint8_t>(kLeastContrast, most >> 3));
    };
    for (int x = 1; x < last; ++x) {
        marks[x] = stands(x - 1, x, x + 1);
    }
    marks[0] = stands(0, 0, std::min(1, last));
    marks[last] = stands(std::max(last - 1, 0), last, last);
}

}  // namespace

void brightnessRow(const ColourPlanes& colour, int y, uint8_t* brightness) {
    const uint16_t *red = colour.red.row(y), *green = colour.green.row(y),
                   *blue = colour.blue.row(y);
    for (int x = 0; x < colour.red.width; ++x) {
        const int luma = (54 * red[x] + 183 * green[x] + 19 * blue[x]) >> 8;
        brightness[x] = kRoots[size_t(std::min<int>(luma, kColourOne))];
    }
}

void colourRow(const ColourPlanes& colour, ImageView<const uint8_t> brightness, int y,
               const ColourTargets& out) {
    const ImageView<const uint16_t> from[3] = {colour.red, colour.green, colour.blue};
    const ImageView<uint16_t> to[3] = {out.red, out.green, out.blue};
    const int width = brightness.width, height = brightness.height;
    for (int c = 0; c < 3; ++c) {
        std::memcpy(to[c].row(y), from[c].row(y), size_t(width) * sizeof(uint16_t));
    }
    std::array<uint8_t, kMaxTargetSize> marks;
    markContrasts(brightness, y, marks.data());
    const Brightness light(brightness);
    for (int x = 0; x < width; ++x) {
        if (marks[size_t(x)] == 0) {
            continue;
        }
        const Blend blend = blendAt(light, windowAt(light, x, y), x, y);
        const int other_x = std::clamp(x + blend.dx, 0, width - 1);
        const int other_y = std::clamp(y + blend.dy, 0, height - 1);
        for (int c = 0; c < 3; ++c) {
            const int centre = from[c].row(y)[x], other = from[c].row(other_y)[other_x];
            to[c].row(y)[x] = uint16_t(centre + roundShift((other - centre) * blend.share_q10, 10));
        }
    }
}

}  // namespace still::spatial
