#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "postfx/internal/spatial_upscale_kernel.h"
#include "postfx/spatial_upscale.h"

using namespace still;

namespace {

struct Picture {
    Image<uint16_t> channel[3];

    Picture(int width, int height) {
        for (Image<uint16_t>& plane : channel) {
            plane.resize(width, height);
        }
    }
    ColourPlanes planes() const {
        return {channel[0].view(), channel[1].view(), channel[2].view()};
    }
    ColourTargets targets() { return {channel[0].view(), channel[1].view(), channel[2].view()}; }

    template <class Light>
    void fill(Light&& light) {
        for (int c = 0; c < 3; ++c) {
            for (int y = 0; y < channel[c].height(); ++y) {
                for (int x = 0; x < channel[c].width(); ++x) {
                    channel[c].at(x, y) = uint16_t(light(c, x, y));
                }
            }
        }
    }
};

constexpr EnlargeFilter kFilters[] = {EnlargeFilter::bicubic, EnlargeFilter::edge};

Picture enlarged(const Picture& in, EnlargeFilter filter, int width, int height,
                 SimdTarget simd = SimdTarget::scalar, int threads = 1) {
    Workers workers(threads);
    Picture out(width, height);
    SpatialUpscaler().run(in.planes(), filter, out.targets(), simd, workers);
    return out;
}

/// The bicubic's own words, in double and without its tables.
double bicubicAt(const Picture& in, int c, int x, int y, int width, int height) {
    const auto kernel = [](double d) {
        d = std::abs(d);
        return d < 1 ? (1.5 * d - 2.5) * d * d + 1
                     : (d < 2 ? ((-0.5 * d + 2.5) * d - 4) * d + 2 : 0);
    };
    const Image<uint16_t>& plane = in.channel[c];
    const double px = (x + 0.5) * plane.width() / width - 0.5;
    const double py = (y + 0.5) * plane.height() / height - 0.5;
    double sum = 0;
    for (int j = int(std::floor(py)) - 1; j <= int(std::floor(py)) + 2; ++j) {
        for (int i = int(std::floor(px)) - 1; i <= int(std::floor(px)) + 2; ++i) {
            const int column = std::clamp(i, 0, plane.width() - 1);
            const int row = std::clamp(j, 0, plane.height() - 1);
            sum += kernel(px - i) * kernel(py - j) * std::sqrt(double(plane.at(column, row)));
        }
    }
    return std::max(sum, 0.0) * std::max(sum, 0.0);
}

}  // namespace

