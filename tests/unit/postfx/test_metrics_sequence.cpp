// Sharpness, flicker, ghosts and recovery, against values found by hand.

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <utility>

#include "postfx/metrics.h"

namespace still {
namespace {

Image<Rgb8> drawn(int width, int height, const std::function<int(int x, int y)>& grey) {
    Image<Rgb8> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto v = uint8_t(grey(x, y));
            image.at(x, y) = {v, v, v};
        }
    }
    return image;
}

Image<Rgb8> flat(int width, int height, int grey) {
    return drawn(width, height, [&](int, int) { return grey; });
}

ImageView<const Rgb8> view(const Image<Rgb8>& image) {
    return image.view();
}

/// A box of surface 2, 8 pixels wide, its left edge at `left`, before a background of surface 1.
/// `motion_x` of both in pixels; the picture is 64 × 16.
GBuffer boxAt(int left, double box_motion, double background_motion) {
    GBuffer gbuffer;
    gbuffer.resize(64, 16, {.motion = true});
    gbuffer.planes.motion = true;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 64; ++x) {
            const bool box = x >= left && x < left + 8;
            gbuffer.id.at(x, y) = box ? uint16_t(2 | kMovedBit) : uint16_t(1);
            gbuffer.motion.at(x, y) = {
                int16_t(std::lround(256 * (box ? box_motion : background_motion))), 0};
        }
    }
    return gbuffer;
}

int marked(ImageView<const uint8_t> mask, int y) {
    int count = 0;
    for (int x = 0; x < mask.width; ++x) {
        count += mask.at(x, y);
    }
    return count;
}

}  // namespace

TEST_CASE("metrics: rmse is the root of the mean square, in codes", "[postfx][unit]") {
    CHECK(rmse(pixelError(view(flat(4, 4, 10)), view(flat(4, 4, 13)))) == Approx(3.0));
    CHECK(rmse(PixelError{}) == 0.0);
}

TEST_CASE("metrics: half the contrast has a quarter of the gradient energy", "[postfx][unit]") {
    const auto stripes = [](int low, int high) {
        return drawn(32, 8, [=](int x, int) { return x % 2 == 0 ? low : high; });
    };
    CHECK(sharpnessRatio(view(stripes(100, 140)), view(stripes(110, 130))) == Approx(0.25));
    CHECK(sharpnessRatio(view(stripes(100, 140)), view(stripes(100, 140))) == 1.0);
    // One step of 60 against three of 20: 3600 to 1200 in every row.
    const Image<Rgb8> step = drawn(16, 4, [](int x, int) { return x < 8 ? 40 : 100; });
    const Image<Rgb8> ramp =
        drawn(16, 4, [](int x, int) { return x < 7 ? 40 : (x == 7 ? 60 : (x == 8 ? 80 : 100)); });
    CHECK(sharpnessRatio(view(step), view(ramp)) == Approx(1.0 / 3));
    CHECK(sharpnessRatio(view(ramp), view(step)) == Approx(3.0));
}

TEST_CASE("metrics: sharpness counts rows and columns and weighs channels as luma",
          "[postfx][unit]") {
    Image<Rgb8> reference = flat(3, 3, 0), test = flat(3, 3, 0);
    reference.at(1, 1).g = 100;  // four differences of 58.7
    test.at(0, 0).r = 100;       // two of 29.9
    CHECK(sharpnessRatio(view(reference), view(test)) ==
          Approx(2 * 29.9 * 29.9 / (4 * 58.7 * 58.7)));
    CHECK(sharpnessRatio(view(flat(5, 5, 3)), view(flat(5, 5, 9))) == 1.0);
    CHECK(std::isinf(sharpnessRatio(view(flat(3, 3, 3)), view(test))));
}

TEST_CASE("metrics: flicker is the change of the error, not of the picture", "[postfx][unit]") {
    FlickerMeter steady;
    for (int i = 0; i < 5; ++i) {
        steady.add(view(flat(8, 8, 20 * i)), view(flat(8, 8, 20 * i + 7)));
    }
    CHECK(steady.rms() == 0.0);

    FlickerMeter blinking;  // errors 0, 51, 0, 51: each change is a fifth of the range
    for (int i = 0; i < 4; ++i) {
        blinking.add(view(flat(8, 8, 100)), view(flat(8, 8, 100 + 51 * (i % 2))));
    }
    CHECK(blinking.rms() == Approx(0.2));

    FlickerMeter one_channel;  // a single channel of 12 changes once by 255
    Image<Rgb8> lit = flat(2, 2, 0);
    lit.at(1, 0).b = 255;
    one_channel.add(view(flat(2, 2, 0)), view(flat(2, 2, 0)));
    one_channel.add(view(flat(2, 2, 0)), view(lit));
    CHECK(one_channel.rms() == Approx(std::sqrt(1.0 / 12)));
}

