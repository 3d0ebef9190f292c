#pragma once
// Variation without a random device: hashes of integers, and smooth noise that tiles.

#include <cmath>
#include <cstdint>

namespace still::scenes {

/// Mixes three integers into 32 well-spread bits (multiply and xor-shift rounds).
constexpr uint32_t hashBits(int32_t a, int32_t b, uint32_t seed) {
    uint32_t h = uint32_t(a) * 0x8DA6B343u + uint32_t(b) * 0xD8163841u + seed * 0xCB1AB31Fu;
    h ^= h >> 16;
    h *= 0x7FEB352Du;
    h ^= h >> 15;
    h *= 0x846CA68Bu;
    h ^= h >> 16;
    return h;
}

/// A number in [0, 1) that depends on the three integers.
constexpr double hashUnit(int32_t a, int32_t b, uint32_t seed) {
    return double(hashBits(a, b, seed) >> 8) / 16777216.0;
}

/// A number in [low, high).
constexpr double hashRange(int32_t a, int32_t b, uint32_t seed, double low, double high) {
    return low + (high - low) * hashUnit(a, b, seed);
}

/// 0 below `from`, 1 above `to`, smooth between.
constexpr double smoothStep(double from, double to, double x) {
    const double t = x <= from ? 0.0 : (x >= to ? 1.0 : (x - from) / (to - from));
    return t * t * (3 - 2 * t);
}

/// Value noise in [0, 1) that repeats after `period_x` × `period_y` cells.
inline double valueNoise(double x, double y, int period_x, int period_y, uint32_t seed) {
    const double fx = std::floor(x), fy = std::floor(y);
    const int x0 = ((int(fx) % period_x) + period_x) % period_x;
    const int y0 = ((int(fy) % period_y) + period_y) % period_y;
    const int x1 = (x0 + 1) % period_x, y1 = (y0 + 1) % period_y;
    const double sx = smoothStep(0, 1, x - fx), sy = smoothStep(0, 1, y - fy);
    const double top = hashUnit(x0, y0, seed) * (1 - sx) + hashUnit(x1, y0, seed) * sx;
    const double bottom = hashUnit(x0, y1, seed) * (1 - sx) + hashUnit(x1, y1, seed) * sx;
    return top * (1 - sy) + bottom * sy;
}

/// Octaves of value noise over a tile u, v ∈ [0, 1), the first with `cells` cells; about 0 … 1.
inline double fractalNoise(double u, double v, int cells, int octaves, uint32_t seed) {
    double sum = 0, weight = 0.5, total = 0;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * valueNoise(u * cells, v * cells, cells, cells, seed + uint32_t(i));
        total += weight;
        weight *= 0.5;
        cells *= 2;
    }
    return sum / total;
}

}  // namespace still::scenes
