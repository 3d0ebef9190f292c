// The UI's rasterizer against one that asks every pixel.

#include <imgui.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "demos/viewer/ui_raster.h"

namespace still::viewer {
namespace {

constexpr int kWidth = 61, kHeight = 47;
constexpr int kAtlasWidth = 32, kAtlasHeight = 16;

/// Corners as the header says: 1/64 pixel, 1/256 texel.
struct Placed {
    int64_t x = 0, y = 0, u = 0, v = 0;
    std::array<int64_t, 4> rgba{};
};

Placed placed(const ImDrawVert& vertex) {
    const auto fixed = [](double value, double scale) {
        return int64_t(std::floor(value * scale + 0.5));
    };
    Placed p{fixed(std::clamp(double(vertex.pos.x), -16384.0, 16384.0), 64),
             fixed(std::clamp(double(vertex.pos.y), -16384.0, 16384.0), 64),
             fixed(double(vertex.uv.x * kAtlasWidth), 256),
             fixed(double(vertex.uv.y * kAtlasHeight), 256),
             {}};
    for (size_t k = 0; k < 4; ++k) {
        p.rgba[k] = vertex.col >> (8 * k) & 0xff;
    }
    return p;
}

/// Twice the area of a, b and the point, positive when it lies to the right of a → b.
int64_t side(const Placed& a, const Placed& b, int64_t x, int64_t y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

bool inside(const Placed& a, const Placed& b, int64_t x, int64_t y) {
    const bool top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
    return side(a, b, x, y) > (top_left ? -1 : 0);
}

class Oracle {
  public:
    Oracle(ImageView<const uint8_t> atlas, ImageView<const Rgb8> picture, ImageView<Xrgb8> canvas)
        : atlas_(atlas), picture_(picture), canvas_(canvas) {}

    void triangle(Placed a, Placed b, Placed c, const ImVec4& clip) {
        if (side(a, b, c.x, c.y) < 0) {
            std::swap(b, c);
        }
        if (side(a, b, c.x, c.y) == 0) {
            return;
        }
        for (int py = 0; py < kHeight; ++py) {
            for (int px = 0; px < kWidth; ++px) {
                const float centre_x = float(px) + 0.5f, centre_y = float(py) + 0.5f;
                const int64_t x = px * 64 + 32, y = py * 64 + 32;
                if (centre_x >= clip.x && centre_x < clip.z && centre_y >= clip.y &&
                    centre_y < clip.w && inside(a, b, x, y) && inside(b, c, x, y) &&
                    inside(c, a, x, y)) {
                    pixel(a, b, c, px, py);
                }
            }
        }
    }

  private:
    void pixel(const Placed& a, const Placed& b, const Placed& c, int px, int py) {
        const int64_t x = px * 64 + 32, y = py * 64 + 32;
        const int64_t wa = side(b, c, x, y), wb = side(c, a, x, y), wc = side(a, b, x, y);
        const int64_t total = wa + wb + wc;
        const auto texel = [&](int64_t at_a, int64_t at_b, int64_t at_c, int size) {
            const int64_t fx8 = (wa * at_a + wb * at_b + wc * at_c) / total;
            return int(std::min<int64_t>(fx8 / 256, size - 1));
        };
        std::array<int64_t, 4> rgba{};
        for (size_t k = 0; k < 4; ++k) {
            rgba[k] = (wa * a.rgba[k] + wb * b.rgba[k] + wc * c.rgba[k] + total / 2) / total;
        }
        const int u = texel(a.u, b.u, c.u, kAtlasWidth), v = texel(a.v, b.v, c.v, kAtlasHeight);
        int64_t alpha = rgba[3];
        if (picture_.empty()) {
            alpha = (alpha * atlas_.at(u, v) + 127) / 255;
        } else {
            const Rgb8 seen = picture_.at(u, v);
            rgba[0] = (rgba[0] * seen.r + 127) / 255;
            rgba[1] = (rgba[1] * seen.g + 127) / 255;
            rgba[2] = (rgba[2] * seen.b + 127) / 255;
        }
        Xrgb8& under = canvas_.at(px, py);
        Xrgb8 mixed = 0;
        for (size_t k = 0; k < 3; ++k) {
            const int64_t below = under >> (16 - 8 * k) & 0xff;
            mixed = mixed << 8 | Xrgb8((rgba[k] * alpha + below * (255 - alpha) + 127) / 255);
        }
        under = mixed;
    }

    ImageView<const uint8_t> atlas_;
    ImageView<const Rgb8> picture_;
    ImageView<Xrgb8> canvas_;
};

/// A picture, an atlas and a draw list of noise.
class Scribble {
  public:
    explicit Scribble(unsigned seed)
        : random_(seed),
          atlas_(kAtlasWidth, kAtlasHeight),
          picture_(kAtlasWidth, kAtlasHeight),
          canvas_(kWidth, kHeight) {
        for (int y = 0; y < kAtlasHeight; ++y) {
            for (int x = 0; x < kAtlasWidth; ++x) {
                atlas_.at(x, y) = uint8_t(oneOf(3) == 0 ? random_() : oneOf(2) * 255);
                picture_.at(x, y) = {uint8_t(random_()), uint8_t(random_()), uint8_t(random_())};
            }
        }
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                canvas_.at(x, y) = random_() & 0xffffff;
            }
        }
    }

