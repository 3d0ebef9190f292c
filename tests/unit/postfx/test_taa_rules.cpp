// The resolve's arithmetic against slow models in double, over everything that real taps can give.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "postfx/internal/rules.h"
#include "random_frames.h"

namespace {

using namespace still;
using random_frames::Random;

struct Tap {
    int weight = 0, ex = 0, ey = 0;
};

struct TapSet {
    std::vector<Tap> taps;
    taa::Moments moments;
};

/// A frame's four taps around a point, as the gather places them, those of `mask` accepted.
void addFrame(TapSet& set, int fx, int fy, int mask) {
    for (int tap = 0; tap < 4; ++tap) {
        const int i = tap & 1, j = tap >> 1;
        const int wx = taa::axisWeight(fx), wy = taa::axisWeight(fy);
        const int weight =
            (i != 0 ? wx : taa::kAxisWeight - wx) * (j != 0 ? wy : taa::kAxisWeight - wy);
        if (weight != 0 && (mask >> tap & 1) != 0) {
            set.taps.push_back({weight, taa::placeOf(i * 256 - fx), taa::placeOf(j * 256 - fy)});
            set.moments.add(weight, set.taps.back().ex, set.taps.back().ey);
        }
    }
}

/// 1 … kMaxRing frames; sets range from complete ones to one and the same corner in every frame.
TapSet randomTaps(Random& random) {
    TapSet set;
    const int frames = 1 + random.below(kMaxRing);
    const int kind = random.below(4);
    const int fx0 = random.below(256), fy0 = random.below(256), mask0 = 1 + random.below(15);
    const int spread = 1 + random.below(256);
    for (int k = 0; k < frames; ++k) {
        const int fx = kind < 2 ? (fx0 + random.below(spread)) & 255 : random.below(256);
        const int fy = kind < 2 ? (fy0 + random.below(spread)) & 255 : random.below(256);
        const bool one_mask = kind == 0 || kind == 2;
        addFrame(set, fx, fy, one_mask ? mask0 : (random.chance(50) ? 15 : random.below(16)));
    }
    return set;
}

struct Vector {
    double x = 0, y = 0;
};

/// The ridge system in double: (M + ridge · w) tilt = first moments, per 1/64 pixel.
Vector exactTilt(const taa::Moments& m) {
    const double ridge = double(taa::kRidge) * m.w;
    const double a = m.xx + ridge, b = m.xy, d = m.yy + ridge;
    const double det = a * d - b * b;
    return {(d * m.x - b * m.y) / det, (a * m.y - b * m.x) / det};
}

/// Of the weighted taps' centre of gravity from the pixel's, 1/64 pixel.
double distance(const TapSet& set, taa::Tilt tilt) {
    double w = 0, x = 0, y = 0;
    for (const Tap& tap : set.taps) {
        const int weight = taa::tiltedWeight(tap.weight, tilt, tap.ex, tap.ey);
        w += weight;
        x += double(weight) * tap.ex;
        y += double(weight) * tap.ey;
    }
    return w > 0 ? std::hypot(x, y) / w : 0;
}

}  // namespace

TEST_CASE("taa rules: a sample's weight falls steadily from one side to the other",
          "[postfx][unit]") {
    CHECK(taa::axisWeight(0) == 0);
    CHECK(taa::axisWeight(128) == taa::kAxisWeight / 2);
    CHECK(taa::axisWeight(255) == taa::kAxisWeight);
    for (int f = 0; f < 256; ++f) {
        INFO(f);
        CHECK(taa::axisWeight(f) <= taa::axisWeight(f + 1));
        // The left sample gets the rest, so that rounding may show in the mirror image only.
        CHECK(std::abs(taa::axisWeight(f) + taa::axisWeight(256 - f) - taa::kAxisWeight) <= 1);
        // A softened box: 0 within 0.2, all beyond 0.8, straight in between.
        const double wanted = std::clamp((f / 256.0 - 0.2) / 0.6, 0.0, 1.0);
        CHECK(std::abs(taa::axisWeight(f) - wanted * taa::kAxisWeight) <= 0.6);
    }
}

TEST_CASE("taa rules: a frame's four taps weigh kFrameWeight wherever they lie", "[postfx][unit]") {
    for (int fx = 0; fx < 256; ++fx) {
        for (int fy = 0; fy < 256; ++fy) {
            TapSet set;
            addFrame(set, fx, fy, 15);
            REQUIRE(set.moments.w == taa::kFrameWeight);
        }
    }
}

