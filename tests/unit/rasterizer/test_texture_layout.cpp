// Borders around the levels of a texture.

#include <algorithm>
#include <catch2/catch.hpp>

#include "rasterizer/texture_layout.h"
#include "tests/support/random_triangles.h"
#include "tests/support/texels.h"

using namespace still;
using namespace still::test;

namespace {

/// Levels of random sizes without gaps, every texel another number.
Texture tightTexture(Wrap wrap, Random& random) {
    Texture t;
    t.wrap = wrap;
    for (int level = 0; level < 3; ++level) {
        t.levels.push_back({uint32_t(random.integer(1, 9)), uint32_t(random.integer(1, 9)), 0, 0});
        for (uint32_t k = t.levels.back().width * t.levels.back().height; k > 0; --k) {
            t.texels.push_back(uint32_t(t.texels.size()) + 1);
        }
    }
    return t;
}

int wrappedOrClamped(int i, int size, Wrap wrap) {
    return wrap == Wrap::repeat ? (i + size) % size : std::clamp(i, 0, size - 1);
}

}  // namespace

TEST_CASE("texture layout: texels keep their places, borders hold the neighbours", "[texture]") {
    Random random(31);
    for (int run = 0; run < 200; ++run) {
        const Wrap wrap = run % 2 == 0 ? Wrap::repeat : Wrap::clamp;
        const Texture tight = tightTexture(wrap, random);
        Texture texture = tight;
        layOut(texture);
        size_t first = 0;
        int wrong = 0;
        for (size_t level = 0; level < tight.levels.size(); ++level) {
            const TextureLevel& l = texture.levels[level];
            const int width = int(tight.levels[level].width);
            const int height = int(tight.levels[level].height);
            REQUIRE((int(l.width) == width && int(l.height) == height));
            for (int y = -1; y <= height; ++y) {
                for (int x = -1; x <= width; ++x) {
                    const int from_x = wrappedOrClamped(x, width, wrap);
                    const int from_y = wrappedOrClamped(y, height, wrap);
                    const auto at = ptrdiff_t{l.offset} + y * ptrdiff_t{l.stride} + x;
                    wrong += texture.texels.at(size_t(at)) !=
                             tight.texels[first + size_t(from_y * width + from_x)];
                }
            }
            first += size_t(width) * size_t(height);
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("texture layout: four texels may be loaded where the last two are meant", "[texture]") {
    Random random(32);
    for (int run = 0; run < 50; ++run) {
        Texture texture = tightTexture(Wrap::repeat, random);
        layOut(texture);
        const TextureLevel& last = texture.levels.back();
        const size_t last_pair = last.offset + size_t{last.height} * last.stride + last.width - 1;
        CHECK(last_pair + 4 == texture.texels.size());
    }
}

TEST_CASE("texture layout: without mips only the first level is left", "[texture]") {
    Random random(33);
    Texture texture = tightTexture(Wrap::clamp, random);
    layOut(texture);
    const Texture first = withoutMips(texture);
    CHECK(first.levels.size() == 1);
    CHECK(first.texels.size() == texelCount(first.levels));
    CHECK(texelsOf(first, 0) == texelsOf(texture, 0));
}
