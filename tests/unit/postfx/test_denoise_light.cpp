// What the denoiser promises: of light that does not change, of light that does, at edges.

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>

#include "denoise_light.h"
#include "postfx/denoise.h"
#include "random_frames.h"
#include "rasterizer/fixed.h"

namespace {

using namespace still;
using denoise_light::Light;
using random_frames::Random;

constexpr int kWidth = 90, kHeight = 70;

/// One wall that faces the camera, at rest.
void makeWall(GBuffer& gbuffer) {
    gbuffer.resize(kWidth, kHeight, {.normal = true, .motion = true, .albedo = true});
    const uint32_t depth = std::bit_cast<uint32_t>(0.25f);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            gbuffer.id.at(x, y) = 1;
            gbuffer.depth.at(x, y) = depth;
            gbuffer.normal.at(x, y) = 0;
            gbuffer.motion.at(x, y) = {};
            gbuffer.albedo_red.at(x, y) = kColourOne;
            gbuffer.depth_before.at(x, y) = logDepth16(depth);
        }
    }
    gbuffer.tiles.assign(gbuffer.tiles.size(), {});
}

void fill(Light& light, uint16_t direct, uint16_t indirect) {
    light.resize(kWidth, kHeight);
    for (size_t i = 0; i < 6; ++i) {
        for (int y = 0; y < kHeight; ++y) {
            std::fill_n(light.all()[i]->view().row(y), kWidth, i < 3 ? direct : indirect);
        }
    }
}

/// Each pixel's lamp is seen by one sample in four.
void flip(Random& random, Light& light) {
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const uint16_t value = random.chance(25) ? 4000 : 0;
            for (size_t c = 0; c < 3; ++c) {
                light.all()[c]->at(x, y) = value;
            }
        }
    }
}

/// All blocks saw `before` and would see `now`.
void change(Light& light, uint16_t before, uint16_t now) {
    const uint16_t values[4] = {before, now, before, now};
    for (size_t i = 0; i < 4; ++i) {
        Image<uint16_t>& plane = *light.allChanges()[i];
        for (int y = 0; y < plane.height(); ++y) {
            std::fill_n(plane.view().row(y), plane.width(), values[i]);
        }
    }
}

double rmsOff(ImageView<const uint16_t> plane, double wanted) {
    double sum = 0;
    for (int y = 0; y < plane.height; ++y) {
        for (int x = 0; x < plane.width; ++x) {
            sum += (plane.row(y)[x] - wanted) * (plane.row(y)[x] - wanted);
        }
    }
    return std::sqrt(sum / (plane.width * plane.height));
}

struct Extent {
    int least = 65535, most = 0;
};

Extent extentOf(ImageView<const uint16_t> plane, int x0 = 0, int x1 = kWidth) {
    Extent extent;
    for (int y = 0; y < plane.height; ++y) {
        for (int x = x0; x < x1; ++x) {
            extent.least = std::min<int>(extent.least, plane.row(y)[x]);
            extent.most = std::max<int>(extent.most, plane.row(y)[x]);
        }
    }
    return extent;
}

struct Stage {
    Workers workers{1};
    GBuffer gbuffer;
    Light light;
    Denoiser denoiser;

    Stage() {
        makeWall(gbuffer);
        fill(light, 0, 0);
    }
    void run(const DenoiseFrame& frame = {}) {
        denoiser.run(gbuffer, light.planes(), frame, bestSimdTarget(), workers);
    }
    ImageView<const uint16_t> direct() const { return denoiser.light().direct.green; }
};

}  // namespace

TEST_CASE("denoise: light without noise passes unchanged", "[postfx][unit]") {
    Stage stage;
    for (const uint16_t value : {uint16_t{1}, uint16_t{777}, uint16_t{65535}}) {
        fill(stage.light, value, uint16_t(value / 2));
        for (int frame = 0; frame < 5; ++frame) {
            stage.run({.reset = frame == 0});
            CHECK(extentOf(stage.direct()).least == value);
            CHECK(extentOf(stage.direct()).most == value);
            const Extent indirect = extentOf(stage.denoiser.light().indirect.blue);
            CHECK(indirect.least == value / 2);
            CHECK(indirect.most == value / 2);
        }
    }
}

