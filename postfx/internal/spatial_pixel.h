#pragma once
// One pixel of the spatial filter near an edge. Sources: A. Reshetov, "Morphological antialiasing"
// (2009): the shapes of edges and the straight lines through them; J. Jimenez et al., "SMAA:
// Enhanced subpixel morphological antialiasing" (2012): blending with the neighbour across the
// edge. Here the edges are known and not guessed from colours, and samples may lie off the centres.
//
//   a Z:  ____|▔▔▔▔      an L: ____|▔▔▔▔        a U: ▔▔|______|▔▔
//   the line runs from   half way up the jog       half way up to the
//   jog to jog           to the middle of the run  middle and up again

#include <array>

#include "postfx/internal/spatial_rules.h"
#include "postfx/spatial.h"

namespace still::spatial {

/// Edges read off the plane that the first pass made.
struct PlaneEdges {
    ImageView<const uint8_t> plane;

    bool right(int x, int y) const { return (plane.row(y)[x] & kEdgeRight) != 0; }
    bool below(int x, int y) const { return (plane.row(y)[x] & kEdgeBelow) != 0; }
};

/// Edges found when asked for. `x`, `y` and the neighbour right of it or below are inside.
struct LiveEdges {
    const SpatialInput& input;

    bool right(int x, int y) const { return between(x, y, 1, 0); }
    bool below(int x, int y) const { return between(x, y, 0, 1); }

  private:
    bool sameSurface(int x, int y, int dx, int dy) const {
        return ((input.id.row(y)[x] ^ input.id.row(y + dy)[x + dx]) & kSurfaceMask) == 0;
    }
    int bend(int x, int y, int dx, int dy) const {
        return normalDistance(input.normal.row(y)[x], input.normal.row(y + dy)[x + dx]);
    }
    /// The next step in a direction is much smaller than `jump`, or leaves the surface or picture.
    bool isSmooth(int x, int y, int dx, int dy, int jump) const {
        const bool inside =
            x + dx >= 0 && x + dx < input.id.width && y + dy >= 0 && y + dy < input.id.height;
        return !inside || !sameSurface(x, y, dx, dy) || bend(x, y, dx, dy) * kCreaseRatio <= jump;
    }
    bool between(int x, int y, int dx, int dy) const {
        if (!sameSurface(x, y, dx, dy)) {
            return true;
        }
        if (input.normal.empty()) {
            return false;
        }
        const int jump = bend(x, y, dx, dy);
        return jump > kCrease && isSmooth(x, y, -dx, -dy, jump) &&
               isSmooth(x + dx, y + dy, dx, dy, jump);
    }
};

/// The picture with its edges; outside the border pixels repeat.
template <class Edges>
class Picture {
  public:
    Picture(const SpatialInput& input, Edges edges)
        : input_(input),
          edges_(edges),
          width_(input.colour.red.width),
          height_(input.colour.red.height) {}

    const SpatialInput& input() const { return input_; }
    int width() const { return width_; }
    int height() const { return height_; }
    int column(int x) const { return std::clamp(x, 0, width_ - 1); }
    int row(int y) const { return std::clamp(y, 0, height_ - 1); }
    bool right(int x, int y) const { return x >= 0 && x + 1 < width_ && edges_.right(x, row(y)); }
    bool below(int x, int y) const {
        return y >= 0 && y + 1 < height_ && edges_.below(column(x), y);
    }

  private:
    const SpatialInput& input_;
    Edges edges_;
    int width_, height_;
};

/// The same picture seen along rows or, with x and y swapped, along columns.
template <class Edges, bool kSwapped>
struct Along {
    const Picture<Edges>& picture;

