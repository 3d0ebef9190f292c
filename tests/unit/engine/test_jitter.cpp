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

/// Share of the pixel on one side of a line, by counting a fine grid.
double coverage(double nx, double ny, double d) {
    int inside = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            inside += nx * (x - 127.5) + ny * (y - 127.5) <= d * 256 ? 1 : 0;
        }
    }
    return inside / 65536.0;
}

double edgeError(const std::vector<SampleOffset>& samples) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> turn(0, 6.2831853), place(-0.6, 0.6);
    double sum = 0;
    const int planes = 400;
    for (int i = 0; i < planes; ++i) {
        const double angle = turn(random), d = place(random);
        const double nx = std::cos(angle), ny = std::sin(angle);
        int inside = 0;
        for (const SampleOffset& s : samples) {
            inside += nx * s.x_fx8 + ny * s.y_fx8 <= d * 256 ? 1 : 0;
        }
        const double error = double(inside) / double(samples.size()) - coverage(nx, ny, d);
        sum += error * error;
    }
    return std::sqrt(sum / planes);
}

}  // namespace

TEST_CASE("jitter: every aligned run of the TAA sequence is a net", "[unit][jitter]") {
    for (uint32_t length = 1; length <= kTaaPeriod; length *= 2) {
        for (uint32_t first = 0; first < 2 * kTaaPeriod; first += length) {
            CHECK(isNet(taaRun(first, length)));
        }
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
    CHECK(edgeError(taaRun(0, 16)) < 0.042);
    CHECK(edgeError(taaRun(0, 64)) < 0.014);
    CHECK(edgeError(ssaaSet(64)) < 0.014);
    CHECK(edgeError(ssaaSet(256)) < 0.005);
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
