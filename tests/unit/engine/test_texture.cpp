#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "engine/texture.h"
#include "rasterizer/texture_layout.h"
#include "tests/support/texels.h"

using namespace still;
using namespace still::test;

namespace {

using Size = std::pair<int, int>;
const std::vector<Size> kSizes{{1, 1}, {2, 2}, {1, 7}, {16, 1}, {5, 3}, {64, 32}, {97, 61}};

Image<Rgba8> randomImage(Size size, uint32_t seed) {
    std::mt19937 random(seed);
    Image<Rgba8> image(size.first, size.second);
    for (int y = 0; y < size.second; ++y) {
        for (int x = 0; x < size.first; ++x) {
            const uint32_t bits = random();
            image.at(x, y) = {uint8_t(bits), uint8_t(bits >> 8), uint8_t(bits >> 16),
                              uint8_t(bits >> 24)};
        }
    }
    return image;
}

Image<Rgba8> plainImage(Size size, Rgba8 pixel) {
    Image<Rgba8> image(size.first, size.second);
    for (int y = 0; y < size.second; ++y) {
        std::fill_n(image.view().row(y), size.first, pixel);
    }
    return image;
}

ImageView<const Rgba8> constView(const Image<Rgba8>& image) {
    return image.view();
}

uint32_t channel(uint32_t texel, int c) {
    return texel >> (10 * c) & 1023;
}

/// The slow truth: one channel of one level as plain numbers.
struct Grid {
    int width, height;
    std::vector<long double> v;
};

/// Length of the overlap of [a, a + 1) · n and [b, b + 1) · m.
long long overlap(int a, long long n, int b, long long m) {
    return std::max(0LL, std::min((a + 1) * n, (b + 1) * m) - std::max(a * n, b * m));
}

/// Every texel of the smaller level averages all texels of the larger one by the area they share.
Grid areaAverage(const Grid& g) {
    Grid out{std::max(g.width / 2, 1), std::max(g.height / 2, 1), {}};
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            long double sum = 0;
            for (int j = 0; j < g.height; ++j) {
                for (int i = 0; i < g.width; ++i) {
                    const long long area =
                        overlap(x, g.width, i, out.width) * overlap(y, g.height, j, out.height);
                    sum += (long double)area * g.v[size_t(j) * size_t(g.width) + size_t(i)];
                }
            }
            out.v.push_back(sum / ((long double)g.width * g.height));
        }
    }
    return out;
}

std::vector<Grid> mipGrids(const Image<Rgba8>& image,
                           const std::function<long double(const Rgba8&)>& value) {
    std::vector<Grid> grids{{image.width(), image.height(), {}}};
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            grids[0].v.push_back(value(image.at(x, y)));
        }
    }
    while (grids.back().width > 1 || grids.back().height > 1) {
        grids.push_back(areaAverage(grids.back()));
    }
    return grids;
}

long double srgbToLinear(uint8_t c) {
    const long double x = c / 255.0L;
    return x <= 0.04045L ? x / 12.92L : std::pow((x + 0.055L) / 1.055L, 2.4L);
}

/// Rounds half up; both neighbours are right within 1e-7 of a tie, where the oracle cannot tell.
bool roundsTo(long double exact, uint32_t code) {
    return code == uint32_t(std::floor(exact + 0.5L - 1e-7L)) ||
           code == uint32_t(std::floor(exact + 0.5L + 1e-7L));
}

/// Texels of all levels that differ from the oracle in channel `c`.
int wrongTexels(const Texture& texture, int c, const std::vector<Grid>& grids,
                const std::function<long double(long double)>& encode) {
    int wrong = texture.levels.size() == grids.size() ? 0 : 1;
    for (size_t k = 0; k < std::min(texture.levels.size(), grids.size()); ++k) {
        const TextureLevel& level = texture.levels[k];
        wrong += int(level.width) != grids[k].width || int(level.height) != grids[k].height;
        const std::vector<uint32_t> texels = texelsOf(texture, k);
        for (size_t i = 0; i < grids[k].v.size(); ++i) {
            wrong += !roundsTo(encode(grids[k].v[i]), channel(texels.at(i), c));
        }
    }
    return wrong;
}