    void addTriangle() {
        const ImU32 colour = this->colour();
        const bool plain = oneOf(2) == 0;
        const ImVec2 uv = texel();
        const bool textured = oneOf(3) == 0;
        for (int k = 0; k < 3; ++k) {
            list_.IdxBuffer.push_back(ImDrawIdx(list_.VtxBuffer.Size));
            list_.VtxBuffer.push_back(
                {place(), textured ? texel() : uv, plain ? colour : this->colour()});
        }
    }
    /// As ImDrawList::PrimRect and PrimRectUV do it.
    void addRectangle() {
        ImVec2 a = place(), c = place();
        if (oneOf(8) != 0) {
            a = {std::min(a.x, c.x), std::min(a.y, c.y)};
        }
        const ImVec2 uv_a = texel(), uv_c = oneOf(2) == 0 ? uv_a : texel();
        const ImU32 col = colour();
        const int first = list_.VtxBuffer.Size;
        list_.VtxBuffer.push_back({a, uv_a, col});
        list_.VtxBuffer.push_back({{c.x, a.y}, {uv_c.x, uv_a.y}, col});
        list_.VtxBuffer.push_back({c, uv_c, oneOf(6) == 0 ? colour() : col});
        list_.VtxBuffer.push_back({{a.x, c.y}, {uv_a.x, uv_c.y}, col});
        for (const int k : {0, 1, 2, 0, 2, 3}) {
            list_.IdxBuffer.push_back(ImDrawIdx(first + k));
        }
    }
    void endCommand() {
        ImDrawCmd command;
        const float x = float(oneOf(kWidth)) - 5, y = float(oneOf(kHeight)) - 5;
        command.ClipRect = {x, y, x + float(oneOf(kWidth * 2)), y + float(oneOf(kHeight * 2))};
        const int before =
            list_.CmdBuffer.empty()
                ? 0
                : int(list_.CmdBuffer.back().IdxOffset + list_.CmdBuffer.back().ElemCount);
        command.TextureId = oneOf(3) == 0 ? static_cast<void*>(&picture_view_) : nullptr;
        command.IdxOffset = unsigned(before);
        command.ElemCount = unsigned(list_.IdxBuffer.Size - before);
        list_.CmdBuffer.push_back(command);
    }

    std::vector<Xrgb8> drawn() {
        ImDrawList* lists[] = {&list_};
        ImDrawData data;
        data.CmdListsCount = 1;
        data.CmdLists = lists;
        Image<Xrgb8> canvas = copy();
        drawUi(data, atlas_.view(), canvas.view());
        return pixels(canvas);
    }
    std::vector<Xrgb8> expected() {
        Image<Xrgb8> canvas = copy();
        for (const ImDrawCmd& command : list_.CmdBuffer) {
            const bool pictured = command.TextureId != nullptr;
            Oracle oracle(atlas_.view(), pictured ? picture_view_ : ImageView<const Rgb8>{},
                          canvas.view());
            for (unsigned i = 0; i < command.ElemCount; i += 3) {
                const auto corner = [&](unsigned k) {
                    return placed(list_.VtxBuffer[list_.IdxBuffer[int(command.IdxOffset + i + k)]]);
                };
                oracle.triangle(corner(0), corner(1), corner(2), command.ClipRect);
            }
        }
        return pixels(canvas);
    }

  private:
    int oneOf(int count) { return int(random_() % unsigned(count)); }
    /// Corners that meet pixel corners and centres, and any others; a few are far away.
    ImVec2 place() {
        const float scale = oneOf(40) == 0 ? 300.0f : 1.5f;
        const float step = std::array{1.0f, 0.5f, 1.0f / 64, 0.0137f}[size_t(oneOf(4))];
        const auto along = [&](int size) {
            const float range = float(size) * scale;
            const float at =
                float(random_() % 100000u) / 100000.0f * range - (range - float(size)) / 2;
            return std::floor(at / step) * step;
        };
        return {along(kWidth), along(kHeight)};
    }
    ImVec2 texel() {
        return {float(oneOf(kAtlasWidth + 1)) / kAtlasWidth,
                float(oneOf(kAtlasHeight * 4 + 1)) / (kAtlasHeight * 4)};
    }
    ImU32 colour() {
        const ImU32 alpha = std::array{0u, 255u, unsigned(random_() & 255u)}[size_t(oneOf(3))];
        return (unsigned(random_()) & 0xffffffu) | alpha << 24;
    }
    Image<Xrgb8> copy() const {
        Image<Xrgb8> image(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y) {
            std::copy_n(canvas_.view().row(y), kWidth, image.view().row(y));
        }
        return image;
    }
    static std::vector<Xrgb8> pixels(const Image<Xrgb8>& image) {
        std::vector<Xrgb8> all;
        for (int y = 0; y < kHeight; ++y) {
            all.insert(all.end(), image.view().row(y), image.view().row(y) + kWidth);
        }
        return all;
    }