TEST_CASE("taa rules: sums of still pixels lose nothing", "[postfx][unit]") {
    Random random(3);
    for (int run = 0; run < 300; ++run) {
        const int range = random.chance(50) ? 65536 : 1 + random.below(5000);
        taa::Sum sum;
        int64_t total = 0;
        for (int count = 0; count < 255; ++count) {
            const int sample = random.chance(10) ? 65535 : random.below(range);
            total += sample;
            sum = taa::addSample(sum, count, sample);
            const int64_t n = count + 1;
            REQUIRE(sum.mean * n + sum.rest == total);
            REQUIRE(sum.mean == (2 * total + n) / (2 * n));
            REQUIRE(std::abs(sum.rest) <= 127);
        }
    }
}

TEST_CASE("taa rules: tilted weights of real taps are never negative", "[postfx][unit]") {
    Random random(1);
    int largest_sum = 0, smallest = 1;
    for (int run = 0; run < 200000; ++run) {
        const TapSet set = randomTaps(random);
        if (set.moments.w < 2) {
            continue;
        }
        const taa::Tilt tilt = taa::tiltOf(set.moments);
        largest_sum = std::max(largest_sum, std::abs(tilt.x) + std::abs(tilt.y));
        int total = 0;
        for (const Tap& tap : set.taps) {
            const int weight = taa::tiltedWeight(tap.weight, tilt, tap.ex, tap.ey);
            smallest = std::min(smallest, weight);
            total += weight;
        }
        REQUIRE(total <= taa::kMaxTotal);
    }
    CHECK(smallest == 0);
    CHECK(largest_sum <= taa::kMaxTilt);
}

TEST_CASE("taa rules: one tap of each frame, in every place, does not turn a weight negative",
          "[postfx][unit]") {
    for (int fx = 0; fx < 256; ++fx) {
        for (int fy = 0; fy < 256; ++fy) {
            for (int mask = 1; mask < 16; ++mask) {
                TapSet set;
                addFrame(set, fx, fy, mask);
                if (set.moments.w < 2) {
                    continue;
                }
                const taa::Tilt tilt = taa::tiltOf(set.moments);
                for (const Tap& tap : set.taps) {
                    if (taa::tiltedWeight(tap.weight, tilt, tap.ex, tap.ey) < 0) {
                        FAIL("fx " << fx << " fy " << fy << " mask " << mask);
                    }
                }
            }
        }
    }
}

TEST_CASE("taa rules: the tilt solves the ridge system of the samples' moments", "[postfx][unit]") {
    Random random(2);
    const double one = 1 << taa::kTiltBits;
    double worst = 0, worst_of_many = 0;
    int gentle = 0;
    for (int run = 0; run < 100000; ++run) {
        const TapSet set = randomTaps(random);
        if (set.moments.w < taa::kFrameWeight) {
            continue;
        }
        const Vector wanted = exactTilt(set.moments);
        const taa::Tilt tilt = taa::tiltOf(set.moments);
        // The limit halves steep tilts.
        if ((std::abs(wanted.x) + std::abs(wanted.y)) * one < taa::kMaxTilt * 0.9) {
            ++gentle;
            const double error =
                std::max(std::abs(tilt.x - wanted.x * one), std::abs(tilt.y - wanted.y * one));
            worst = std::max(worst, error);
            worst_of_many = std::max(worst_of_many, set.moments.w < 1024 ? 0 : error);
        } else {
            CHECK(tilt.x * wanted.x + tilt.y * wanted.y >= 0);
        }
    }
    INFO("worst difference " << worst << ", of four frames and more " << worst_of_many << ", "
                             << gentle << " cases");
    CHECK(gentle > 20000);
    CHECK(worst < taa::kMaxTilt * 0.1);
    CHECK(worst_of_many < taa::kMaxTilt * 0.04);
}

TEST_CASE("taa rules: the tilt moves the centre of gravity towards the pixel's centre",
          "[postfx][unit]") {
    Random random(5);
    double before = 0, after = 0, whole_before = 0, whole_after = 0;
    int farther = 0;
    for (int run = 0; run < 50000; ++run) {
        TapSet set = randomTaps(random);
        TapSet whole;
        for (int k = 0; k < 4; ++k) {
            addFrame(whole, random.below(256), random.below(256), 15);
        }
        whole_before += distance(whole, {});
        whole_after += distance(whole, taa::tiltOf(whole.moments));
        if (set.moments.w < taa::kFrameWeight / 4) {
            continue;
        }
        const double r0 = distance(set, {}), r1 = distance(set, taa::tiltOf(set.moments));
        before += r0;
        after += r1;
        farther += r1 > r0 + 1.0 ? 1 : 0;  // 1/64 pixel for the rounding of weights
    }
    INFO("all: " << before << " to " << after << "; four whole frames: " << whole_before << " to "
                 << whole_after);
    CHECK(farther == 0);
    CHECK(after < 0.85 * before);
    CHECK(whole_after < 0.45 * whole_before);
}

