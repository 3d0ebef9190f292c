#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "engine/det_math.h"

using still::det::cosTurns;
using still::det::sinTurns;
using still::det::tanDegrees;

namespace {

constexpr long double kTau = 6.283185307179586476925286766559L;

double relativeError(double value, long double truth) {
    return double(std::fabs((value - truth) / truth));
}

}  // namespace

TEST_CASE("det_math: sine and cosine are exact at quarter turns", "[unit][det_math]") {
    for (int quarter = -40; quarter <= 40; ++quarter) {
        const int phase = ((quarter % 4) + 4) % 4;
        const double sines[] = {0, 1, 0, -1};
        const double cosines[] = {1, 0, -1, 0};
        CHECK(sinTurns(quarter * 0.25) == sines[phase]);
        CHECK(cosTurns(quarter * 0.25) == cosines[phase]);
    }
    CHECK(sinTurns(1e300) == 0.0);
    CHECK(cosTurns(-1e300) == 1.0);
}

TEST_CASE("det_math: sine and cosine stay within 1e-15 of the truth", "[unit][det_math]") {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> near(-2.0, 2.0), far(-1e6, 1e6);
    double worst = 0;
    for (int i = 0; i < 200000; ++i) {
        const double turns = i % 2 == 0 ? near(random) : far(random);
        const long double angle = (turns - std::floor(turns)) * kTau;
        worst = std::max(worst, double(std::fabs(sinTurns(turns) - std::sin(angle))));
        worst = std::max(worst, double(std::fabs(cosTurns(turns) - std::cos(angle))));
    }
    CHECK(worst < 1e-15);
}

TEST_CASE("det_math: sine is odd and cosine is even to the bit", "[unit][det_math]") {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> any(-10.0, 10.0);
    bool symmetric = true;
    for (int i = 0; i < 20000; ++i) {
        const double turns = any(random);
        symmetric = symmetric && sinTurns(-turns) == -sinTurns(turns);
        symmetric = symmetric && cosTurns(-turns) == cosTurns(turns);
    }
    CHECK(symmetric);
}

TEST_CASE("det_math: a whole turn more changes nothing", "[unit][det_math]") {
    for (int i = 0; i < 1024; ++i) {
        const double turns = i / 1024.0;
        CHECK(sinTurns(turns + 5) == sinTurns(turns));
        CHECK(cosTurns(turns - 3) == cosTurns(turns));
    }
}

TEST_CASE("det_math: tangent of degrees", "[unit][det_math]") {
    CHECK(tanDegrees(0) == 0);
    CHECK(tanDegrees(45) == Approx(1).epsilon(1e-15));
    for (double degrees = -89.5; degrees < 90; degrees += 0.5) {
        if (degrees != 0) {
            CHECK(relativeError(tanDegrees(degrees), std::tan(degrees / 360 * kTau)) < 1e-13);
        }
    }
}

TEST_CASE("det_math: powers stay within 1e-12 of the truth", "[unit][det_math]") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> exponent(-290, 290), power(-4, 4), unit(0, 1);
    double worst = 0;
    for (int i = 0; i < 100000; ++i) {
        const double x = i % 2 == 0 ? std::pow(10.0, exponent(random)) : unit(random) + 1e-9;
        const double y = power(random);
        const long double truth = std::pow((long double)x, (long double)y);
        if (truth > 1e-300L && truth < 1e300L) {
            worst = std::max(worst, relativeError(still::det::pow(x, y), truth));
        }
    }
    CHECK(worst < 1e-12);
}

TEST_CASE("det_math: powers at the edges of the range", "[unit][det_math]") {
    using still::det::pow;
    CHECK(pow(0, 2.4) == 0);
    CHECK(pow(0, 0) == 1);
    CHECK(pow(1, 1e300) == 1);
    CHECK(pow(5, 0) == 1);
    CHECK(pow(2, 10) == 1024);
    CHECK(pow(4, 0.5) == 2);
    CHECK(pow(2, -1074) == std::numeric_limits<double>::denorm_min());
    CHECK(pow(1e-320, 0.5) == Approx(std::sqrt(1e-320)).epsilon(1e-12));
    CHECK(std::isinf(pow(1e300, 2)));
    CHECK(pow(1e-300, 2) == 0);
}
