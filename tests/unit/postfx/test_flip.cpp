// FLIP against the paper's formulas written plainly, and against constant colours by hand.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "postfx/flip.h"

namespace still {
namespace {

Image<Rgb8> flat(Rgb8 colour, int width = 16, int height = 12) {
    Image<Rgb8> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y) = colour;
        }
    }
    return image;
}

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

double mean(const Image<Rgb8>& a, const Image<Rgb8>& b, double pixels_per_degree = 67.0206) {
    Workers workers(1);
    return meanFlip(a.view(), b.view(), {.pixels_per_degree = pixels_per_degree}, workers);
}

using Vector = std::array<double, 3>;
using Picture = std::vector<Vector>;  // row by row

Vector times(const double (&m)[3][3], Vector v) {
    Vector out{};
    for (size_t i = 0; i < 3; ++i) {
        out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    }
    return out;
}

// IEC 61966-2-1, four digits, and the inverse by Cramer's rule.
constexpr double kToXyz[3][3] = {
    {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};

Vector solveRgb(Vector xyz) {
    const auto det = [](const double(&m)[3][3]) {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    Vector out{};
    for (size_t column = 0; column < 3; ++column) {
        double m[3][3];
        for (size_t i = 0; i < 3; ++i) {
            for (size_t j = 0; j < 3; ++j) {
                m[i][j] = j == column ? xyz[i] : kToXyz[i][j];
            }
        }
        out[column] = det(m) / det(kToXyz);
    }
    return out;
}

double linear(int code) {
    const double v = code / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

Vector relativeXyz(Vector rgb) {
    const Vector white = times(kToXyz, {1, 1, 1});
    Vector xyz = times(kToXyz, rgb);
    for (size_t i = 0; i < 3; ++i) {
        xyz[i] /= white[i];
    }
    return xyz;
}

Vector huntLab(Vector rgb) {
    Vector f = relativeXyz(rgb);
    for (double& t : f) {
        t = t > 216.0 / 24389 ? std::cbrt(t) : t * 841 / 108 + 4.0 / 29;
    }
    const double lightness = 116 * f[1] - 16;
    return {lightness, lightness * 5 * (f[0] - f[1]), lightness * 2 * (f[1] - f[2])};
}

double colourError(Vector rgb_a, Vector rgb_b) {
    const auto power = [](Vector a, Vector b) {
        const double d = std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
        return std::pow(d, 0.7);
    };
    const double most = power(huntLab({0, 1, 0}), huntLab({0, 0, 1}));
    const double d = power(huntLab(rgb_a), huntLab(rgb_b)) / most;
    return d < 0.4 ? d * 0.95 / 0.4 : 0.95 + (d - 0.4) / 0.6 * 0.05;
}

Vector linearOf(Rgb8 c) {
    return {linear(c.r), linear(c.g), linear(c.b)};
}

/// Σ over a square window of kernel(dx, dy) · value, borders repeated.
template <class Value, class Weight>
double gathered(int width, int height, int x, int y, int radius, Value&& value, Weight&& weight) {
    double sum = 0;
    for (int j = -radius; j <= radius; ++j) {
        for (int i = -radius; i <= radius; ++i) {
            const int px = std::clamp(x + i, 0, width - 1), py = std::clamp(y + j, 0, height - 1);
            sum += weight(i, j) * value(size_t(py * width + px));
        }
    }
    return sum;
}

/// The paper, with two-dimensional kernels.
class PlainFlip {
  public:
    PlainFlip(int width, int height, double pixels_per_degree)
        : width_(width), height_(height), ppd_(pixels_per_degree) {}

    double mean(const Image<Rgb8>& a, const Image<Rgb8>& b) const {
        const Picture pa = opponent(a), pb = opponent(b);
        double sum = 0;
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                const double colour = colourError(seen(pa, x, y), seen(pb, x, y));
                double feature = 0;
                for (bool point : {false, true}) {
                    feature = std::max(
                        feature, std::abs(strength(pa, x, y, point) - strength(pb, x, y, point)));
                }
                sum += std::pow(colour, 1 - std::sqrt(feature / std::sqrt(2.0)));
            }
        }
        return sum / (width_ * height_);
    }

  private:
    Picture opponent(const Image<Rgb8>& image) const {
        Picture out;
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                const Vector c = relativeXyz(linearOf(image.at(x, y)));
                out.push_back({116 * c[1] - 16, 500 * (c[0] - c[1]), 200 * (c[1] - c[2])});
            }
        }
        return out;
    }

    /// Filtered, as linear RGB.
    Vector seen(const Picture& picture, int x, int y) const {
        constexpr double kPi = 3.14159265358979323846;
        const double terms[3][4] = {
            {1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
        const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd_));
        Vector c{};
        for (size_t channel = 0; channel < 3; ++channel) {
            const auto& t = terms[channel];
            const auto kernel = [&](int i, int j) {
                const double r2 = (i * i + j * j) / (ppd_ * ppd_);
                return t[0] * std::sqrt(kPi / t[1]) * std::exp(-kPi * kPi * r2 / t[1]) +
                       t[2] * std::sqrt(kPi / t[3]) * std::exp(-kPi * kPi * r2 / t[3]);
            };
            const double sum = gathered(
                width_, height_, x, y, radius, [](size_t) { return 1.0; }, kernel);
            c[channel] = gathered(
                             width_, height_, x, y, radius,
                             [&](size_t at) { return picture[at][channel]; }, kernel) /
                         sum;
        }
        const Vector white = times(kToXyz, {1, 1, 1});
        const double luminance = (c[0] + 16) / 116;
        Vector rgb = solveRgb({(luminance + c[1] / 500) * white[0], luminance * white[1],
                               (luminance - c[2] / 200) * white[2]});
        for (double& channel : rgb) {
            channel = std::clamp(channel, 0.0, 1.0);
        }
        return rgb;
    }

    /// Of the edge or point at (x, y).
    double strength(const Picture& picture, int x, int y, bool point) const {
        const double sigma = 0.5 * 0.082 * ppd_;
        const int radius = int(std::ceil(3 * sigma));
        double squared = 0;
        for (bool down : {false, true}) {
            const auto kernel = [&](int i, int j) {
                const double g = std::exp(-(i * i + j * j) / (2 * sigma * sigma));
                const int d = down ? j : i;
                return (point ? d * d / (sigma * sigma) - 1 : -d) * g;
            };
            double above = 0, below = 0;
            for (int j = -radius; j <= radius; ++j) {
                for (int i = -radius; i <= radius; ++i) {
                    (kernel(i, j) > 0 ? above : below) += std::abs(kernel(i, j));
                }
            }
            const double got = gathered(
                width_, height_, x, y, radius,
                [&](size_t at) { return (picture[at][0] + 16) / 116; },
                [&](int i, int j) {
                    const double k = kernel(i, j);
                    return k / (k > 0 ? above : below);
                });
            squared += got * got;
        }
        return std::sqrt(squared);
    }

    int width_, height_;
    double ppd_;
};

}  // namespace

