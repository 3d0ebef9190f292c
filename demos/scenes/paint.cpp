#include "demos/scenes/paint.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "demos/scenes/noise.h"
#include "engine/det_math.h"

namespace still::scenes {
namespace {

using glm::dvec2;
using glm::dvec3;

uint8_t toByte(double value) {
    return uint8_t(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
}

/// Calls pixel(u, v) for every texel centre; v is 0 at the bottom row.
template <class Pixel>
Image<Rgba8> painted(int width, int height, Pixel&& pixel) {
    Image<Rgba8> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y) = pixel((x + 0.5) / width, 1 - (y + 0.5) / height);
        }
    }
    return image;
}

template <class Pixel>
Image<Rgba8> painted(int size, Pixel&& pixel) {
    return painted(size, size, pixel);
}

Rgba8 toRgba(const dvec3& colour) {
    return {toByte(colour.x), toByte(colour.y), toByte(colour.z), 255};
}

/// Slopes of a height field along +u and +v → tangent-space normal.
Rgba8 toNormal(const dvec2& slope) {
    const double length = std::sqrt(slope.x * slope.x + slope.y * slope.y + 1);
    return toRgba((dvec3{-slope.x, -slope.y, 1} / length + 1.0) * 127.5);
}

dvec3 mix(const dvec3& a, const dvec3& b, double t) {
    return a + (b - a) * t;
}

Texture colourTexture(const Image<Rgba8>& image) {
    return makeColourTexture(image.view(), Wrap::repeat);
}

/// Where in which block of a bond a point lies.
struct BlockPoint {
    int column = 0, row = 0;
    double edge_x = 0, edge_y = 0;  ///< signed distance from the nearest joint, in row heights
};
BlockPoint blockAt(const Bond& bond, double u, double v) {
    BlockPoint at;
    const double y = v * bond.rows;
    at.row = int(y);
    const double x = u * bond.columns + (at.row % 2 == 1 ? 0.5 : 0.0);
    at.column = int(x) % bond.columns;
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    at.edge_x = (fx < 0.5 ? fx : fx - 1) * bond.aspect;
    at.edge_y = fy < 0.5 ? fy : fy - 1;
    return at;
}

/// 0 in the joint, 1 on the block, with worn corners.
double blockCover(const Bond& bond, const BlockPoint& at, double u, double v) {
    const double wear = (fractalNoise(u, v, 32, 2, bond.seed + 77) - 0.5) * bond.joint;
    const double near = std::min(std::abs(at.edge_x), std::abs(at.edge_y)) + wear;
    return smoothStep(0.4 * bond.joint, 0.8 * bond.joint, near);
}

}  // namespace

Texture paintBond(const Bond& bond, int size) {
    return colourTexture(painted(size, [&](double u, double v) {
        const BlockPoint at = blockAt(bond, u, v);
        const double shade = hashRange(at.column, at.row, bond.seed, -1, 1) * bond.variation;
        const double warm = hashRange(at.column, at.row, bond.seed + 9, -1, 1) * bond.variation;
        const double grain = (fractalNoise(u, v, 24, 4, bond.seed + 5) - 0.5) * 0.35;
        const dvec3 block = bond.block * dvec3{1 + shade + grain + 0.3 * warm, 1 + shade + grain,
                                               1 + shade + grain - 0.3 * warm};
        const dvec3 mortar = bond.mortar * (1 + grain);
        return toRgba(mix(mortar, block, blockCover(bond, at, u, v)));
    }));
}

Texture paintBondRelief(const Bond& bond, int size) {
    const auto height = [&](double u, double v) {
        const double wu = u - std::floor(u), wv = v - std::floor(v);
        const BlockPoint at = blockAt(bond, wu, wv);
        const double bump = fractalNoise(wu, wv, 48, 3, bond.seed + 5);
        return blockCover(bond, at, wu, wv) + 0.25 * bump;
    };
    const double step = 1.0 / size;
    const double scale = bond.relief * 0.02 * size / 16.0;
    const Image<Rgba8> image = painted(size, [&](double u, double v) {
        const double du = height(u + step, v) - height(u - step, v);
        const double dv = height(u, v + step) - height(u, v - step);
        return toNormal({du * scale, dv * scale});
    });
    return makeNormalTexture(image.view(), Wrap::repeat);
}

