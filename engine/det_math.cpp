// Sources: range reduction by quarter turns and Taylor series (any analysis textbook); log2 through
// the series of atanh and the exponent field, as in Muller, "Elementary Functions", 3rd ed.,
// ch. 11. std::floor is exact, so it is the same everywhere; nothing else comes from the C library.

#include "engine/det_math.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace still::det {
namespace {

constexpr double kTau = 6.283185307179586476925286766559;
constexpr double kLn2 = 0.69314718055994530941723212145818;
constexpr double kTwoOverLn2 = 2.8853900817779268147198493620038;
constexpr double kSqrt2 = 1.4142135623730950488016887242097;
constexpr double kPow2_54 = 18014398509481984.0;

/// c[0] + z (c[1] + z (c[2] + …))
template <size_t N>
constexpr double horner(const std::array<double, N>& c, double z) {
    double sum = c[N - 1];
    for (size_t i = N - 1; i-- > 0;) {
        sum = sum * z + c[i];
    }
    return sum;
}

/// 1/first!, −1/(first+2)!, 1/(first+4)!, …
template <size_t N>
constexpr std::array<double, N> alternatingFactorials(int first) {
    std::array<double, N> c{};
    double factorial = 1;
    for (int i = 2; i <= first; ++i) {
        factorial *= i;
    }
    for (size_t k = 0; k < N; ++k) {
        c[k] = (k % 2 == 0 ? 1.0 : -1.0) / factorial;
        const int next = first + 2 * int(k) + 1;
        factorial *= next;
        factorial *= next + 1;
    }
    return c;
}

// On [−1/8, 1/8] turn the first dropped terms are 5e-17 (sine) and 2e-18 (cosine).
constexpr auto kSine = alternatingFactorials<8>(1);
constexpr auto kCosine = alternatingFactorials<9>(0);

double sineNearZero(double x) {
    return x * horner(kSine, x * x);
}
double cosineNearZero(double x) {
    return horner(kCosine, x * x);
}

/// cos over half a turn, 0 ≤ turns ≤ 1/2, and sin likewise. The rest after taking off quarter turns
/// is exact. They subtract from 0.0 instead of negating, so that a zero is always +0.
double cosOfHalf(double turns) {
    if (turns <= 0.125) {
        return cosineNearZero(turns * kTau);
    }
    if (turns < 0.375) {
        return sineNearZero((0.25 - turns) * kTau);
    }
    return 0.0 - cosineNearZero((0.5 - turns) * kTau);
}
double sinOfHalf(double turns) {
    if (turns < 0.125) {
        return sineNearZero(turns * kTau);
    }
    if (turns <= 0.375) {
        return cosineNearZero((0.25 - turns) * kTau);
    }
    return sineNearZero((0.5 - turns) * kTau);
}

/// Part after the decimal point of a non-negative angle; exact.
double fractionOf(double turns) {
    return turns - std::floor(turns);
}

template <size_t N>
constexpr std::array<double, N> oddReciprocals() {
    std::array<double, N> c{};
    for (size_t k = 0; k < N; ++k) {
        c[k] = 1.0 / double(2 * k + 1);
    }
    return c;
}
template <size_t N>
constexpr std::array<double, N> reciprocalFactorials() {
    std::array<double, N> c{};
    double factorial = 1;
    for (size_t k = 0; k < N; ++k) {
        c[k] = 1.0 / factorial;
        factorial *= double(k + 1);
    }
    return c;
}
constexpr auto kAtanh = oddReciprocals<12>();      // in s², |s| ≤ 0.172: dropped 2e-20
constexpr auto kExp = reciprocalFactorials<15>();  // |x| ≤ 0.347: dropped 1e-19

/// 2^n for −1022 ≤ n ≤ 1023.
double powerOfTwo(int n) {
    return std::bit_cast<double>(uint64_t(n + 1023) << 52);
}

/// log2 of a positive finite number as integer + fraction, |fraction| ≤ 1/2.
struct Log2 {
    double integer, fraction;
};
Log2 log2Parts(double x) {
    int exponent = 0;
    if (x < powerOfTwo(-1022)) {
        x *= kPow2_54;
        exponent = -54;
    }
    const uint64_t bits = std::bit_cast<uint64_t>(x);
    exponent += int(bits >> 52) - 1023;
    double mantissa = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFu) | 0x3FF0000000000000u);
    if (mantissa > kSqrt2) {
        mantissa *= 0.5;
        exponent += 1;
    }
    const double s = (mantissa - 1) / (mantissa + 1);
    return {double(exponent), kTwoOverLn2 * (s * horner(kAtanh, s * s))};
}

/// 2^z; infinity and zero far outside the range of double.
double exp2(double z) {
    z = z < -1200 ? -1200 : (z > 1200 ? 1200 : z);
    const double nearest = std::floor(z + 0.5);
    const double mantissa = horner(kExp, (z - nearest) * kLn2);
    const int n = int(nearest);
    const int half = n / 2;  // in two steps, so that subnormal results and overflow come out right
    return mantissa * powerOfTwo(half) * powerOfTwo(n - half);
}

}  // namespace

double sinTurns(double turns) {
    const double fraction = fractionOf(turns < 0 ? -turns : turns);
    const double value = fraction <= 0.5 ? sinOfHalf(fraction) : 0.0 - sinOfHalf(1 - fraction);
    return turns < 0 ? 0.0 - value : value;
}

double cosTurns(double turns) {
    const double fraction = fractionOf(turns < 0 ? -turns : turns);
    return cosOfHalf(fraction <= 0.5 ? fraction : 1 - fraction);
}

double tanDegrees(double degrees) {
    assert(degrees > -90 && degrees < 90);
    const double turns = degrees / 360;
    return sinTurns(turns) / cosTurns(turns);
}

double pow(double x, double y) {
    assert(x >= 0 && x <= 1.7976931348623157e308);
    if (y == 0 || x == 1) {
        return 1;
    }
    if (x == 0) {
        return y > 0 ? 0.0 : 1.0 / x;
    }
    const Log2 log = log2Parts(x);
    return exp2(y * (log.integer + log.fraction));
}

double linearFromSrgb(double value) {
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

}  // namespace still::det
