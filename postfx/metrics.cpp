#include "postfx/metrics.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace still {
namespace {

constexpr int kWindow = 11;
constexpr double kC1 = (0.01 * 255) * (0.01 * 255);
constexpr double kC2 = (0.03 * 255) * (0.03 * 255);

/// e^(−d² / (2 · 1.5²)) for d = −5 … 5, written out so that no library function decides its bits.
constexpr std::array<double, kWindow> kGauss{
    0.0038659201394728076, 0.028565500784550377, 0.1353352832366127,
    0.41111229050718745,   0.8007374029168081,   1.0,
    0.8007374029168081,    0.41111229050718745,  0.1353352832366127,
    0.028565500784550377,  0.0038659201394728076};

/// The taps along an axis of `size` pixels, their sum 1.
struct Taps {
    std::array<double, kWindow> weight{};
    int count = 0;
    int positions = 0;  ///< how many windows fit
};

Taps tapsFor(int size) {
    Taps taps;
    taps.count = std::min(size, kWindow);
    taps.positions = size - taps.count + 1;
    const int first = (kWindow - taps.count) / 2;
    double sum = 0;
    for (int i = 0; i < taps.count; ++i) {
        sum += kGauss[size_t(first + i)];
    }
    for (int i = 0; i < taps.count; ++i) {
        taps.weight[size_t(i)] = kGauss[size_t(first + i)] / sum;
    }
    return taps;
}

/// First and second moments of a pair of pictures under the window.
struct Moments {
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    void add(const Moments& m, double weight) {
        a += m.a * weight;
        b += m.b * weight;
        aa += m.aa * weight;
        bb += m.bb * weight;
        ab += m.ab * weight;
    }
};

double luma(Rgb8 c) {
    return (299 * c.r + 587 * c.g + 114 * c.b) / 1000.0;
}

/// Moments of row `y` under the horizontal taps.
void filterRow(ImageView<const Rgb8> a, ImageView<const Rgb8> b, int y, const Taps& taps,
               std::vector<Moments>& pixels, std::vector<Moments>& out) {
    for (int x = 0; x < a.width; ++x) {
        const double va = luma(a.at(x, y));
        const double vb = luma(b.at(x, y));
        pixels[size_t(x)] = {va, vb, va * va, vb * vb, va * vb};
    }
    for (int x = 0; x < taps.positions; ++x) {
        Moments sum;
        for (int i = 0; i < taps.count; ++i) {
            sum.add(pixels[size_t(x + i)], taps.weight[size_t(i)]);
        }
        out[size_t(x)] = sum;
    }
}

double similarity(const Moments& m) {
    const double variance_a = m.aa - m.a * m.a;
    const double variance_b = m.bb - m.b * m.b;
    const double covariance = m.ab - m.a * m.b;
    const double top = (2 * m.a * m.b + kC1) * (2 * covariance + kC2);
    const double bottom = (m.a * m.a + m.b * m.b + kC1) * (variance_a + variance_b + kC2);
    return top / bottom;
}

/// Luma times 1000.
int64_t wholeLuma(Rgb8 c) {
    return 299 * c.r + 587 * c.g + 114 * c.b;
}

/// At most 2 · 255000² a pixel: 2^64 is enough for 140 million pixels.
uint64_t gradientEnergy(ImageView<const Rgb8> image) {
    uint64_t sum = 0;
    const auto add = [&](int64_t difference) { sum += uint64_t(difference * difference); };
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const int64_t here = wholeLuma(image.at(x, y));
            if (x + 1 < image.width) {
                add(wholeLuma(image.at(x + 1, y)) - here);
            }
            if (y + 1 < image.height) {
                add(wholeLuma(image.at(x, y + 1)) - here);
            }
        }
    }
    return sum;
}

}  // namespace

PixelError& PixelError::operator+=(const PixelError& other) {
    squared_sum += other.squared_sum;
    channels += other.channels;
    max_difference = std::max(max_difference, other.max_difference);
    return *this;
}

PixelError pixelError(ImageView<const Rgb8> a, ImageView<const Rgb8> b) {
    assert(a.width == b.width && a.height == b.height);
    PixelError error;
    error.channels = uint64_t(a.width) * uint64_t(a.height) * 3;
    const auto add = [&](int difference) {
        error.squared_sum += uint64_t(difference * difference);
        error.max_difference = std::max(error.max_difference, std::abs(difference));
    };
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const Rgb8 p = a.at(x, y);
            const Rgb8 q = b.at(x, y);
            add(p.r - q.r);
            add(p.g - q.g);
            add(p.b - q.b);
        }
    }
    return error;
}

double psnrDb(const PixelError& error) {
    if (error.squared_sum == 0) {
        return std::numeric_limits<double>::infinity();
    }
    return 10.0 * std::log10(255.0 * 255.0 * double(error.channels) / double(error.squared_sum));
}

double rmse(const PixelError& error) {
    return error.channels == 0 ? 0.0
                               : std::sqrt(double(error.squared_sum) / double(error.channels));
}

double ssim(ImageView<const Rgb8> a, ImageView<const Rgb8> b) {
    assert(a.width == b.width && a.height == b.height && !a.empty());
    const Taps across = tapsFor(a.width);
    const Taps down = tapsFor(a.height);
    std::vector<Moments> pixels(size_t(a.width));
    // The last rows under the horizontal taps: row y stands in slot y mod count.
    std::vector<std::vector<Moments>> rows(size_t(down.count),
                                           std::vector<Moments>(size_t(across.positions)));
    double sum = 0;
    for (int y = 0; y < a.height; ++y) {
        filterRow(a, b, y, across, pixels, rows[size_t(y % down.count)]);
        const int top = y - down.count + 1;
        for (int x = 0; top >= 0 && x < across.positions; ++x) {
            Moments window;
            for (int i = 0; i < down.count; ++i) {
                window.add(rows[size_t((top + i) % down.count)][size_t(x)], down.weight[size_t(i)]);
            }
            sum += similarity(window);
        }
    }
    return sum / (double(across.positions) * double(down.positions));
}

double sharpnessRatio(ImageView<const Rgb8> reference, ImageView<const Rgb8> test) {
    assert(reference.width == test.width && reference.height == test.height);
    const uint64_t wanted = gradientEnergy(reference), got = gradientEnergy(test);
    if (wanted == 0) {
        return got == 0 ? 1.0 : std::numeric_limits<double>::infinity();
    }
    return double(got) / double(wanted);
}

}  // namespace still