TEST_CASE("denoise: a first frame loses most of its noise, later ones nearly all",
          "[postfx][unit]") {
    Stage stage;
    Random random(3);
    flip(random, stage.light);
    const double raw = rmsOff(stage.light.images.direct_green.view(), 1000);
    stage.run({.reset = true});
    CHECK(rmsOff(stage.direct(), 1000) < raw / 5);
    for (int frame = 1; frame < 32; ++frame) {
        flip(random, stage.light);
        stage.run();
    }
    // As many samples without neighbours: raw / 5.7.
    CHECK(rmsOff(stage.direct(), 1000) < raw / 20);
}

TEST_CASE("denoise: the mean of light is kept", "[postfx][unit]") {
    Stage stage;
    Random random(4);
    for (int frame = 0; frame < 24; ++frame) {
        flip(random, stage.light);
        stage.run({.reset = frame == 0});
    }
    double sum = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            sum += stage.direct().row(y)[x];
        }
    }
    CHECK(sum / (kWidth * kHeight) == Approx(1000).epsilon(0.02));
}

TEST_CASE("denoise: light that goes out is gone at once, light that halves is half",
          "[postfx][unit]") {
    for (const int part : {0, 2}) {
        Stage stage;
        Random random(5);
        for (int frame = 0; frame < 20; ++frame) {
            flip(random, stage.light);
            stage.run({.reset = frame == 0});
        }
        const double before = rmsOff(stage.direct(), 0);
        change(stage.light, 4000, uint16_t(part == 0 ? 0 : 2000));
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                for (size_t c = 0; c < 3; ++c) {
                    uint16_t& value = stage.light.all()[c]->at(x, y);
                    value = uint16_t(part == 0 ? 0 : value / 2);
                }
            }
        }
        stage.run({.change = stage.light.change()});
        CHECK(rmsOff(stage.direct(), 0) ==
              Approx(before * (part == 0 ? 0 : 0.5)).epsilon(0.1).margin(1));
        REQUIRE_FALSE(stage.denoiser.lightAge().empty());
        CHECK(stage.denoiser.lightAge().row(kHeight / 2)[kWidth / 2] == 0);
    }
}

TEST_CASE("denoise: the hue of a lamp that goes out goes with it", "[postfx][unit]") {
    Stage stage;
    fill(stage.light, 1000, 0);
    for (int y = 0; y < kHeight; ++y) {
        std::fill_n(stage.light.images.direct_red.view().row(y), kWidth, uint16_t{5000});
    }
    for (int frame = 0; frame < 20; ++frame) {
        stage.run({.reset = frame == 0});
    }
    fill(stage.light, 300, 0);
    change(stage.light, 1850, 300);
    stage.run({.change = stage.light.change()});
    for (int frame = 0; frame < 2; ++frame) {
        change(stage.light, 300, 300);
        stage.run({.change = stage.light.change()});
    }
    const ImageView<const uint16_t> red = stage.denoiser.light().direct.red;
    CHECK(extentOf(red).most - 300 < 5000 / 50);
}

TEST_CASE("denoise: where no sample changed, light is old", "[postfx][unit]") {
    Stage stage;
    fill(stage.light, 500, 500);
    stage.run({.reset = true});
    change(stage.light, 900, 900);
    for (int frame = 0; frame < 3; ++frame) {
        stage.run({.change = stage.light.change()});
        CHECK(stage.denoiser.lightAge().empty());
    }
}

TEST_CASE("denoise: light does not cross a step of depth or a corner", "[postfx][unit]") {
    for (const bool corner : {false, true}) {
        Stage stage;
        Random random(6);
        for (int frame = 0; frame < 12; ++frame) {
            for (int y = 0; y < kHeight; ++y) {
                for (int x = 0; x < kWidth; ++x) {
                    const bool right = x >= kWidth / 2;
                    if (right && corner) {
                        stage.gbuffer.normal.at(x, y) = 32767;  // along x
                    } else if (right) {
                        const uint32_t depth = std::bit_cast<uint32_t>(0.125f);
                        stage.gbuffer.depth.at(x, y) = depth;
                        stage.gbuffer.depth_before.at(x, y) = logDepth16(depth);
                    }
                    const int most = right ? 8000 : 800;
                    for (size_t c = 0; c < 3; ++c) {
                        stage.light.all()[c]->at(x, y) = uint16_t(random.below(most));
                    }
                }
            }
            stage.run({.reset = frame == 0});
        }
        CHECK(extentOf(stage.direct(), 0, kWidth / 2).most < 800);
        CHECK(extentOf(stage.direct(), kWidth / 2, kWidth).least > 2000);
    }
}