TEST_CASE("flip: equal pictures do not differ", "[postfx][unit]") {
    const Image<Rgb8> a = noise(31, 22, 1);
    CHECK(mean(a, a) == 0.0);
}

TEST_CASE("flip: two flat colours differ by their distance alone", "[postfx][unit]") {
    // Black and white are 100 apart. Green (87.7, −75.6, 73.0) and blue (32.3, 25.6, −34.8), the
    // most distant pair, are 55.4 + 147.9 apart. (100 / 203.3)^0.7 = 0.6086 is above the knee at
    // 0.4: 0.95 + 0.05 · 0.2086 / 0.6 = 0.9674.
    CHECK(mean(flat({0, 0, 0}), flat({255, 255, 255})) == Approx(0.9674).margin(1e-4));
    const Rgb8 colours[] = {{0, 0, 0},    {255, 255, 255}, {255, 0, 0},    {0, 255, 0},
                            {0, 0, 255},  {128, 128, 128}, {120, 130, 90}, {121, 130, 90},
                            {10, 10, 12}, {250, 240, 10}};
    for (Rgb8 a : colours) {
        for (Rgb8 b : colours) {
            CHECK(mean(flat(a), flat(b)) ==
                  Approx(colourError(linearOf(a), linearOf(b))).margin(1e-3));
        }
    }
    CHECK(mean(flat({0, 255, 0}), flat({0, 0, 255})) == Approx(1.0).margin(1e-4));
}

TEST_CASE("flip: separated filters equal the paper's two-dimensional ones", "[postfx][unit]") {
    for (const double pixels_per_degree : {67.0206, 25.0}) {
        const Image<Rgb8> a = noise(23, 17, 2);
        Image<Rgb8> b = noise(23, 17, 2);
        std::mt19937 random(3);
        for (int i = 0; i < 60; ++i) {
            b.at(int(random() % 23), int(random() % 17)) = {uint8_t(random()), 40, 90};
        }
        const double wanted = PlainFlip(23, 17, pixels_per_degree).mean(a, b);
        CHECK(wanted > 0.05);
        CHECK(mean(a, b, pixels_per_degree) == Approx(wanted).margin(1e-3));
    }
}

TEST_CASE("flip: reference and test may be swapped", "[postfx][unit]") {
    const Image<Rgb8> a = noise(20, 20, 4), b = noise(20, 20, 5);
    CHECK(mean(a, b) == Approx(mean(b, a)).epsilon(1e-12));
}

TEST_CASE("flip: an edge that is lost weighs more than the same error spread out",
          "[postfx][unit]") {
    Image<Rgb8> edge(40, 40);
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) {
            const auto v = uint8_t(x < 20 ? 110 : 146);
            edge.at(x, y) = {v, v, v};
        }
    }
    const Image<Rgb8> middle = flat({128, 128, 128}, 40, 40);
    const Image<Rgb8> off = flat({146, 146, 146}, 40, 40);
    Workers workers(1);
    const Image<float> lost = flipMap(edge.view(), middle.view(), {}, workers);
    const Image<float> spread = flipMap(off.view(), middle.view(), {}, workers);
    CHECK(lost.at(22, 20) > spread.at(22, 20));
    CHECK(lost.at(39, 20) == Approx(spread.at(39, 20)).margin(0.01));
}

TEST_CASE("flip: threads do not change the result", "[postfx][determinism]") {
    const Image<Rgb8> a = noise(70, 50, 6), b = noise(70, 50, 7);
    Workers one(1), three(3);
    CHECK(meanFlip(a.view(), b.view(), {}, one) == meanFlip(a.view(), b.view(), {}, three));
}

TEST_CASE("flip: a single pixel is a picture", "[postfx][unit]") {
    CHECK(mean(flat({9, 9, 9}, 1, 1), flat({9, 9, 9}, 1, 1)) == 0.0);
    CHECK(mean(flat({0, 0, 0}, 1, 1), flat({255, 255, 255}, 1, 1)) > 0.9);
}

}  // namespace still