TEST_CASE("spatial_upscale: bicubic is Catmull-Rom of the roots of light", "[postfx][unit]") {
    std::mt19937 random(3);
    Picture in(9, 7);
    in.fill([&](int, int, int) { return int(random() % 65536); });
    const Picture out = enlarged(in, EnlargeFilter::bicubic, 20, 11);
    for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < 11; ++y) {
            for (int x = 0; x < 20; ++x) {
                const double wanted = std::min(bicubicAt(in, c, x, y, 20, 11), 65535.0);
                CHECK(out.channel[c].at(x, y) == Approx(wanted).margin(1).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE("spatial_upscale: the same size and a flat picture stay as they are", "[postfx][unit]") {
    std::mt19937 random(5);
    Picture in(13, 6), flat(5, 4);
    in.fill([&](int, int, int) { return int(random() % 65536); });
    flat.fill([](int c, int, int) { return 1 + 4096 * c; });
    for (const EnlargeFilter filter : kFilters) {
        CAPTURE(int(filter));
        const Picture stretched = enlarged(flat, filter, 15, 9);
        for (int c = 0; c < 3; ++c) {
            for (int y = 0; y < 9; ++y) {
                for (int x = 0; x < 15; ++x) {
                    CHECK(stretched.channel[c].at(x, y) == 1 + 4096 * c);
                }
            }
        }
    }
    const Picture same = enlarged(in, EnlargeFilter::bicubic, 13, 6);
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 13; ++x) {
            CHECK(same.channel[1].at(x, y) == in.channel[1].at(x, y));
        }
    }
}

TEST_CASE(
    "spatial_upscale: the edge filter stays within the four pixels around, and follows a "
    "slanted edge better than bicubic",
    "[postfx][unit]") {
    constexpr int kIn = 32, kOut = 64;
    Picture in(kIn, kIn);
    // Coverage of a half plane that rises by 1 in 3, by 16 × 16 samples a pixel.
    const auto covered = [](int size, int x, int y) {
        int inside = 0;
        for (int k = 0; k < 256; ++k) {
            const double u = (x + (k % 16 + 0.5) / 16) / size, v = (y + (k / 16 + 0.5) / 16) / size;
            inside += v > 0.3 + u / 3 ? 1 : 0;
        }
        return inside * 16;
    };
    in.fill([&](int, int x, int y) { return covered(kIn, x, y); });
    double error[2] = {};
    for (const EnlargeFilter filter : kFilters) {
        const Picture out = enlarged(in, filter, kOut, kOut);
        for (int y = 0; y < kOut; ++y) {
            for (int x = 0; x < kOut; ++x) {
                const double miss = std::sqrt(double(out.channel[0].at(x, y))) -
                                    std::sqrt(double(covered(kOut, x, y)));
                error[int(filter)] += miss * miss;
                CHECK(out.channel[0].at(x, y) <= (filter == EnlargeFilter::edge ? 4096 : 65535));
            }
        }
    }
    CHECK(error[1] < error[0]);
}

TEST_CASE("spatial_upscale: every SIMD target and number of threads gives the scalar's bytes",
          "[postfx][unit]") {
    std::mt19937 random(11);
    for (const auto& [width, height, to_width, to_height] :
         {std::array{1, 1, 3, 2}, {37, 5, 37, 9}, {70, 33, 131, 66}, {64, 20, 192, 60}}) {
        Picture in(width, height);
        in.fill([&](int, int x, int) {
            const int bright = int(random() % 65536);
            return x % 5 == 0 ? 0 : (random() % 3 == 0 ? 65535 : bright);
        });
        for (const EnlargeFilter filter : kFilters) {
            const Picture expected = enlarged(in, filter, to_width, to_height);
            for (const SimdTarget target : availableSimdTargets()) {
                const Picture out = enlarged(in, filter, to_width, to_height, target, 3);
                int differing = 0;
                for (int c = 0; c < 3; ++c) {
                    for (int y = 0; y < to_height; ++y) {
                        const uint16_t* row = expected.channel[c].view().row(y);
                        differing +=
                            std::equal(row, row + to_width, out.channel[c].view().row(y)) ? 0 : 1;
                    }
                }
                CAPTURE(int(filter), int(target), to_width);
                CHECK(differing == 0);
            }
        }
    }
}

TEST_CASE("spatial_upscale: a picture of whole vectors leaves what lies beside it alone",
          "[postfx][unit]") {
    std::mt19937 random(9);
    Picture in(40, 30);
    in.fill([&](int, int, int) { return int(random() % 65536); });
    Workers workers(1);
    for (const EnlargeFilter filter : kFilters) {
        for (const SimdTarget simd : availableSimdTargets()) {
            Picture out(128, 48);
            out.fill([](int, int, int) { return 777; });
            ColourTargets left = out.targets();
            left.red.width = left.green.width = left.blue.width = 64;
            SpatialUpscaler().run(in.planes(), filter, left, simd, workers);
            int changed = 0;
            for (const Image<uint16_t>& plane : out.channel) {
                for (int y = 0; y < 48; ++y) {
                    for (int x = 64; x < 128; ++x) {
                        changed += plane.at(x, y) != 777 ? 1 : 0;
                    }
                }
            }
            INFO(name(simd));
            CHECK(changed == 0);
        }
    }
}
