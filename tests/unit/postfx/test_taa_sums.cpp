// Kernels that sum still pixels: all targets against the scalar twin, on whatever may stand in the
// planes.

#include <array>
#include <catch2/catch.hpp>
#include <random>

#include "postfx/internal/kernels.h"
#include "postfx/internal/rules.h"

namespace {

using namespace still;
using namespace still::taa;

constexpr int kWidth = 150, kHeight = 70;  // tiles that are whole, narrow and low

struct Planes {
    std::array<Image<uint16_t>, 3> colour, mean, shown;
    std::array<Image<int8_t>, 3> rest;
    Image<uint8_t> count, shown_count;
    Image<uint16_t> id;
    std::vector<uint32_t> change_age;
    Job job;

    /// `spread`: counts of a row lie within so many of each other.
    Planes(uint32_t seed, int cap, int spread, bool changes) {
        std::mt19937 random(seed);
        const auto below = [&](int n) { return int(random() % uint32_t(n)); };
        for (auto* planes : {&colour, &mean, &shown}) {
            for (Image<uint16_t>& plane : *planes) {
                plane.resize(kWidth, kHeight);
            }
        }
        for (Image<int8_t>& plane : rest) {
            plane.resize(kWidth, kHeight);
        }
        count.resize(kWidth, kHeight);
        shown_count.resize(kWidth, kHeight);
        id.resize(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y) {
            const int base = below(cap + 1);
            const bool busy = below(4) == 0;
            for (int x = 0; x < kWidth; ++x) {
                const int n = std::min(base + below(spread), cap);
                count.at(x, y) = uint8_t(n);
                shown_count.at(x, y) = uint8_t(below(9));
                id.at(x, y) = uint16_t(below(5) + (busy && below(30) == 0 ? kMovedBit : 0));
                for (size_t c = 0; c < 3; ++c) {
                    const int kind = below(4);
                    colour[c].at(x, y) = uint16_t(kind == 0 ? 0 : kind == 1 ? 65535 : random());
                    mean[c].at(x, y) = uint16_t(below(3) == 0 ? 65535 * below(2) : random());
                    shown[c].at(x, y) = uint16_t(below(3) == 0 ? 65535 * below(2) : random());
                    // What addSample() leaves: −n / 2 … n − 1 − n / 2.
                    rest[c].at(x, y) = int8_t(n == 0 ? 0 : below(n) - n / 2);
                }
            }
        }
        if (changes) {
            change_age.assign(size_t(kSurfaceMask) + 1, 255);
            change_age[3] = 0;
            job.change_age = change_age.data();
        }
        job.width = kWidth;
        job.height = kHeight;
        job.stride = id.view().stride;
        job.now.id = id.view().data;
        for (size_t c = 0; c < 3; ++c) {
            job.now.colour[c] = colour[c].view().data;
            job.sums.mean[c] = mean[c].view().data;
            job.sums.rest[c] = rest[c].view().data;
            job.shown[c] = shown[c].view().data;
        }
        job.sums.count = count.view().data;
        job.shown_count = shown_count.view().data;
        job.sample_cap = cap;
        job.settled = std::min(kSettled, cap);
    }

    bool operator==(const Planes& o) const {
        bool same = true;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                same &= count.at(x, y) == o.count.at(x, y);
                same &= shown_count.at(x, y) == o.shown_count.at(x, y);
                for (size_t c = 0; c < 3; ++c) {
                    same &= mean[c].at(x, y) == o.mean[c].at(x, y);
                    same &= shown[c].at(x, y) == o.shown[c].at(x, y);
                    same &= rest[c].at(x, y) == o.rest[c].at(x, y);
                }
            }
        }
        return same;
    }
};

}  // namespace

TEST_CASE("taa sums: every SIMD target sums what the scalar twin sums, whatever the counts",
          "[postfx][unit]") {
    for (const SimdTarget target : availableSimdTargets()) {
        const TileKernels kernels = tileKernels(target);
        uint32_t seed = 0;
        for (const int cap : {1, 2, 9, 64, 255}) {
            for (const int spread : {1, 2, 40}) {
                for (const bool tested : {false, true}) {
                    const bool changes = tested && ++seed % 2 == 0;
                    Planes expected(seed, cap, spread, changes), found(seed, cap, spread, changes);
                    for (const bool restart : {false, true, false}) {
                        for (int y = 0; y < kHeight; y += kTileSize) {
                            for (int x = 0; x < kWidth; x += kTileSize) {
                                const TileRect tile{x, y, std::min(x + kTileSize, kWidth),
                                                    std::min(y + kTileSize, kHeight)};
                                const Stillness stillness =
                                    tested ? Stillness::tested : Stillness::all;
                                const SumsResult a =
                                    accumulateTileReference(expected.job, tile, stillness, restart);
                                const SumsResult b =
                                    kernels.accumulate(found.job, tile, stillness, restart);
                                INFO(name(target) << " cap " << cap << " tile " << x << " " << y);
                                CHECK(a.finished == b.finished);
                                CHECK(a.settled == b.settled);
                                CHECK(a.changed == b.changed);
                            }
                        }
                        REQUIRE(expected == found);
                    }
                }
            }
        }
    }
}