size_t covered(const AlphaTexture& texture, size_t level, int threshold = 128) {
    const std::vector<uint8_t> texels = texelsOf(texture, level);
    return size_t(std::count_if(texels.begin(), texels.end(),
                                [threshold](uint8_t a) { return a >= threshold; }));
}

}  // namespace

TEST_CASE("texture: mips average colours by area in linear light", "[unit][engine]") {
    for (const Size& size : kSizes) {
        INFO(size.first << " × " << size.second);
        const Image<Rgba8> image = randomImage(size, uint32_t(size.first));
        const Texture texture = makeColourTexture(image.view(), Wrap::repeat);
        const auto encode = [](long double v) { return 1023 * std::sqrt(v); };
        CHECK(wrongTexels(texture, 0, mipGrids(image, [](auto& p) { return srgbToLinear(p.r); }),
                          encode) == 0);
        CHECK(wrongTexels(texture, 1, mipGrids(image, [](auto& p) { return srgbToLinear(p.g); }),
                          encode) == 0);
        CHECK(wrongTexels(texture, 2, mipGrids(image, [](auto& p) { return srgbToLinear(p.b); }),
                          encode) == 0);
        const TextureLevel& last = texture.levels.back();
        CHECK(last.width * last.height == 1);
    }
}

TEST_CASE("texture: a plain colour stays the same in every level", "[unit][engine]") {
    for (const int c : {0, 1, 12, 128, 254, 255}) {
        const Image<Rgba8> image = plainImage({97, 61}, {uint8_t(c), uint8_t(c), uint8_t(c), 255});
        const Texture texture = makeColourTexture(image.view(), Wrap::repeat);
        for (size_t level = 0; level < texture.levels.size(); ++level) {
            const std::vector<uint32_t> texels = texelsOf(texture, level);
            CHECK(std::count(texels.begin(), texels.end(), texelAt(texture, 0, 0, 0)) ==
                  ptrdiff_t(texels.size()));
        }
    }
    const Image<Rgba8> white = plainImage({1, 1}, {255, 255, 255, 0});
    CHECK(texelAt(makeColourTexture(white.view(), Wrap::clamp), 0, 0, 0) == 0x3FFFFFFFu);
}

TEST_CASE("texture: mips of normal maps average the vectors", "[unit][engine]") {
    for (const Size& size : kSizes) {
        const Image<Rgba8> image = randomImage(size, 77);
        const Texture texture = makeNormalTexture(image.view(), Wrap::clamp);
        CHECK(texture.wrap == Wrap::clamp);
        const auto encode = [](long double v) { return 1023 * v; };
        CHECK(wrongTexels(texture, 1, mipGrids(image, [](auto& p) { return p.g / 255.0L; }),
                          encode) == 0);
    }
}

TEST_CASE("texture: heights lean the normal away from where it gets brighter", "[unit][engine]") {
    const Image<Rgba8> flat = plainImage({5, 3}, {90, 90, 90, 255});
    for (const uint32_t texel :
         texelsOf(makeNormalTextureFromHeight(flat.view(), Wrap::repeat, 1.0f), 0)) {
        CHECK(channel(texel, 0) == 512);
        CHECK(channel(texel, 1) == 512);
        CHECK(channel(texel, 2) == 1023);
    }
    Image<Rgba8> ramp(8, 8);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            const uint8_t h = uint8_t(20 * x + 10 * (7 - y));  // brighter to the right and up
            ramp.at(x, y) = {h, h, h, 255};
        }
    }
    const auto at = [](const Texture& t, uint32_t x, uint32_t y) { return texelAt(t, 0, x, y); };
    const Texture once = makeNormalTextureFromHeight(constView(ramp), Wrap::clamp, 1.0f);
    const double dx = 20 / 255.0, dy = 10 / 255.0, length = std::sqrt(dx * dx + dy * dy + 1);
    CHECK(channel(at(once, 4, 4), 0) == uint32_t((1 - dx / length) / 2 * 1023 + 0.5));
    CHECK(channel(at(once, 4, 4), 1) == uint32_t((1 - dy / length) / 2 * 1023 + 0.5));
    const Texture thrice = makeNormalTextureFromHeight(constView(ramp), Wrap::clamp, 3.0f);
    CHECK(channel(at(thrice, 4, 4), 0) < channel(at(once, 4, 4), 0));
    // At the border a clamped image has half the slope, a repeated one sees the other side.
    const Texture repeated = makeNormalTextureFromHeight(constView(ramp), Wrap::repeat, 1.0f);
    CHECK(channel(at(once, 7, 4), 0) > channel(at(once, 4, 4), 0));
    CHECK(channel(at(repeated, 7, 4), 0) > 512);
}

