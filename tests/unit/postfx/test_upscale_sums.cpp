#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "postfx/internal/upscale_sums.h"

using namespace still;
using namespace still::upscale;

namespace {

using Accumulate = SumsResult (*)(const Job&, const TileRect&, Stillness, bool) noexcept;

/// A frame's planes and an image's sums.
struct Bench {
    int width, height, image_width, image_height;
    Image<uint16_t> colour[3], id, shown[3], count, frames;
    Image<uint32_t> sum[3];
    Image<uint8_t> shown_count, light_age;
    std::vector<uint32_t> change_age = std::vector<uint32_t>(size_t(kSurfaceMask) + 1, 255);
    Job job;

    Bench(int width_in, int height_in, int image_width_in, int image_height_in)
        : width(width_in),
          height(height_in),
          image_width(image_width_in),
          image_height(image_height_in) {
        id.resize(width, height);
        light_age.resize(width, height);
        shown_count.resize(image_width, image_height);
        count.resize(image_width, image_height);
        frames.resize(image_width, image_height);
        job.frame.width = width;
        job.frame.height = height;
        job.frame.stride = id.view().stride;
        job.frame.now.id = id.view().data;
        job.x = {width, image_width};
        job.y = {height, image_height};
        job.stride = count.view().stride;
        job.sums.count = count.view().data;
        job.sums.frames = frames.view().data;
        job.shown_count = shown_count.view().data;
        for (int c = 0; c < 3; ++c) {
            colour[c].resize(width, height);
            sum[c].resize(image_width, image_height);
            shown[c].resize(image_width, image_height);
            job.frame.now.colour[c] = colour[c].view().data;
            job.sums.colour[c] = sum[c].view().data;
            job.shown[c] = shown[c].view().data;
        }
    }

    void place(int x_fx8, int y_fx8) {
        job.frame.record.jitter_x_fx8 = x_fx8;
        job.frame.record.jitter_y_fx8 = y_fx8;
    }

    template <class Draw>
    void draw(Draw&& draw) {
        for (int c = 0; c < 3; ++c) {
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    colour[c].at(x, y) = uint16_t(draw());
                }
            }
        }
    }

    /// All tiles.
    std::vector<SumsResult> add(Accumulate accumulate, Stillness stillness, bool restart) {
        std::vector<SumsResult> results;
        for (int y = 0; y < height; y += kTileSize) {
            for (int x = 0; x < width; x += kTileSize) {
                const TileRect tile{x, y, std::min(x + kTileSize, width),
                                    std::min(y + kTileSize, height)};
                results.push_back(accumulate(job, tile, stillness, restart));
            }
        }
        return results;
    }
};

/// Widths and heights of a frame and its image: ratios of 1, 1.3, 1.5, 2, 3 and rounded ones.
constexpr std::array<int, 4> kSizes[] = {{70, 66, 70, 66},    {70, 20, 91, 26},  {67, 40, 100, 60},
                                         {130, 65, 260, 130}, {65, 33, 195, 99}, {1, 1, 3, 2},
                                         {64, 64, 191, 128},  {71, 9, 72, 26}};

}  // namespace

TEST_CASE("upscale: every output pixel belongs to one tile, and every sample to one output pixel",
          "[postfx][unit]") {
    std::mt19937 random(1);
    for (const auto& [width, height, image_width, image_height] : kSizes) {
        Bench bench(width, height, image_width, image_height);
        std::vector<int> owners(size_t(image_width), 0);
        for (int x = 0; x < width; x += kTileSize) {
            const TileRect out =
                outputRect(bench.job, {x, 0, std::min(x + kTileSize, width), height});
            CHECK((out.y0 == 0 && out.y1 == image_height));
            for (int i = out.x0; i < out.x1; ++i) {
                ++owners[size_t(i)];
                CHECK((pixelUnder(bench.job.x, i) >= x && pixelUnder(bench.job.x, i) < x + 64));
            }
        }
        CHECK(std::all_of(owners.begin(), owners.end(), [](int n) { return n == 1; }));
        for (int i = 0; i < 20; ++i) {
            const int jitter_fx8 = int(random() % 256) - 128;
            std::vector<int> samples(size_t(image_width), 0);
            for (int x = 0; x < width; ++x) {
                const int output = bench.job.x.outputOf(x, jitter_fx8);
                REQUIRE((output >= 0 && output < image_width));
                ++samples[size_t(output)];
            }
            CHECK(std::all_of(samples.begin(), samples.end(), [](int n) { return n <= 1; }));
        }
    }
}