    std::mt19937 random_;
    Image<uint8_t> atlas_;
    Image<Rgb8> picture_;
    ImageView<const Rgb8> picture_view_ = picture_.view();
    Image<Xrgb8> canvas_;
    ImDrawList list_{nullptr};
};

}  // namespace

TEST_CASE("ui raster: random triangles have the pixels of the oracle") {
    for (unsigned seed = 0; seed < 150; ++seed) {
        Scribble scribble(seed);
        for (int i = 0; i < 6; ++i) {
            scribble.addTriangle();
            scribble.addTriangle();
            scribble.endCommand();
        }
        INFO(seed);
        REQUIRE(scribble.drawn() == scribble.expected());
    }
}

TEST_CASE("ui raster: rectangles and glyphs have the pixels of their two triangles") {
    for (unsigned seed = 0; seed < 150; ++seed) {
        Scribble scribble(seed);
        for (int i = 0; i < 6; ++i) {
            scribble.addRectangle();
            scribble.addRectangle();
            scribble.addTriangle();
            scribble.endCommand();
        }
        INFO(seed);
        REQUIRE(scribble.drawn() == scribble.expected());
    }
}

TEST_CASE("ui raster: a glyph drawn texel by pixel is the atlas itself") {
    Image<uint8_t> atlas(8, 8);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            atlas.at(x, y) = uint8_t(x * 31 + y * 3);
        }
    }
    ImDrawList list(nullptr);
    const auto corner = [&](float x, float y, float u, float v) {
        list.VtxBuffer.push_back({{x, y}, {u / 8, v / 8}, 0xffffffff});
    };
    corner(12, 20, 2, 1);
    corner(17, 20, 7, 1);
    corner(17, 26, 7, 7);
    corner(12, 26, 2, 7);
    for (const ImDrawIdx k : {0, 1, 2, 0, 2, 3}) {
        list.IdxBuffer.push_back(k);
    }
    ImDrawCmd command;
    command.ClipRect = {10, 20, 110, 120};
    command.ElemCount = 6;
    list.CmdBuffer.push_back(command);
    ImDrawList* lists[] = {&list};
    ImDrawData data;
    data.CmdListsCount = 1;
    data.CmdLists = lists;
    data.DisplayPos = {10, 20};
    Image<Xrgb8> canvas(9, 9);
    drawUi(data, atlas.view(), canvas.view());
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 9; ++x) {
            const bool inside = x >= 2 && x < 7 && y < 6;
            const Xrgb8 grey = inside ? atlas.at(x, y + 1) : 0u;
            REQUIRE(canvas.at(x, y) == grey * 0x010101u);
        }
    }
}

TEST_CASE("ui raster: corners at infinity and without a number end within the canvas") {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    Image<uint8_t> atlas(4, 4);
    atlas.at(0, 0) = 255;
    for (const float strange : {kInfinity, -kInfinity, kNan, 3e38f}) {
        ImDrawList list(nullptr);
        list.VtxBuffer.push_back({{strange, 0}, {strange, kNan}, 0xffffffff});
        list.VtxBuffer.push_back({{8, strange}, {0, strange}, 0x80ffffff});
        list.VtxBuffer.push_back({{0, 8}, {0, 0}, 0xff00ff00});
        for (const ImDrawIdx k : {0, 1, 2, 2, 1, 0}) {
            list.IdxBuffer.push_back(k);
        }
        ImDrawCmd command;
        command.ClipRect = {-kInfinity, kNan, strange, kInfinity};
        command.ElemCount = 6;
        list.CmdBuffer.push_back(command);
        ImDrawList* lists[] = {&list};
        ImDrawData data;
        data.CmdListsCount = 1;
        data.CmdLists = lists;
        Image<Xrgb8> canvas(9, 9);
        drawUi(data, atlas.view(), canvas.view());
        for (int y = 0; y < 9; ++y) {
            for (int x = 0; x < 9; ++x) {
                REQUIRE(canvas.at(x, y) <= 0xffffffu);
            }
        }
    }
}

}  // namespace still::viewer