AlphaTexture paintBondHeight(const Bond& bond, int size) {
    const Image<Rgba8> image = painted(size, [&](double u, double v) {
        const double bump = 40 * fractalNoise(u, v, 48, 3, bond.seed + 5);
        return toRgba(dvec3{215 * blockCover(bond, blockAt(bond, u, v), u, v) + bump});
    });
    return makeHeightTexture(image.view(), Wrap::repeat);
}

Texture paintChecker(const Checker& checker, int size) {
    return colourTexture(painted(size, [&](double u, double v) {
        const int column = int(u * checker.cells), row = int(v * checker.cells);
        const double fx = u * checker.cells - column, fy = v * checker.cells - row;
        const bool dark = (column + row) % 2 == 1;
        const double shift_u = hashUnit(column, row, checker.seed);
        const double shift_v = hashUnit(column, row, checker.seed + 1);
        const double cloud = fractalNoise(u + shift_u, v + shift_v, 12, 5, checker.seed + 2);
        const double vein = 1 - smoothStep(0.0, 0.035, std::abs(cloud - 0.5));
        const double shade = hashRange(column, row, checker.seed + 3, -0.09, 0.09);
        const dvec3 base = dark ? checker.dark : checker.light;
        const dvec3 vein_colour = dark ? checker.light : mix(checker.light, checker.dark, 0.6);
        const dvec3 slab = mix(base * (1 + shade + 0.5 * (cloud - 0.5)), vein_colour, 0.22 * vein);
        const double edge = std::min(std::min(fx, 1 - fx), std::min(fy, 1 - fy));
        return toRgba(mix(dvec3{112, 104, 94}, slab, smoothStep(0.006, 0.016, edge)));
    }));
}

Texture paintMottle(const Mottle& mottle, int size) {
    return colourTexture(painted(size, [&](double u, double v) {
        const double cloud = fractalNoise(u, v, mottle.cells, mottle.octaves, mottle.seed);
        const double grain = fractalNoise(u, v, mottle.cells * 16, 2, mottle.seed + 50) - 0.5;
        return toRgba(mix(mottle.a, mottle.b, smoothStep(0.25, 0.75, cloud)) * (1 + 0.14 * grain));
    }));
}

Texture paintBoards(int boards, const glm::dvec3& colour, uint32_t seed, int size) {
    return colourTexture(painted(size, [&](double u, double v) {
        const int board = int(u * boards);
        const double f = u * boards - board;
        const double grain = valueNoise(u * 96, v * 6 + 3.0 * board, 96, 6, seed);
        const double shade = hashRange(board, 0, seed, -0.12, 0.12) + (grain - 0.5) * 0.4;
        const double gap = smoothStep(0.02, 0.05, std::min(f, 1 - f));
        return toRgba(colour * (1 + shade) * (0.25 + 0.75 * gap));
    }));
}

Texture paintStripes(int stripes, const glm::dvec3& a, const glm::dvec3& b, int size) {
    return colourTexture(
        painted(size, [&](double u, double) { return toRgba(int(u * stripes) % 2 == 0 ? a : b); }));
}

Texture paintRipples(double slope, uint32_t seed, int size) {
    const auto height = [&](double u, double v) {
        return fractalNoise(u - std::floor(u), v - std::floor(v), 8, 3, seed);
    };
    const double step = 1.0 / size;
    const double scale = slope * size / 64.0;
    const Image<Rgba8> image = painted(size, [&](double u, double v) {
        return toNormal(dvec2{height(u + step, v) - height(u - step, v),
                              height(u, v + step) - height(u, v - step)} *
                        (scale * 4));
    });
    return makeNormalTexture(image.view(), Wrap::repeat);
}