TEST_CASE("taa rules: the weighted mean is the quotient to within an eighth more than half a unit",
          "[postfx][unit]") {
    Random random(4);
    double worst = 0, worst_usual = 0;
    for (int total = 2; total <= taa::kMaxTotal; ++total) {
        for (int k = 0; k < 24; ++k) {
            const int colour =
                k < 2 ? 65535 * k : (k < 12 ? random.below(4097) : random.below(65536));
            const auto most = uint32_t(total) * 65535u;
            const uint32_t sum =
                std::min(most, uint32_t(total) * uint32_t(colour) + uint32_t(random.below(total)));
            const double error =
                std::abs(taa::weightedMean(sum, total) - double(sum) / double(total));
            worst = std::max(worst, error);
            worst_usual =
                sum <= uint32_t(total) * 4096u ? std::max(worst_usual, error) : worst_usual;
            REQUIRE(taa::weightedMean(sum, total) <= 65535);
            REQUIRE(taa::weightedMean(uint32_t(total) * uint32_t(colour), total) == colour);
        }
    }
    INFO("worst " << worst << ", up to white " << worst_usual);
    CHECK(worst < 0.5 + 0.125);
    CHECK(worst_usual < 0.5 + 1.0 / 128);
}

TEST_CASE("taa rules: normals up to about ten degrees apart count as lit alike", "[postfx][unit]") {
    const auto packed = [](double x, double y, double z) {
        const double sum = std::abs(x) + std::abs(y) + std::abs(z);
        double u = x / sum, v = y / sum;
        if (z < 0) {
            const double fold_u = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
            v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
            u = fold_u;
        }
        const auto snorm = [](double t) { return uint32_t(uint16_t(int(std::lround(t * 32767)))); };
        return snorm(u) | snorm(v) << 16;
    };
    Random random(9);
    const auto unit = [&] { return random.below(20001) / 10000.0 - 1; };
    int tested = 0;
    for (int run = 0; run < 20000; ++run) {
        const std::array<double, 3> a{unit(), unit(), unit()};
        const double reach = random.chance(50) ? 0.15 : 1.0;
        const std::array<double, 3> b{a[0] + reach * unit(), a[1] + reach * unit(),
                                      a[2] + reach * unit()};
        const double la = std::hypot(a[0], a[1], a[2]), lb = std::hypot(b[0], b[1], b[2]);
        if (la < 0.1 || lb < 0.1) {
            continue;
        }
        const double cosine = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / (la * lb);
        const double degrees = std::acos(std::clamp(cosine, -1.0, 1.0)) * 57.29578;
        const taa::SmallNormal na = taa::decodeNormal(taa::compactNormal(packed(a[0], a[1], a[2])));
        const taa::SmallNormal nb = taa::decodeNormal(taa::compactNormal(packed(b[0], b[1], b[2])));
        const bool alike =
            taa::similarlyLit(taa::dotOf(na, nb), taa::dotOf(na, na), taa::dotOf(nb, nb));
        INFO(degrees << " degrees apart");
        if (degrees < 7.5 || degrees > 14) {
            ++tested;
            if (alike != (degrees < 10)) {
                FAIL(degrees << " degrees apart, alike: " << alike);
            }
        }
    }
    CHECK(tested > 10000);
}

TEST_CASE("taa rules: small normals unfold like large ones, 0 counting as positive",
          "[postfx][unit]") {
    for (int x = -128; x <= 127; ++x) {
        for (int y = -128; y <= 127; ++y) {
            const taa::SmallNormal n =
                taa::decodeNormal(uint32_t(x & 255) | uint32_t(y & 255) << 8);
            const int z = 127 - std::abs(x) - std::abs(y);
            CAPTURE(x, y, n.x, n.y, n.z);
            REQUIRE(n.z == z);
            REQUIRE(n.x == (z >= 0 ? x : (127 - std::abs(y)) * (x < 0 ? -1 : 1)));
            REQUIRE(n.y == (z >= 0 ? y : (127 - std::abs(x)) * (y < 0 ? -1 : 1)));
        }
    }
}
