#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "engine/jitter.h"

using namespace still;

namespace {

/// Every elementary interval of area 1/n holds exactly one of the n = 2^m samples.
bool isNet(const std::vector<SampleOffset>& samples) {
    const uint32_t count = uint32_t(samples.size());
    const int m = int(std::bit_width(count)) - 1;
    for (int columns = 0; columns <= m; ++columns) {
        std::set<std::pair<int, int>> cells;
        for (const SampleOffset& s : samples) {
            cells.emplace(((s.x_fx8 + 128) << columns) >> 8,
                          ((s.y_fx8 + 128) << (m - columns)) >> 8);
        }
        if (cells.size() != count) {
            return false;
        }
    }
    return true;
}

std::vector<SampleOffset> taaRun(uint32_t first, uint32_t count) {
    std::vector<SampleOffset> run;
    for (uint32_t i = 0; i < count; ++i) {
        run.push_back(taaSample(first + i));
    }
    return run;
}

std::vector<SampleOffset> ssaaSet(uint32_t count) {
    std::vector<SampleOffset> set;
    for (uint32_t i = 0; i < count; ++i) {
        set.push_back(ssaaSample(i, count));
    }
    return set;
}

std::pair<int, int> sumOf(const std::vector<SampleOffset>& samples) {
    std::pair<int, int> sum;
    for (const SampleOffset& s : samples) {
        sum.first += s.x_fx8;
        sum.second += s.y_fx8;
    }
    return sum;
}

bool inRange(const std::vector<SampleOffset>& samples) {
    for (const SampleOffset& s : samples) {
        if (s.x_fx8 < -128 || s.x_fx8 > 127 || s.y_fx8 < -128 || s.y_fx8 > 127) {
            return false;
        }
    }
    return true;
}

size_t distinct(const std::vector<SampleOffset>& samples) {
    std::set<std::pair<int, int>> places;
    for (const SampleOffset& s : samples) {
        places.emplace(s.x_fx8, s.y_fx8);
    }
    return places.size();
}

const std::vector<JitterPattern> kPatterns{
    JitterPattern::none,        JitterPattern::uniform2,    JitterPattern::rgss4,
    JitterPattern::halton8,     JitterPattern::halton16,    JitterPattern::halton32,
    JitterPattern::hammersley4, JitterPattern::hammersley8, JitterPattern::hammersley16,
    JitterPattern::net16,       JitterPattern::net32,       JitterPattern::net64,
    JitterPattern::r2,          JitterPattern::blue_noise};

std::vector<SampleOffset> patternRun(JitterPattern pattern, uint32_t first, uint32_t count,
                                     bool scramble = false) {
    std::vector<SampleOffset> run;
    for (uint32_t i = first; i < first + count; ++i) {
        run.push_back(jitterSample(pattern, 256, scramble, i));
    }
    return run;
}

std::vector<std::pair<int, int>> pairsOf(const std::vector<SampleOffset>& samples) {
    std::vector<std::pair<int, int>> pairs;
    for (const SampleOffset& s : samples) {
        pairs.emplace_back(s.x_fx8, s.y_fx8);
    }
    return pairs;
}

std::vector<std::pair<int, int>> sortedPairs(const std::vector<SampleOffset>& samples) {
    auto pairs = pairsOf(samples);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// Mitchell's best candidates as jitter.cpp describes them.
std::vector<SampleOffset> bestCandidates(uint32_t state, int per_point, size_t count) {
    std::vector<SampleOffset> points{{0, 0}};
    const auto next = [&state] {
        state = state * 1664525u + 1013904223u;
        return int(state >> 24) - 128;
    };
    const auto across = [](int a, int b) {
        return std::min(std::abs(a - b), 256 - std::abs(a - b));
    };
    while (points.size() < count) {
        SampleOffset best;
        int farthest = -1;
        for (int c = per_point * int(points.size()); c > 0; --c) {
            const int x = next();
            const int y = next();
            int nearest = 1 << 30;
            for (const SampleOffset& p : points) {
                const int dx = across(x, p.x_fx8), dy = across(y, p.y_fx8);
                nearest = std::min(nearest, dx * dx + dy * dy);
            }
            if (nearest > farthest) {
                farthest = nearest;
                best = {x, y};
            }
        }
        points.push_back(best);
    }
    return points;
}

struct Edge {
    double nx = 0, ny = 0, d = 0;  ///< inside is nx · x + ny · y ≤ d, in pixels
    double covered = 0;            ///< share of the pixel inside, counted on a fine grid

    bool inside(double x, double y) const { return nx * x + ny * y <= d; }
};

std::vector<Edge> randomEdges(int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> turn(0, 6.2831853), place(-0.6, 0.6);
    std::vector<Edge> edges;
    for (int i = 0; i < count; ++i) {
        const double angle = turn(random), d = place(random);
        Edge edge{std::cos(angle), std::sin(angle), d};
        int inside = 0;
        for (int k = 0; k < 65536; ++k) {
            inside += edge.inside((k % 256 - 127.5) / 256, (k / 256 - 127.5) / 256) ? 1 : 0;
        }
        edge.covered = inside / 65536.0;
        edges.push_back(edge);
    }
    return edges;
}

double edgeError(const std::vector<SampleOffset>& samples, const std::vector<Edge>& edges) {
    double sum = 0;
    for (const Edge& edge : edges) {
        int inside = 0;
        for (const SampleOffset& s : samples) {
            inside += edge.inside(s.x_fx8 / 256.0, s.y_fx8 / 256.0) ? 1 : 0;
        }
        const double error = double(inside) / double(samples.size()) - edge.covered;
        sum += error * error;
    }
    return std::sqrt(sum / double(edges.size()));
}

/// Rms of edgeError() over all runs of `length` TAA samples, as a surface sees them that moves by
/// v/256 pixel per frame.
double glideError(uint32_t length, SampleOffset v, const std::vector<Edge>& edges) {
    double sum = 0;
    for (uint32_t first = 0; first < kTaaPeriod; ++first) {
        std::vector<SampleOffset> seen = taaRun(first, length);
        for (uint32_t k = 0; k < length; ++k) {
            SampleOffset& s = seen[k];
            s.x_fx8 = ((s.x_fx8 + 128 - int(k) * v.x_fx8) & 255) - 128;
            s.y_fx8 = ((s.y_fx8 + 128 - int(k) * v.y_fx8) & 255) - 128;
        }
        const double error = edgeError(seen, edges);
        sum += error * error;
    }
    return std::sqrt(sum / kTaaPeriod);
}

}  // namespace

TEST_CASE("jitter: any period of the TAA sequence is a net", "[unit][jitter]") {
    for (uint32_t first = 0; first < kTaaPeriod; ++first) {
        CHECK(isNet(taaRun(first, kTaaPeriod)));
    }
}

TEST_CASE("jitter: any few TAA samples in a row are even, at rest and on what moves slowly",
          "[unit][jitter]") {
    const std::vector<Edge> edges = randomEdges(200);
    CHECK(glideError(8, {0, 0}, edges) < 0.083);
    CHECK(glideError(16, {0, 0}, edges) < 0.049);
    for (const auto& [x, y] : {std::pair(12, 4), {-4, 12}, {-12, -4}, {4, -12}}) {
        const SampleOffset slow{x, y}, a_quarter{5 * x, 5 * y};
        CAPTURE(x, y);
        CHECK(glideError(8, slow, edges) < 0.108);
        CHECK(glideError(16, slow, edges) < 0.075);
        CHECK(glideError(8, {2 * x, 2 * y}, edges) < 0.115);
        CHECK(glideError(8, a_quarter, edges) < 0.130);
    }
}

TEST_CASE("jitter: a TAA period has zero mean, distinct samples and repeats", "[unit][jitter]") {
    const auto period = taaRun(0, kTaaPeriod);
    CHECK(sumOf(period) == std::pair(0, 0));
    CHECK(distinct(period) == kTaaPeriod);
    CHECK(inRange(period));
    CHECK(taaSample(3 * kTaaPeriod + 5).x_fx8 == taaSample(5).x_fx8);
}

TEST_CASE("jitter: coverage of random edges is as good as measured", "[unit][jitter]") {
    const std::vector<Edge> edges = randomEdges(400);
    CHECK(edgeError(taaRun(0, 8), edges) < 0.066);
    CHECK(edgeError(taaRun(0, 16), edges) < 0.042);
    CHECK(edgeError(taaRun(0, 64), edges) < 0.014);
    CHECK(edgeError(ssaaSet(64), edges) < 0.014);
    CHECK(edgeError(ssaaSet(256), edges) < 0.005);
}

TEST_CASE("jitter: half a pixel per frame does not put all samples into one half",
          "[unit][jitter]") {
    for (uint32_t first = 0; first < kTaaPeriod; first += 8) {
        std::array<int, 2> upper{};
        for (uint32_t i = first; i < first + 16; ++i) {
            const int shift_fx8 = int(i % 2) * 128;
            upper[0] += ((taaSample(i).x_fx8 + 128 + shift_fx8) & 255) >= 128 ? 1 : 0;
            upper[1] += ((taaSample(i).y_fx8 + 128 + shift_fx8) & 255) >= 128 ? 1 : 0;
        }
        CHECK((upper[0] >= 2 && upper[0] <= 14));
        CHECK((upper[1] >= 2 && upper[1] <= 14));
    }
}

TEST_CASE("jitter: the first TAA sample is the one nearest the pixel's centre", "[unit][jitter]") {
    const auto distance = [](const SampleOffset& s) {
        return s.x_fx8 * s.x_fx8 + s.y_fx8 * s.y_fx8;
    };
    for (const SampleOffset& s : taaRun(1, kTaaPeriod - 1)) {
        CHECK(distance(taaSample(0)) < distance(s));
    }
}

TEST_CASE("jitter: every pattern repeats after its period and stays in the pixel",
          "[unit][jitter]") {
    const uint32_t periods[] = {1, 2, 4, 8, 16, 32, 4, 8, 16, 16, 32, 64, 64, 64};
    for (size_t k = 0; k < kPatterns.size(); ++k) {
        const JitterPattern pattern = kPatterns[k];
        const uint32_t period = jitterPeriod(pattern);
        CAPTURE(k);
        CHECK(period == periods[k]);
        CHECK(std::has_single_bit(period));
        const auto run = patternRun(pattern, 0, period);
        CHECK(inRange(run));
        CHECK(distinct(run) == period);
        CHECK(pairsOf(patternRun(pattern, 5 * period, period)) == pairsOf(run));
    }
}

TEST_CASE("jitter: symmetric patterns have zero mean", "[unit][jitter]") {
    for (const JitterPattern pattern :
         {JitterPattern::none, JitterPattern::uniform2, JitterPattern::rgss4,
          JitterPattern::hammersley4, JitterPattern::hammersley8, JitterPattern::hammersley16,
          JitterPattern::net16, JitterPattern::net32, JitterPattern::net64}) {
        CAPTURE(int(pattern));
        CHECK(sumOf(patternRun(pattern, 0, jitterPeriod(pattern))) == std::pair(0, 0));
    }
}

TEST_CASE("jitter: every aligned run of net16 and net32 is a net, also when scrambled",
          "[unit][jitter]") {
    for (const JitterPattern pattern : {JitterPattern::net16, JitterPattern::net32}) {
        const uint32_t period = jitterPeriod(pattern);
        for (const bool scramble : {false, true}) {
            for (uint32_t length = 1; length <= period; length *= 2) {
                for (uint32_t first = 0; first < 3 * period; first += length) {
                    CHECK(isNet(patternRun(pattern, first, length, scramble)));
                }
            }
        }
    }
    for (const JitterPattern pattern :
         {JitterPattern::hammersley4, JitterPattern::hammersley8, JitterPattern::hammersley16}) {
        CHECK(isNet(patternRun(pattern, 0, jitterPeriod(pattern))));
    }
}

TEST_CASE("jitter: Halton has the exact values from index 1, rounded half up", "[unit][jitter]") {
    // 1/2 1/4 3/4 1/8 5/8 3/8 7/8 1/16 and 1/3 2/3 1/9 4/9 7/9 2/9 5/9 8/9 of 256, minus 128.
    const std::vector<std::pair<int, int>> expected{{0, -43}, {-64, 43},  {64, -100}, {-96, -14},
                                                    {32, 71}, {-32, -71}, {96, 14},   {-112, 100}};
    CHECK(pairsOf(patternRun(JitterPattern::halton8, 0, 8)) == expected);
    // Index 27 is 11011 in base 2 and 1000 in base 3: 27/32 and 1/81.
    CHECK(pairsOf(patternRun(JitterPattern::halton32, 26, 1)).at(0) == std::pair(88, -125));
    CHECK(pairsOf(patternRun(JitterPattern::halton32, 0, 16)) ==
          pairsOf(patternRun(JitterPattern::halton16, 0, 16)));
}

TEST_CASE("jitter: R2 follows the plastic number", "[unit][jitter]") {
    const double rho = 1.324717957244746;
    const auto run = patternRun(JitterPattern::r2, 0, 64);
    for (int i = 0; i < 64; ++i) {
        const double x = std::fmod((i + 1) / rho, 1.0), y = std::fmod((i + 1) / (rho * rho), 1.0);
        CHECK(std::abs(run[size_t(i)].x_fx8 + 128 - x * 256) < 0.51);
        CHECK(std::abs(run[size_t(i)].y_fx8 + 128 - y * 256) < 0.51);
    }
}

TEST_CASE("jitter: the blue noise table is what its recipe makes", "[unit][jitter]") {
    CHECK(pairsOf(patternRun(JitterPattern::blue_noise, 0, 64)) ==
          pairsOf(bestCandidates(28, 8, 64)));
}

TEST_CASE("jitter: scrambling permutes each cycle and leaves the first as it is",
          "[unit][jitter]") {
    for (const JitterPattern pattern : kPatterns) {
        const uint32_t period = jitterPeriod(pattern);
        const auto plain = patternRun(pattern, 0, period);
        CAPTURE(int(pattern));
        CHECK(pairsOf(patternRun(pattern, 0, period, true)) == pairsOf(plain));
        int other_orders = 0;
        for (uint32_t cycle = 1; cycle < 20; ++cycle) {
            const auto scrambled = patternRun(pattern, cycle * period, period, true);
            CHECK(sortedPairs(scrambled) == sortedPairs(plain));
            other_orders += pairsOf(scrambled) == pairsOf(plain) ? 0 : 1;
        }
        CHECK((period == 1 || other_orders > 4));
    }
}

TEST_CASE("jitter: the scale multiplies offsets, half up, and stops at the pixel's edge",
          "[unit][jitter]") {
    const auto at = [](int scale_fx8, uint32_t i) {
        const SampleOffset s = jitterSample(JitterPattern::rgss4, scale_fx8, false, i);
        return std::pair(s.x_fx8, s.y_fx8);
    };
    CHECK(at(256, 0) == std::pair(-32, -96));
    CHECK(at(128, 0) == std::pair(-16, -48));
    CHECK(at(0, 0) == std::pair(0, 0));
    CHECK(at(4, 0) == std::pair(0, -1));  // −1/2 is rounded up, −3/2 too
    CHECK(at(4, 1) == std::pair(1, 2));
    CHECK(at(1024, 0) == std::pair(-128, -128));
    CHECK(at(1024, 1) == std::pair(127, 127));
}

TEST_CASE("jitter: ssaa sets of powers of two are nets", "[unit][jitter]") {
    for (uint32_t count = 1; count <= 256; count *= 2) {
        CHECK(isNet(ssaaSet(count)));
        CHECK(inRange(ssaaSet(count)));
        const int expected = count == 256 ? -128 : 0;
        CHECK(sumOf(ssaaSet(count)) == std::pair(expected, expected));
    }
    CHECK(distinct(ssaaSet(65536)) == 65536);
    CHECK(ssaaSample(0, 1).x_fx8 == 0);
    CHECK(ssaaSample(0, 1).y_fx8 == 0);
}

TEST_CASE("jitter: ssaa sets of any size are distinct and nearly centred", "[unit][jitter]") {
    for (uint32_t count = 2; count <= 300; ++count) {
        const auto set = ssaaSet(count);
        CHECK(inRange(set));
        CHECK(distinct(set) == count);
        const auto [x, y] = sumOf(set);
        CHECK(std::abs(x) <= int(count));
        CHECK(std::abs(y) <= 30 * int(std::bit_width(count)));
    }
}

TEST_CASE("jitter: the sequence of upscaling grows with the ratio's square", "[unit]") {
    CHECK(upscalePeriod(kNativeRatio_fx8) == 64);
    CHECK(upscalePeriod(257) == 128);
    CHECK(upscalePeriod(333) == 128);  // 1.3
    CHECK(upscalePeriod(384) == 256);
    CHECK(upscalePeriod(512) == 256);
    CHECK(upscalePeriod(513) == 512);
    CHECK(upscalePeriod(kMaxRatio_fx8) == kMaxUpscalePeriod);
}

TEST_CASE("jitter: aligned runs of the sequence of upscaling are nets, and all of it is one",
          "[unit]") {
    for (const uint32_t period : {64u, 128u, 256u, 512u, 1024u}) {
        CAPTURE(period);
        std::vector<SampleOffset> all;
        for (uint32_t i = 0; i < period; ++i) {
            all.push_back(upscaleSample(i, period));
        }
        CHECK(inRange(all));
        CHECK((upscaleSample(period + 5, period).x_fx8 == all[5].x_fx8));
        for (uint32_t run = 2; run <= std::min(period, 256u); run *= 2) {
            for (uint32_t first = 0; first < period; first += run) {
                CHECK(isNet({all.begin() + first, all.begin() + first + run}));
            }
        }
        const auto [x, y] = sumOf(all);
        CHECK((2 * std::abs(x) <= int(period) && 2 * std::abs(y) <= int(period)));
    }
}

TEST_CASE("jitter: every quarter of a frame's pixel gets a quarter of the samples, from the start",
          "[unit]") {
    const uint32_t period = upscalePeriod(512);
    std::array<std::vector<SampleOffset>, 4> quarters;
    for (uint32_t i = 0; i < period; ++i) {
        const SampleOffset s = upscaleSample(i, period);
        quarters[(s.x_fx8 >= 0 ? 1u : 0u) + (s.y_fx8 >= 0 ? 2u : 0u)].push_back(s);
        if (i % 4 == 3) {
            for (const auto& quarter : quarters) {
                CHECK(quarter.size() == i / 4 + 1);
            }
        }
    }
}

TEST_CASE("jitter: policies that upscale in time take the long sequence, others their pattern",
          "[unit]") {
    const auto same = [](SampleOffset a, SampleOffset b) {
        return a.x_fx8 == b.x_fx8 && a.y_fx8 == b.y_fx8;
    };
    const TaaPolicy quality = findPreset("quality")->policy;
    CHECK(policyPeriod(quality) == 256);
    CHECK(same(policySample(quality, 77), upscaleSample(77, 256)));
    CHECK(policyPeriod(findPreset("ultra")->policy) == 1024);
    TaaPolicy halton = quality;
    halton.jitter = JitterPattern::halton8;
    CHECK(policyPeriod(halton) == 8);
    CHECK(same(policySample(halton, 3), jitterSample(JitterPattern::halton8, 256, false, 3)));
    TaaPolicy narrow = quality;
    narrow.jitter_scale_fx8 = 128;
    CHECK(std::abs(policySample(narrow, 9).x_fx8 * 2 - upscaleSample(9, 256).x_fx8) <= 1);
    CHECK(policyPeriod(findPreset("bicubic")->policy) == kTaaPeriod);
    CHECK(same(policySample({}, 70), taaSample(70)));
    CHECK(finishingSamples({}) == int(kTaaPeriod));
    CHECK(finishingSamples(quality) == 256);
}