    int length() const { return kSwapped ? picture.height() : picture.width(); }
    /// Edge between (u, v) and (u, v + 1): the one that is followed.
    bool edge(int u, int v) const { return kSwapped ? picture.right(v, u) : picture.below(u, v); }
    /// Edge between (u, v) and (u + 1, v): a jog that ends it.
    bool jog(int u, int v) const { return kSwapped ? picture.below(v, u) : picture.right(u, v); }
};

/// Half of the edge around a pixel: how many more pixels it goes on, and how it ends.
struct End {
    int distance = 0;
    int height_fx8 = 0;  ///< of the line there, towards the side v: half a pixel, none, or minus
};

/// Follows the edge between rows v and v + 1 from u in direction `step` (±1).
template <class View>
End findEnd(const View& view, int u, int v, int step) {
    End end;
    for (; end.distance < kSearch; ++end.distance) {
        const int at = u + step * end.distance;
        const int border = step > 0 ? at : at - 1;
        if (border < 0 || border + 1 >= view.length()) {
            return end;
        }
        const bool near_jog = view.jog(border, v), far_jog = view.jog(border, v + 1);
        if (near_jog || far_jog || !view.edge(at + step, v)) {
            // A jog of two pixels or more is a corner, which a line through its middle would cut.
            const bool corner = view.jog(border, near_jog ? v - 1 : v + 2);
            end.height_fx8 = (corner ? 32 : 128) * (int(near_jog) - int(far_jog));
            return end;
        }
    }
    return end;
}

/// Height of the line through an edge of `length` pixels at `t_fx8` from its left end.
inline int lineHeight(int left, int right, int length, int t_fx8) {
    const int whole_fx8 = length * 256;
    if (left * right < 0) {
        return left + floorDiv((right - left) * t_fx8, whole_fx8);
    }
    const int from_left = std::max(whole_fx8 - 2 * t_fx8, 0);
    const int from_right = std::max(2 * t_fx8 - whole_fx8, 0);
    return floorDiv(left * from_left + right * from_right, whole_fx8);
}

/// The edge bits of a pixel, see spatial_rules.h.
inline uint8_t edgeMarks(const Picture<LiveEdges>& picture, int x, int y) {
    return uint8_t((picture.right(x, y) ? kEdgeRight : 0) | (picture.below(x, y) ? kEdgeBelow : 0));
}

/// What the two pixels of an edge take of each other, in 1/1024, and the edge's length in pixels;
/// length 0: there is no edge.
struct Exchange {
    int near_q10 = 0, far_q10 = 0, length = 0;
};

/// The edge between (u, v) and (u, v + 1), samples lying `along_fx8`, `across_fx8` off the centres.
template <class View>
Exchange exchangeAt(const View& view, int u, int v, int along_fx8, int across_fx8) {
    if (!view.edge(u, v)) {
        return {};
    }
    const End left = findEnd(view, u, v, -1), right = findEnd(view, u, v, +1);
    Exchange exchange;
    exchange.length = left.distance + right.distance + 1;
    constexpr int kSteps = 4;  // midpoints: exact for straight pieces
    for (int i = 0; i < kSteps; ++i) {
        const int t_fx8 = left.distance * 256 - along_fx8 + 32 + 64 * i;
        const int height = lineHeight(left.height_fx8, right.height_fx8, exchange.length,
                                      std::clamp(t_fx8, 0, exchange.length * 256));
        const int covered = height - across_fx8;
        exchange.near_q10 += std::max(covered, 0);
        exchange.far_q10 += std::max(-covered, 0);
    }
    return exchange;
}

/// Shares in 1/1024 of the neighbours below, above, right and left.
struct Shares {
    std::array<int, 4> q10{};
    int total_q10 = 0;
    int length = 0;  ///< of the longest edge
};

template <class Edges>
Shares edgeShares(const Picture<Edges>& picture, int x, int y) {
    const int jx = picture.input().jitter_x_fx8, jy = picture.input().jitter_y_fx8;
    const Along<Edges, false> rows{picture};
    const Along<Edges, true> columns{picture};
    const Exchange below = exchangeAt(rows, x, y, jx, jy);
    const Exchange above = exchangeAt(rows, x, y - 1, jx, jy);
    const Exchange right = exchangeAt(columns, y, x, jy, jx);
    const Exchange left = exchangeAt(columns, y, x - 1, jy, jx);
    Shares shares;
    shares.q10 = {below.near_q10, above.far_q10, right.near_q10, left.far_q10};
    shares.length = std::max({below.length, above.length, right.length, left.length});
    for (int share : shares.q10) {
        shares.total_q10 += share;
    }
    if (shares.total_q10 > 1024) {
        for (int& share : shares.q10) {
            share = share * 1024 / shares.total_q10;
        }
        shares.total_q10 = shares.q10[0] + shares.q10[1] + shares.q10[2] + shares.q10[3];
    }
    return shares;
}

/// The edges inside a 3×3 window.
struct Window {
    std::array<bool, 9> same{};  ///< reached from the centre without crossing an edge
    int edges = 0;               ///< of 12
};

template <class Edges>
Window windowAt(const Picture<Edges>& picture, int x, int y) {
    bool right[3][2], below[2][3];
    Window window;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 2; ++i) {
            right[j][i] = picture.right(x - 1 + i, y - 1 + j);
            below[i][j] = picture.below(x - 1 + j, y - 1 + i);
            window.edges += int(right[j][i]) + int(below[i][j]);
        }
    }
    const auto corner = [&](int i, int j) {  // i, j: 0 or 1 = left or right, above or below
        return (!right[1][i] && !below[j][2 * i]) || (!below[j][1] && !right[2 * j][i]);
    };
    window.same = {corner(0, 0), !below[0][1], corner(1, 0), !right[1][0], true,
                   !right[1][1], corner(0, 1), !below[1][1], corner(1, 1)};
    return window;
}

