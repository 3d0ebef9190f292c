#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "postfx/metrics.h"

namespace still {
namespace {

Image<Rgb8> noise(int width, int height, uint32_t seed) {
    std::mt19937 random(seed);
    Image<Rgb8> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const uint32_t bits = random();
            image.at(x, y) = {uint8_t(bits), uint8_t(bits >> 8), uint8_t(bits >> 16)};
        }
    }
    return image;
}

Image<Rgb8> flat(int width, int height, uint8_t grey) {
    Image<Rgb8> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y) = {grey, grey, grey};
        }
    }
    return image;
}

ImageView<const Rgb8> view(const Image<Rgb8>& image) {
    return image.view();
}

double luma(Rgb8 c) {
    return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
}

/// The paper's formula, one window at a time, with the two-dimensional Gaussian.
double plainSsim(ImageView<const Rgb8> a, ImageView<const Rgb8> b) {
    double total = 0;
    int windows = 0;
    for (int top = 0; top + 11 <= a.height; ++top) {
        for (int left = 0; left + 11 <= a.width; ++left, ++windows) {
            double weights = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
            for (int j = 0; j < 11; ++j) {
                for (int i = 0; i < 11; ++i) {
                    const double d2 = (i - 5) * (i - 5) + (j - 5) * (j - 5);
                    const double w = std::exp(-d2 / (2 * 1.5 * 1.5));
                    const double p = luma(a.at(left + i, top + j));
                    const double q = luma(b.at(left + i, top + j));
                    weights += w;
                    ma += w * p;
                    mb += w * q;
                    aa += w * p * p;
                    bb += w * q * q;
                    ab += w * p * q;
                }
            }
            ma /= weights;
            mb /= weights;
            const double va = aa / weights - ma * ma;
            const double vb = bb / weights - mb * mb;
            const double cov = ab / weights - ma * mb;
            const double c1 = 6.5025, c2 = 58.5225;
            total +=
                (2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
        }
    }
    return total / windows;
}

}  // namespace

TEST_CASE("metrics: identical pictures have no error", "[postfx][unit]") {
    const Image<Rgb8> a = noise(37, 23, 1);
    const PixelError error = pixelError(view(a), view(a));
    CHECK(error.identical());
    CHECK(error.squared_sum == 0);
    CHECK(error.channels == 37 * 23 * 3);
    CHECK(std::isinf(psnrDb(error)));
    CHECK(ssim(view(a), view(a)) == Approx(1.0).margin(1e-12));
}

TEST_CASE("metrics: one channel that is off by ten is found and weighs a hundred",
          "[postfx][unit]") {
    Image<Rgb8> a = flat(16, 16, 100);
    const Image<Rgb8> b = flat(16, 16, 100);
    a.at(15, 15).b = 110;
    const PixelError error = pixelError(view(a), view(b));
    CHECK(error.max_difference == 10);
    CHECK(error.squared_sum == 100);
    CHECK(psnrDb(error) == Approx(10 * std::log10(255.0 * 255.0 * 768 / 100)));
    CHECK(pixelError(view(b), view(a)).squared_sum == 100);
}

TEST_CASE("metrics: errors of frames add up to the error of all pixels", "[postfx][unit]") {
    const Image<Rgb8> a = flat(8, 4, 0);
    PixelError sum = pixelError(view(a), view(flat(8, 4, 1)));
    sum += pixelError(view(a), view(flat(8, 4, 3)));
    CHECK(sum.channels == 2 * 96);
    CHECK(sum.squared_sum == 96 * (1 + 9));
    CHECK(sum.max_difference == 3);
}

TEST_CASE("metrics: black against white is 0 dB", "[postfx][unit]") {
    const PixelError error = pixelError(view(flat(5, 5, 0)), view(flat(5, 5, 255)));
    CHECK(psnrDb(error) == Approx(0.0).margin(1e-12));
    CHECK(error.max_difference == 255);
}

TEST_CASE("metrics: SSIM is that of the paper's formula, window by window", "[postfx][unit]") {
    const Image<Rgb8> a = noise(29, 17, 2);
    Image<Rgb8> b = noise(29, 17, 2);
    std::mt19937 random(3);
    for (int i = 0; i < 200; ++i) {
        Rgb8& pixel = b.at(int(random() % 29), int(random() % 17));
        pixel.g = uint8_t(pixel.g / 2 + random() % 100);
    }
    CHECK(ssim(view(a), view(b)) == Approx(plainSsim(view(a), view(b))).epsilon(1e-9));
}

TEST_CASE("metrics: SSIM of pictures smaller than its window is defined", "[postfx][unit]") {
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 40}, {40, 2}, {10, 11}}) {
        const Image<Rgb8> a = noise(width, height, 4);
        const Image<Rgb8> b = noise(width, height, 5);
        CHECK(ssim(view(a), view(a)) == Approx(1.0).margin(1e-12));
        const double different = ssim(view(a), view(b));
        CHECK(different < 1.0);
        CHECK(different >= -1.0);
    }
}

}  // namespace still