TEST_CASE("denoise: a still pixel's two surfaces keep their own light", "[postfx][unit]") {
    Stage stage;
    constexpr int kX = 40, kY = 30;
    // Its samples hit its own dark surface in every other frame; all around is bright.
    for (int frame = 0; frame < 40; ++frame) {
        fill(stage.light, 4000, 0);
        stage.gbuffer.id.at(kX, kY) = uint16_t(frame % 2 == 0 ? 2 : 1);
        if (frame % 2 == 0) {
            for (size_t c = 0; c < 3; ++c) {
                stage.light.all()[c]->at(kX, kY) = 100;
            }
        }
        stage.run({.reset = frame == 0});
        if (frame >= 8) {  // four samples of each
            CHECK(stage.direct().row(kY)[kX] == (frame % 2 == 0 ? 100 : 4000));
        }
    }
}

TEST_CASE("denoise: what moves takes its light along", "[postfx][unit]") {
    Stage stage;
    const auto stripes = [&](int shift) {
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const uint16_t value = (x + shift) / 30 % 2 == 0 ? 3000 : 1000;
                for (size_t c = 0; c < 3; ++c) {
                    stage.light.all()[c]->at(x, y) = value;
                }
                stage.gbuffer.motion.at(x, y) = {.x_fx8 = 2 * 256, .y_fx8 = 0};
            }
        }
    };
    for (int frame = 0; frame < 10; ++frame) {
        stripes(frame * 2);
        stage.run({.reset = frame == 0});
        // The first frames are smoothed, and so is what has just come in from the right.
        for (int x = 0; frame >= 6 && x < kWidth - 30; ++x) {
            const int wanted = (x + frame * 2) / 30 % 2 == 0 ? 3000 : 1000;
            CHECK(std::abs(stage.direct().row(20)[x] - wanted) < 200);
        }
    }
}

TEST_CASE("denoise: no light where no surface is", "[postfx][unit]") {
    Stage stage;
    fill(stage.light, 3000, 3000);
    for (int y = 0; y < kHeight; ++y) {
        std::fill_n(stage.gbuffer.id.view().row(y), 20, uint16_t{0});
        std::fill_n(stage.gbuffer.depth.view().row(y), 20, 0u);
        std::fill_n(stage.light.images.direct_green.view().row(y), 20, uint16_t{0});
    }
    for (int frame = 0; frame < 3; ++frame) {
        stage.run({.reset = frame == 0});
        CHECK(extentOf(stage.direct(), 0, 20).most == 0);
        CHECK(extentOf(stage.direct(), 20, kWidth).least == 3000);
    }
}

TEST_CASE("denoise: remodulate adds albedo times light, rounded half up and saturated",
          "[postfx][unit]") {
    Stage stage;
    Random random(9);
    GBuffer& gbuffer = stage.gbuffer;
    for (Image<uint16_t>* plane : stage.light.all()) {
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                plane->at(x, y) = uint16_t(random.below(random.chance(20) ? 65536 : 5000));
            }
        }
    }
    for (Image<uint16_t>* plane : {&gbuffer.red, &gbuffer.albedo_red}) {
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                plane->at(x, y) = uint16_t(random.below(random.chance(20) ? 65536 : 4097));
            }
        }
    }
    Image<uint16_t> before(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
        std::copy_n(gbuffer.red.view().row(y), kWidth, before.view().row(y));
    }
    remodulate(gbuffer, stage.light.planes(), stage.workers);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double light = std::min(65535, stage.light.images.direct_red.at(x, y) +
                                                     stage.light.images.indirect_red.at(x, y));
            const double added = std::floor(gbuffer.albedo_red.at(x, y) * light / 4096 + 0.5);
            const double sum = before.at(x, y) + added;
            if (gbuffer.red.at(x, y) != std::min(sum, 65535.0)) {
                FAIL("pixel " << x << ", " << y << ": " << gbuffer.red.at(x, y) << " not " << sum);
            }
        }
    }
}