/// Weighted mean of the surroundings regardless of surfaces, leaning towards the pixel's centre:
/// for details that are too small for a line through their edges to mean anything. at(dx, dy) reads
/// a channel. The weights follow those that least squares find for chain link and thin wires; what
/// remains of 1024 is the centre's.
template <class At>
int crowdMean(At&& at, int jitter_x_fx8, int jitter_y_fx8) {
    constexpr int kCorner_q10 = 61, kSide_q10 = 82, kFarSide_q10 = -20, kFarCorner_q10 = 10;
    const int e = at(0, 0);
    const auto cross = [&](int d) { return at(-d, 0) + at(d, 0) + at(0, -d) + at(0, d) - 4 * e; };
    const auto corners = [&](int d) {
        return at(-d, -d) + at(d, -d) + at(-d, d) + at(d, d) - 4 * e;
    };
    const auto lean = [](int d_fx8) { return roundShift(77 * d_fx8, 6); };  // 0.3 d
    const int sum = kSide_q10 * cross(1) + kCorner_q10 * corners(1) + kFarSide_q10 * cross(2) +
                    kFarCorner_q10 * corners(2) + lean(-jitter_x_fx8) * (at(1, 0) - at(-1, 0)) +
                    lean(-jitter_y_fx8) * (at(0, 1) - at(0, -1));
    return std::clamp(e + roundShift(sum, 10), 0, 65535);
}

/// How far the crowd's mean replaces the lines, in 1/16: where edges are crowded (more than 5 of
/// the 12 in the window) or shorter than 5 pixels.
inline int crowding(const Window& window, const Shares& shares) {
    const int shortness = shares.length == 0 ? 8 : (5 - shares.length) * 5;
    return std::clamp(std::max((window.edges - 4) * 4, shortness), 0, 16);
}

/// A channel around a pixel, up to two pixels away.
class Surroundings {
  public:
    template <class Edges>
    Surroundings(const Picture<Edges>& picture, int x, int y) {
        for (int i = 0; i < 5; ++i) {
            columns_[size_t(i)] = picture.column(x - 2 + i);
            rows_[size_t(i)] = picture.row(y - 2 + i);
        }
    }
    int operator()(ImageView<const uint16_t> plane, int dx, int dy) const {
        return plane.row(rows_[size_t(dy + 2)])[columns_[size_t(dx + 2)]];
    }

  private:
    std::array<int, 5> columns_, rows_;
};

/// The surface's own mean, and of the neighbours across the edges what the lines give.
template <class At>
int linedMean(At&& at, const Window& window, const Shares& shares, Taps across, Taps down) {
    int own[9];
    for (int i = 0; i < 9; ++i) {
        own[i] = window.same[size_t(i)] ? at(i % 3 - 1, i / 3 - 1) : at(0, 0);
    }
    const int sum = pixelMean(own, across, down) * (1024 - shares.total_q10) +
                    at(0, 1) * shares.q10[0] + at(0, -1) * shares.q10[1] +
                    at(1, 0) * shares.q10[2] + at(-1, 0) * shares.q10[3];
    return roundShift(sum, 10);
}

/// The filtered pixel.
template <class Edges>
void filteredPixel(const Picture<Edges>& picture, int x, int y, int rgb[3]) {
    const SpatialInput& input = picture.input();
    const Window window = windowAt(picture, x, y);
    const Taps across = pixelTaps(input.jitter_x_fx8), down = pixelTaps(input.jitter_y_fx8);
    const Shares shares = window.edges > 0 ? edgeShares(picture, x, y) : Shares{};
    const int crowded = window.edges > 0 ? crowding(window, shares) : 0;
    const Surroundings around(picture, x, y);
    for (const ImageView<const uint16_t>& plane :
         {input.colour.red, input.colour.green, input.colour.blue}) {
        const auto at = [&](int dx, int dy) { return around(plane, dx, dy); };
        int value = crowded < 16 ? linedMean(at, window, shares, across, down) : 0;
        if (crowded > 0) {
            const int mean = crowdMean(at, input.jitter_x_fx8, input.jitter_y_fx8);
            value += roundShift((mean - value) * crowded, 4);
        }
        *rgb++ = value;
    }
}

}  // namespace still::spatial