TEST_CASE("upscale: a still output pixel is the mean of exactly the samples that fell into it",
          "[postfx][unit]") {
    for (const auto& [width, height, image_width, image_height] : kSizes) {
        Bench bench(width, height, image_width, image_height);
        bench.job.sample_cap = 400;
        bench.job.settled = 2;
        bench.job.sum_kernels = sumKernels(bestSimdTarget());
        std::mt19937 random(7);
        Image<uint64_t> sum(image_width, image_height);
        Image<uint32_t> samples(image_width, image_height);
        std::vector<SumsResult> results;
        for (int frame = 0; frame < 410; ++frame) {
            const int jx = int(random() % 256) - 128, jy = int(random() % 256) - 128;
            bench.place(jx, jy);
            bench.draw([&] { return random() % 8 == 0 ? 65535 : int(random() % 65536); });
            for (int y = 0; frame < 400 && y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const int i = int((x + 0.5 + jx / 256.0) * image_width / width);
                    const int j = int((y + 0.5 + jy / 256.0) * image_height / height);
                    sum.at(i, j) += bench.colour[1].at(x, y);
                    ++samples.at(i, j);
                }
            }
            results = bench.add(accumulateTile, Stillness::all, frame == 0);
            CHECK(results[0].finished == (frame >= 399));
        }
        CHECK_FALSE(results[0].changed);
        int wrong = 0;
        for (int y = 0; y < image_height; ++y) {
            for (int x = 0; x < image_width; ++x) {
                const uint32_t n = samples.at(x, y);
                wrong += bench.count.at(x, y) == n ? 0 : 1;
                wrong += n < 2 || bench.shown[1].at(x, y) == (sum.at(x, y) + n / 2) / n ? 0 : 1;
            }
        }
        CAPTURE(width, image_width);
        CHECK(wrong == 0);
    }
}

TEST_CASE("upscale: sums are the reference's, whatever moves or changes", "[postfx][unit]") {
    for (const auto& [width, height, image_width, image_height] : kSizes) {
        for (const SimdTarget target : availableSimdTargets()) {
            Bench plain(width, height, image_width, image_height);
            Bench fast(width, height, image_width, image_height);
            fast.job.sum_kernels = sumKernels(target);
            std::mt19937 random(19);
            for (int frame = 0; frame < 60; ++frame) {
                const auto seed = random();
                for (Bench* bench : {&plain, &fast}) {
                    std::mt19937 own(seed);
                    bench->job.sample_cap = frame % 23 < 20 ? 16 : 9;  // the ratio may change
                    bench->job.settled = 3;
                    bench->place(int(own() % 256) - 128, int(own() % 256) - 128);
                    bench->draw([&] { return int(own() % 65536); });
                    bench->change_age[3] = frame % 7 == 3 ? 0 : 255;
                    bench->job.frame.change_age = bench->change_age.data();
                    bench->job.frame.light_age =
                        frame % 5 == 1 ? bench->light_age.view().data : nullptr;
                    const int moving_x = int(own() % unsigned(width)),
                              every = frame % 3 == 0 ? 1 : 9;
                    for (int y = 0; y < height; ++y) {
                        for (int x = 0; x < width; ++x) {
                            const bool moved = every == 1 && x == moving_x && y % 3 == 0;
                            bench->id.at(x, y) = uint16_t((x / 9 + 1) | (moved ? kMovedBit : 0));
                            bench->light_age.at(x, y) = own() % 50 == 0 ? 2 : 255;
                        }
                    }
                }
                const Stillness stillness = frame % 2 == 0 || frame % 5 == 1 || frame % 7 == 3
                                                ? Stillness::tested
                                                : Stillness::all;
                const auto wanted = plain.add(accumulateTileReference, stillness, frame % 29 == 0);
                const auto got = fast.add(accumulateTile, stillness, frame % 29 == 0);
                for (size_t tile = 0; tile < wanted.size(); ++tile) {
                    CHECK(got[tile].finished == wanted[tile].finished);
                    CHECK(got[tile].settled == wanted[tile].settled);
                    CHECK(got[tile].changed == wanted[tile].changed);
                }
                int wrong = 0;
                for (int y = 0; y < image_height; ++y) {
                    for (int x = 0; x < image_width; ++x) {
                        const int n = plain.count.at(x, y);
                        wrong += fast.count.at(x, y) == n ? 0 : 1;
                        wrong += fast.frames.at(x, y) == plain.frames.at(x, y) ? 0 : 1;
                        wrong += fast.shown_count.at(x, y) == plain.shown_count.at(x, y) ? 0 : 1;
                        for (int c = 0; c < 3; ++c) {
                            wrong += fast.shown[c].at(x, y) == plain.shown[c].at(x, y) ? 0 : 1;
                            wrong +=
                                n == 0 || fast.sum[c].at(x, y) == plain.sum[c].at(x, y) ? 0 : 1;
                        }
                    }
                }
                CAPTURE(width, image_width, frame, int(target));
                REQUIRE(wrong == 0);
            }
        }
    }
}