TEST_CASE("metrics: flicker does not look across a cut", "[postfx][unit]") {
    FlickerMeter meter;
    CHECK(meter.rms() == 0.0);
    meter.add(view(flat(8, 8, 0)), view(flat(8, 8, 200)));
    CHECK(meter.rms() == 0.0);
    meter.cut();
    meter.add(view(flat(4, 4, 0)), view(flat(4, 4, 10)));
    CHECK(meter.rms() == 0.0);
    meter.add(view(flat(4, 4, 0)), view(flat(4, 4, 10)));
    CHECK(meter.rms() == 0.0);
}

TEST_CASE("ghosts: what a moving box uncovers is marked, but not the rim", "[postfx][unit]") {
    RevealMask reveal;
    CHECK(marked(reveal.next(boxAt(10, 0, 0), false), 8) == 0);
    // Three pixels to the right: columns 10 … 12 show background for the first time. Column 12
    // touches the box.
    const ImageView<const uint8_t> mask = reveal.next(boxAt(13, -3, 0), false);
    for (int x = 0; x < 64; ++x) {
        CHECK(mask.at(x, 8) == (x == 10 || x == 11 ? 1 : 0));
    }
}

TEST_CASE("ghosts: a mark lives for eight frames", "[postfx][unit]") {
    RevealMask reveal;
    reveal.next(boxAt(10, 0, 0), false);
    CHECK(marked(reveal.next(boxAt(30, -20, 0), false), 8) == 8);
    for (int frame = 1; frame < kRevealFrames; ++frame) {
        CHECK(marked(reveal.next(boxAt(30, 0, 0), false), 8) == 8);
    }
    CHECK(marked(reveal.next(boxAt(30, 0, 0), false), 8) == 0);
}

TEST_CASE("ghosts: marks move with their surface", "[postfx][unit]") {
    RevealMask reveal;
    reveal.next(boxAt(40, 0, 0), false);
    reveal.next(boxAt(20, 20, 0), false);  // columns 40 … 47 are uncovered
    const ImageView<const uint8_t> mask = reveal.next(boxAt(20, 0, 2), false);
    for (int x = 30; x < 64; ++x) {
        CHECK(mask.at(x, 3) == (x >= 38 && x < 46 ? 1 : 0));
    }
}

TEST_CASE("ghosts: a pan, a cut and a new size reveal nothing", "[postfx][unit]") {
    RevealMask reveal;
    reveal.next(boxAt(20, 0, 0), false);
    CHECK(marked(reveal.next(boxAt(24, -4, -4), false), 8) == 0);
    CHECK(marked(reveal.next(boxAt(40, 0, 0), true), 8) == 0);
    GBuffer small;
    small.resize(10, 10, {.motion = true});
    small.planes.motion = true;
    CHECK(marked(reveal.next(small, false), 5) == 0);
}

TEST_CASE("ghosts: a pixel without history is not marked", "[postfx][unit]") {
    RevealMask reveal;
    reveal.next(boxAt(10, 0, 0), false);
    GBuffer gbuffer = boxAt(30, 0, 0);
    for (int x = 0; x < 64; ++x) {
        gbuffer.motion.at(x, 8) = {kNoHistory, 0};
    }
    const ImageView<const uint8_t> mask = reveal.next(gbuffer, false);
    // The box has jumped: where it was is new, and what it shows is, but for its rim.
    CHECK(marked(mask, 8) == 0);
    CHECK(marked(mask, 6) == 8 + 6);
}

TEST_CASE("ghosts: only marked pixels that are off by more than eight codes count",
          "[postfx][unit]") {
    const Image<Rgb8> reference = flat(6, 1, 100);
    Image<Rgb8> output = flat(6, 1, 100);
    output.at(0, 0).r = 109;
    output.at(1, 0).g = 108;
    output.at(2, 0).b = 91;
    output.at(3, 0) = {0, 0, 0};
    Image<uint8_t> mask(6, 1);
    mask.at(0, 0) = mask.at(1, 0) = mask.at(2, 0) = mask.at(4, 0) = 1;
    CHECK(ghostPixels(view(output), view(reference), std::as_const(mask).view()) == 2);
}

TEST_CASE("metrics: recovery counts frames until the error stays down", "[postfx][unit]") {
    const double clean[] = {2.0, 2.1, 1.9};
    CHECK(recoveryFrames(clean, 2.0) == 0);
    const double one[] = {9.0, 2.0, 2.2, 2.0};
    CHECK(recoveryFrames(one, 2.0) == 1);
    const double relapse[] = {9.0, 2.0, 5.0, 2.0, 2.0};
    CHECK(recoveryFrames(relapse, 2.0) == 3);
    const double never[] = {9.0, 8.0, 7.0};
    CHECK(recoveryFrames(never, 2.0) == 3);
    const double exact[] = {9.0, 0.2, 0.0};
    CHECK(recoveryFrames(exact, 0.0) == 1);
    CHECK(recoveryFrames({}, 1.0) == 0);
}

}  // namespace still