TEST_CASE("texture: plain alpha is averaged by area", "[unit][engine]") {
    for (const Size& size : kSizes) {
        const Image<Rgba8> image = randomImage(size, 5);
        const AlphaTexture texture = makeAlphaTexture(image.view(), Wrap::repeat, false);
        const std::vector<Grid> grids = mipGrids(image, [](auto& p) { return (long double)p.a; });
        int wrong = 0;
        for (size_t k = 0; k < grids.size(); ++k) {
            const std::vector<uint8_t> texels = texelsOf(texture, k);
            for (size_t i = 0; i < grids[k].v.size(); ++i) {
                wrong += !roundsTo(grids[k].v[i], texels.at(i));
            }
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("texture: alpha-tested mips keep the coverage as well as any scale can",
          "[unit][engine]") {
    for (const Size& size : kSizes) {
        for (const int threshold : {20, 128, 230}) {
            Image<Rgba8> image = randomImage(size, uint32_t(threshold));
            for (int y = 0; y < size.second; ++y) {
                for (int x = 0; x < size.first; ++x) {
                    image.at(x, y).a = image.at(x, y).a >= threshold ? 255 : 0;
                }
            }
            const AlphaTexture kept = makeAlphaTexture(constView(image), Wrap::repeat, true);
            const AlphaTexture plain = makeAlphaTexture(constView(image), Wrap::repeat, false);
            const double share = double(covered(kept, 0)) / (size.first * size.second);
            for (size_t k = 1; k < kept.levels.size(); ++k) {
                const TextureLevel& level = kept.levels[k];
                const double wanted = share * level.width * level.height;
                double best = 1e9;
                for (int t = 1; t <= 256; ++t) {
                    best = std::min(best, std::abs(double(covered(plain, k, t)) - wanted));
                }
                CHECK(std::abs(double(covered(kept, k)) - wanted) == best);
            }
        }
    }
}

TEST_CASE("texture: a thin fence does not vanish in its mips", "[unit][engine]") {
    Image<Rgba8> fence = plainImage({256, 256}, {0, 0, 0, 0});
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const bool wire = (x + y) % 32 < 3 || (x - y + 256) % 32 < 3;
            fence.at(x, y).a = wire ? 255 : 0;
        }
    }
    const AlphaTexture texture = makeAlphaTexture(constView(fence), Wrap::repeat, true);
    const double share = double(covered(texture, 0)) / 65536;
    CHECK(texture.levels.size() >= 2);
    CHECK(texture.levels.size() < 9);  // ended before the wires were lost
    CHECK(texture.texels.size() == texelCount(texture.levels));
    for (size_t k = 0; k < texture.levels.size(); ++k) {
        const TextureLevel& level = texture.levels[k];
        CHECK(double(covered(texture, k)) / (level.width * level.height) ==
              Approx(share).margin(0.05));
    }
}

TEST_CASE("texture: heights are luminances, whatever the image's alpha", "[texture]") {
    for (const Size& size : kSizes) {
        const Image<Rgba8> image = randomImage(size, 77);
        Image<Rgba8> grey(size.first, size.second);
        for (int y = 0; y < size.second; ++y) {
            for (int x = 0; x < size.first; ++x) {
                const uint8_t level = luminance(image.at(x, y));
                const Rgba8& p = image.at(x, y);
                CHECK(std::abs(level - (0.2126 * p.r + 0.7152 * p.g + 0.0722 * p.b)) < 1.5);
                grey.at(x, y).a = level;
            }
        }
        const AlphaTexture heights = makeHeightTexture(image.view(), Wrap::clamp);
        CHECK(heights.wrap == Wrap::clamp);
        CHECK(heights.texels == makeAlphaTexture(constView(grey), Wrap::clamp, false).texels);
    }
    CHECK(luminance({255, 255, 255, 0}) == 255);
    CHECK(luminance({128, 128, 128, 0}) == 128);
}
