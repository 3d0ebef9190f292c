// Residues and trails, against pictures in which they are put by hand.

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "postfx/metrics.h"

namespace still {
namespace {

using Grey = std::function<int(int x, int y)>;

Image<Rgb8> drawn(const Grey& grey) {
    Image<Rgb8> image(40, 20);
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 40; ++x) {
            const auto v = uint8_t(grey(x, y));
            image.at(x, y) = {v, uint8_t(v / 2), 10};
        }
    }
    return image;
}

ImageView<const Rgb8> view(const Image<Rgb8>& image) {
    return image.view();
}

/// A shadow 6 pixels wide on grey 180, its left edge at 3 · step; it leaves `trail` codes behind.
Image<Rgb8> shadowAt(int step, int trail = 0) {
    return drawn([=](int x, int) {
        const int left = 3 * step;
        if (x >= left && x < left + 6) {
            return 90;
        }
        return x < left && x >= left - 9 ? 180 - trail : 180;
    });
}

}  // namespace

TEST_CASE("metrics: residual is the share of the old picture that shows through",
          "[postfx][unit]") {
    const Image<Rgb8> before = drawn([](int x, int) { return 100 + 2 * x; });
    const Image<Rgb8> after = drawn([](int x, int) { return 40 + x / 2; });
    const auto mixed = [&](double share) {
        return drawn([&](int x, int y) {
            return int(after.at(x, y).r + share * (before.at(x, y).r - after.at(x, y).r) + 0.5);
        });
    };
    CHECK(residualShare(view(before), view(before), view(after)) == Approx(1));
    CHECK(residualShare(view(after), view(before), view(after)) == 0);
    CHECK(residualShare(view(mixed(0.25)), view(before), view(after)) == Approx(0.25).margin(0.01));
    CHECK(residualShare(view(mixed(0.02)), view(before), view(after)) == Approx(0.02).margin(0.01));
    CHECK(residualShare(view(before), view(after), view(after)) == 0);

    // Noise of ± 20 codes, a checkerboard, is no residual.
    const Image<Rgb8> noisy =
        drawn([&](int x, int y) { return after.at(x, y).r + ((x + y) % 2 == 0 ? 20 : -20); });
    CHECK(std::abs(residualShare(view(noisy), view(before), view(after))) < 0.01);
}

TEST_CASE("metrics: the mean of pictures is that of their codes", "[postfx][unit]") {
    PictureMean mean;
    mean.add(view(drawn([](int x, int) { return x; })));
    mean.add(view(drawn([](int x, int y) { return x + y; })));
    CHECK(mean.at(7, 3, 0) == 8.5);
    CHECK(mean.at(7, 3, 2) == 10);
}

TEST_CASE("metrics: a trail is what a shadow that has gone leaves, and nothing else",
          "[postfx][unit]") {
    std::vector<Image<Rgb8>> images;
    for (int step = 1; step <= 6; ++step) {
        images.push_back(shadowAt(step));
    }
    std::vector<ImageView<const Rgb8>> references;
    for (const Image<Rgb8>& image : images) {
        references.push_back(view(image));
    }
    const auto trailOf = [&](const Image<Rgb8>& picture) {
        PictureMean mean;
        mean.add(view(picture));
        return trailCodes(references, mean);
    };
    CHECK(trailOf(shadowAt(6)) == 0);
    CHECK(trailOf(shadowAt(6, 13)) == 13);
    // Brighter where it was darker is no trail.
    CHECK(trailOf(shadowAt(6, -13)) == 0);
    // In the shadow, light that has gone is a trail, too; darker than it is none.
    const auto with = [](int left, int right, int grey) {
        return drawn([=](int x, int) {
            return x >= left && x < right ? grey : x >= 18 && x < 24 ? 90 : 180;
        });
    };
    CHECK(trailOf(with(18, 24, 120)) == 30);
    CHECK(trailOf(with(18, 24, 20)) == 0);
    // Where nothing ever was, or something came or went since the last reference, nothing counts.
    CHECK(trailOf(with(0, 3, 50)) == 0);
    CHECK(trailOf(with(24, 40, 50)) == 0);
    CHECK(trailOf(with(15, 18, 100)) == 0);
    CHECK(trailOf(with(14, 15, 100)) == 80);
    CHECK(trailCodes(std::span(references).last(2), {}) == 0);
}

}  // namespace still
