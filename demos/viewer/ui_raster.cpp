// Draw list → triangles or axis-aligned rectangles → spans → blended pixels.
//
// Nearly all of a UI are rectangles of one colour and glyphs, which are rectangles of the atlas;
// both are recognised and drawn without edges. Everything else goes through the edge functions.
// Either way gives the same pixels: values inside are exact fractions, rounded only at the end.

#include "demos/viewer/ui_raster.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace still::viewer {
namespace {

constexpr int kPositionBits = 6;
constexpr int64_t kOne_fx6 = int64_t{1} << kPositionBits;
constexpr int64_t kHalf_fx6 = kOne_fx6 / 2;
constexpr float kPositionLimit = 16384;
constexpr int kTexelBits = 8;
constexpr float kTexelLimit = 4096;

/// A corner as it is drawn. Positions reach ±2^20, so edge values 2^42, and texels 2^20: sums of
/// their products stay within 63 bits.
struct Corner {
    int64_t x_fx6 = 0, y_fx6 = 0;
    int64_t u_fx8 = 0, v_fx8 = 0;   ///< in texels
    std::array<int64_t, 4> rgba{};  ///< 0 … 255
};

struct Span {
    int begin = 0, end = 0;
};

/// Pixels whose centre lies in [begin, end).
Span centresWithin(int64_t begin_fx6, int64_t end_fx6) {
    const auto first = [](int64_t at_fx6) {
        return int((at_fx6 + kHalf_fx6 - 1) >> kPositionBits);
    };
    return {first(begin_fx6), first(end_fx6)};
}

Span intersection(Span a, Span b) {
    return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

int64_t centre_fx6(int pixel) {
    return int64_t{pixel} * kOne_fx6 + kHalf_fx6;
}

/// a · b / 255, rounded.
uint32_t times(uint32_t a, uint32_t b) {
    return (a * b + 127) / 255;
}

Xrgb8 packed(uint32_t r, uint32_t g, uint32_t b) {
    return r << 16 | g << 8 | b;
}

/// Two channels at once in the halves of a word: (x + 128 + ((x + 128) >> 8)) >> 8 is x / 255
/// rounded for x ≤ 255 · 255, and no half runs over.
uint32_t halvesOver255(uint32_t x) {
    x += 0x00800080;
    return ((x + (x >> 8 & 0x00ff00ff)) >> 8) & 0x00ff00ff;
}

/// One colour with one opacity.
struct Ink {
    Xrgb8 colour = 0;
    uint32_t alpha = 0;

    Xrgb8 over(Xrgb8 below) const {
        const uint32_t rest = 255 - alpha;
        const uint32_t rb = halvesOver255((below & 0xff00ff) * rest + (colour & 0xff00ff) * alpha);
        const uint32_t g = halvesOver255((below >> 8 & 0xff) * rest + (colour >> 8 & 0xff) * alpha);
        return rb | g << 8;
    }
};

void fill(Xrgb8* row, Span span, Ink ink) {
    if (ink.alpha == 255) {
        std::fill(row + span.begin, row + span.end, ink.colour);
        return;
    }
    for (int x = span.begin; x < span.end; ++x) {
        row[x] = ink.over(row[x]);
    }
}

/// a·x + b·y + c in 1/64 pixels squared: positive inside.
struct Edge {
    int64_t per_x = 0, per_y = 0, constant = 0;
    bool owns = false;  ///< a top or a left edge, on which pixels are inside

    Edge() = default;
    /// The inside lies to the right of a → b, y pointing down.
    Edge(const Corner& a, const Corner& b)
        : per_x(a.y_fx6 - b.y_fx6), per_y(b.x_fx6 - a.x_fx6), owns(per_x > 0) {
        owns |= per_x == 0 && per_y > 0;
        constant = -(per_x * a.x_fx6 + per_y * a.y_fx6);
    }
    int64_t at(int64_t x_fx6, int64_t y_fx6) const {
        return per_x * x_fx6 + per_y * y_fx6 + constant;
    }

    /// Pixels of a row that are inside this edge.
    Span inside(int y) const {
        constexpr int kAll = 1 << 20;
        const auto pixel = [](int64_t x) { return int(std::clamp<int64_t>(x, -kAll, kAll)); };
        const int64_t step = per_x * kOne_fx6;
        // The value at the centre of pixel 0, such that ≥ 0 is inside.
        const int64_t start = at(kHalf_fx6, centre_fx6(y)) - (owns ? 0 : 1);
        if (step == 0) {
            return start >= 0 ? Span{-kAll, kAll} : Span{};
        }
        if (step > 0) {  // start + step·x ≥ 0
            return {pixel(-floorDivide(start, step)), kAll};
        }
        return {-kAll, pixel(floorDivide(start, -step) + 1)};
    }

  private:
    static int64_t floorDivide(int64_t a, int64_t b) {  // b > 0
        return a >= 0 ? a / b : -((-a + b - 1) / b);
    }
};

/// What a command's triangles are covered with: the atlas, or a picture.
struct Texture {
    ImageView<const uint8_t> atlas{};
    ImageView<const Rgb8> picture{};  ///< goes first unless it is empty

    int width() const { return picture.empty() ? atlas.width : picture.width; }
    int height() const { return picture.empty() ? atlas.height : picture.height; }
};

class Painter {
  public:
    Painter(ImageView<const uint8_t> atlas, ImageView<Xrgb8> canvas)
        : atlas_(atlas), texture_{atlas, {}}, canvas_(canvas) {}

    void draw(const ImDrawList& list, ImVec2 origin);

  private:
    void setClip(const ImVec4& clip, ImVec2 origin);
    Corner cornerOf(const ImDrawVert& vertex, ImVec2 origin) const;
    /// A corner's colour through a texel.
    Ink inkOf(const Corner& corner, int64_t u_fx8, int64_t v_fx8) const;
    bool rectangle(const std::array<Corner, 4>& corners);
    void glyph(const Corner& first, const Corner& last, Span columns, Span rows);
    void triangle(std::array<Corner, 3> corners);
    void shadedSpan(const std::array<Corner, 3>& corners, const std::array<Edge, 3>& edges, int y,
                    Span span);

    ImageView<const uint8_t> atlas_;
    Texture texture_;  ///< of the command
    ImageView<Xrgb8> canvas_;
    Span clip_x_, clip_y_;
    std::vector<int64_t> u_of_column_fx8_;
};

int64_t fixed(float value, float limit, int64_t scale) {
    // Written so that a NaN becomes a limit as well.
    const float held = value > -limit ? std::min(value, limit) : -limit;
    return int64_t(std::floor(double(held) * double(scale) + 0.5));
}

Corner Painter::cornerOf(const ImDrawVert& vertex, ImVec2 origin) const {
    const auto texel = [](float place, int size) {
        return std::max<int64_t>(fixed(place * float(size), kTexelLimit, 1 << kTexelBits), 0);
    };
    const auto channel = [&](int shift) { return int64_t(vertex.col >> shift & 0xff); };
    return {fixed(vertex.pos.x - origin.x, kPositionLimit, kOne_fx6),
            fixed(vertex.pos.y - origin.y, kPositionLimit, kOne_fx6),
            texel(vertex.uv.x, texture_.width()),
            texel(vertex.uv.y, texture_.height()),
            {channel(IM_COL32_R_SHIFT), channel(IM_COL32_G_SHIFT), channel(IM_COL32_B_SHIFT),
             channel(IM_COL32_A_SHIFT)}};
}

void Painter::setClip(const ImVec4& clip, ImVec2 origin) {
    const auto span = [](float begin, float end, int size) {
        return intersection(centresWithin(fixed(begin, kPositionLimit, kOne_fx6),
                                          fixed(end, kPositionLimit, kOne_fx6)),
                            {0, size});
    };
    clip_x_ = span(clip.x - origin.x, clip.z - origin.x, canvas_.width);
    clip_y_ = span(clip.y - origin.y, clip.w - origin.y, canvas_.height);
}

Ink Painter::inkOf(const Corner& corner, int64_t u_fx8, int64_t v_fx8) const {
    const auto r = uint32_t(corner.rgba[0]), g = uint32_t(corner.rgba[1]);
    const auto b = uint32_t(corner.rgba[2]), a = uint32_t(corner.rgba[3]);
    const int u = int(std::min<int64_t>(u_fx8 >> kTexelBits, texture_.width() - 1));
    const int v = int(std::min<int64_t>(v_fx8 >> kTexelBits, texture_.height() - 1));
    if (texture_.picture.empty()) {
        return {packed(r, g, b), times(a, texture_.atlas.at(u, v))};
    }
    const Rgb8 texel = texture_.picture.at(u, v);
    return {packed(times(r, texel.r), times(g, texel.g), times(b, texel.b)), a};
}

/// Draws corners in order around an axis-aligned rectangle of one colour and an upright piece of
/// the atlas; false, and nothing is drawn, when they are anything else.
bool Painter::rectangle(const std::array<Corner, 4>& corners) {
    const auto& [a, b, c, d] = corners;
    const bool upright = a.y_fx6 == b.y_fx6 && b.x_fx6 == c.x_fx6 && c.y_fx6 == d.y_fx6 &&
                         d.x_fx6 == a.x_fx6 && a.x_fx6 <= c.x_fx6 && a.y_fx6 <= c.y_fx6;
    const bool plain = a.rgba == b.rgba && b.rgba == c.rgba && c.rgba == d.rgba;
    const bool even =
        a.v_fx8 == b.v_fx8 && b.u_fx8 == c.u_fx8 && c.v_fx8 == d.v_fx8 && d.u_fx8 == a.u_fx8;
    if (!upright || !plain || !even) {
        return false;
    }
    const Span columns = intersection(centresWithin(a.x_fx6, c.x_fx6), clip_x_);
    const Span rows = intersection(centresWithin(a.y_fx6, c.y_fx6), clip_y_);
    if (columns.begin >= columns.end || rows.begin >= rows.end) {
        return true;
    }
    if (a.u_fx8 != c.u_fx8 || a.v_fx8 != c.v_fx8) {
        glyph(a, c, columns, rows);
        return true;
    }
    const Ink ink = inkOf(a, a.u_fx8, a.v_fx8);
    for (int y = rows.begin; y < rows.end && ink.alpha != 0; ++y) {
        fill(canvas_.row(y), columns, ink);
    }
    return true;
}

void Painter::glyph(const Corner& first, const Corner& last, Span columns, Span rows) {
    const auto between = [](int64_t begin, int64_t end, int64_t from_fx6, int64_t to_fx6, int at) {
        const int64_t done = centre_fx6(at) - from_fx6, length = to_fx6 - from_fx6;
        return (begin * (length - done) + end * done) / length;
    };
    u_of_column_fx8_.clear();
    for (int x = columns.begin; x < columns.end; ++x) {
        u_of_column_fx8_.push_back(between(first.u_fx8, last.u_fx8, first.x_fx6, last.x_fx6, x));
    }
    for (int y = rows.begin; y < rows.end; ++y) {
        const int64_t v_fx8 = between(first.v_fx8, last.v_fx8, first.y_fx6, last.y_fx6, y);
        Xrgb8* row = canvas_.row(y);
        for (int x = columns.begin; x < columns.end; ++x) {
            const Ink ink = inkOf(first, u_of_column_fx8_[size_t(x - columns.begin)], v_fx8);
            row[x] = ink.alpha != 0 ? ink.over(row[x]) : row[x];
        }
    }
}

void Painter::triangle(std::array<Corner, 3> corners) {
    auto& [a, b, c] = corners;
    const int64_t area = Edge(a, b).at(c.x_fx6, c.y_fx6);
    if (area == 0) {
        return;
    }
    if (area < 0) {
        std::swap(b, c);
    }
    // Each faces the corner of its number.
    const std::array<Edge, 3> edges{Edge(b, c), Edge(c, a), Edge(a, b)};
    const auto [top, bottom] = std::minmax({a.y_fx6, b.y_fx6, c.y_fx6});
    const Span rows = intersection(centresWithin(top, bottom + 1), clip_y_);
    const auto same = [&](auto of) { return of(a) == of(b) && of(b) == of(c); };
    const bool plain = same([](const Corner& k) { return k.rgba; }) &&
                       same([](const Corner& k) { return k.u_fx8; }) &&
                       same([](const Corner& k) { return k.v_fx8; });
    const Ink ink = inkOf(a, a.u_fx8, a.v_fx8);
    for (int y = rows.begin; y < rows.end; ++y) {
        Span span = clip_x_;
        for (const Edge& edge : edges) {
            span = intersection(span, edge.inside(y));
        }
        if (span.begin >= span.end) {
            continue;
        }
        if (plain) {
            fill(canvas_.row(y), span, ink);
        } else {
            shadedSpan(corners, edges, y, span);
        }
    }
}

void Painter::shadedSpan(const std::array<Corner, 3>& corners, const std::array<Edge, 3>& edges,
                         int y, Span span) {
    std::array<int64_t, 3> weights{};
    int64_t total = 0;
    for (size_t k = 0; k < 3; ++k) {
        weights[k] = edges[k].at(centre_fx6(span.begin), centre_fx6(y));
        total += weights[k];
    }
    const auto sum = [&](auto of) {
        return weights[0] * of(corners[0]) + weights[1] * of(corners[1]) +
               weights[2] * of(corners[2]);
    };
    Xrgb8* row = canvas_.row(y);
    for (int x = span.begin; x < span.end; ++x) {
        Corner mixed;
        for (size_t k = 0; k < 4; ++k) {
            // A division is dear, and most often only the opacity varies.
            const bool varies = corners[0].rgba[k] != corners[1].rgba[k] ||
                                corners[1].rgba[k] != corners[2].rgba[k];
            mixed.rgba[k] =
                varies ? (sum([k](const Corner& c) { return c.rgba[k]; }) + total / 2) / total
                       : corners[0].rgba[k];
        }
        const Ink ink = inkOf(mixed, sum([](const Corner& c) { return c.u_fx8; }) / total,
                              sum([](const Corner& c) { return c.v_fx8; }) / total);
        row[x] = ink.over(row[x]);
        for (size_t k = 0; k < 3; ++k) {
            weights[k] += edges[k].per_x * kOne_fx6;
        }
    }
}

void Painter::draw(const ImDrawList& list, ImVec2 origin) {
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.UserCallback != nullptr) {
            continue;
        }
        setClip(command.ClipRect, origin);
        const auto* picture = static_cast<const ImageView<const Rgb8>*>(command.TextureId);
        texture_ = {atlas_, picture != nullptr ? *picture : ImageView<const Rgb8>{}};
        const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
        const ImDrawIdx* end = index + command.ElemCount;
        const auto corner = [&](int i) {
            return cornerOf(list.VtxBuffer[int(command.VtxOffset + index[i])], origin);
        };
        while (end - index >= 3) {
            if (end - index >= 6 && index[3] == index[0] && index[4] == index[2] &&
                rectangle({corner(0), corner(1), corner(2), corner(5)})) {
                index += 6;
                continue;
            }
            triangle({corner(0), corner(1), corner(2)});
            index += 3;
        }
    }
}

}  // namespace

void drawUi(const ImDrawData& data, ImageView<const uint8_t> atlas, ImageView<Xrgb8> canvas) {
    Painter painter(atlas, canvas);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        painter.draw(*data.CmdLists[i], data.DisplayPos);
    }
}

}  // namespace still::viewer