Texture paintSky(uint32_t seed, int width, int height) {
    const dvec3 zenith{78, 138, 214}, middle{134, 180, 234}, haze{206, 222, 236},
        cloud{250, 248, 244};
    const Image<Rgba8> image = painted(width, height, [&](double u, double v) {
        const double up = det::sinTurns(v / 4), flat = det::cosTurns(v / 4);
        const dvec3 clear =
            mix(mix(haze, middle, smoothStep(0.0, 0.22, up)), zenith, smoothStep(0.12, 0.95, up));
        // Where the view ray meets a sheet of clouds; far out they melt into the haze.
        const double far = flat / (up + 0.16);
        const double x = 0.13 * far * det::cosTurns(u), y = 0.13 * far * det::sinTurns(u);
        const double shape = fractalNoise(x + 0.5, y + 0.5, 12, 6, seed);
        const double cover = smoothStep(0.52, 0.72, shape) * smoothStep(0.02, 0.25, up);
        return toRgba(mix(clear, cloud, 0.85 * cover));
    });
    return makeColourTexture(image.view(), Wrap::repeat);
}

AlphaTexture paintChainLink(int cells, double wire, int size) {
    // Alpha falls over about one texel, so that the half-way line is where the wire ends.
    const double soft = 1.4 * cells / size;
    const Image<Rgba8> image = painted(size, [&](double u, double v) {
        const double a = (u + v) * cells, b = (u - v) * cells + cells;
        const double da = std::abs(a - std::floor(a + 0.5)), db = std::abs(b - std::floor(b + 0.5));
        const double inside = 0.5 * wire - std::min(da, db);
        return Rgba8{255, 255, 255, toByte(255 * std::clamp(0.5 + inside / soft, 0.0, 1.0))};
    });
    return makeAlphaTexture(image.view(), Wrap::repeat, true);
}

namespace {

/// The leaf of a cluster that covers a point, or none.
struct LeafHit {
    bool hit = false;
    double shade = 0;  ///< 0 … 1 from leaf to leaf
    double rib = 0;    ///< distance from the middle rib, 0 … 1
};
constexpr int kLeavesPerCluster = 9;

/// Leaf `i` of the cluster in the cell (column, row), seen at (x, y) ∈ [0, 1)² of the cell.
LeafHit leafAt(int i, int column, int row, uint32_t seed, double x, double y) {
    const int key = i + kLeavesPerCluster * (column + 2 * row);
    const double turns = (i + hashRange(key, 0, seed, -0.3, 0.3)) / kLeavesPerCluster;
    const double cosine = det::cosTurns(turns), sine = det::sinTurns(turns);
    const double px = x - 0.5, py = y - 0.5;
    const double along = px * cosine + py * sine, across = py * cosine - px * sine;
    const double length = hashRange(key, 1, seed, 0.32, 0.46), start = 0.04;
    const double t = (along - start) / (length - start);
    if (t <= 0 || t >= 1) {
        return {};
    }
    const double half = 0.34 * length * std::sqrt(t) * (1 - t) * 1.9;
    return {std::abs(across) < half, hashUnit(key, 2, seed), std::abs(across) / half};
}

LeafHit topLeaf(uint32_t seed, double u, double v) {
    const int column = int(u * 2), row = int(v * 2);
    for (int i = 0; i < kLeavesPerCluster; ++i) {
        const LeafHit leaf = leafAt(i, column, row, seed, u * 2 - column, v * 2 - row);
        if (leaf.hit) {
            return leaf;
        }
    }
    return {};
}

}  // namespace

Texture paintLeafColours(const glm::dvec3& young, const glm::dvec3& old, uint32_t seed, int size) {
    const dvec3 between = mix(young, old, 0.6);
    return colourTexture(painted(size, [&](double u, double v) {
        const LeafHit leaf = topLeaf(seed, u, v);
        const double rib = 0.8 + 0.2 * smoothStep(0.05, 0.2, leaf.rib);
        return toRgba(leaf.hit ? mix(young, old, leaf.shade) * rib : between);
    }));
}

AlphaTexture paintLeafShapes(uint32_t seed, int size) {
    const Image<Rgba8> image = painted(size, [&](double u, double v) {
        int covered = 0;  // of 4 × 4 points, for a smooth border
        for (int k = 0; k < 16; ++k) {
            const double du = (k % 4 - 1.5) / (4.0 * size), dv = (k / 4 - 1.5) / (4.0 * size);
            covered += topLeaf(seed, u + du, v + dv).hit ? 1 : 0;
        }
        return Rgba8{255, 255, 255, toByte(covered * 255.0 / 16)};
    });
    return makeAlphaTexture(image.view(), Wrap::repeat, true);
}

}  // namespace still::scenes
