#include "demos/inspect/views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "demos/inspect/lines.h"
#include "demos/inspect/paint_rows.h"
#include "rasterizer/fixed.h"

namespace still::inspect {
namespace {

constexpr Rgb8 kNothing{0, 0, 0};

uint8_t toByte(float value) {
    return uint8_t(std::clamp(roundToInt(value), 0, 255));
}

Rgb8 grey(int value) {
    const uint8_t v = uint8_t(std::clamp(value, 0, 255));
    return {v, v, v};
}

/// Luma (BT.601), 8 bits.
Rgb8 greyOf(Rgb8 c) {
    return grey((77 * c.r + 150 * c.g + 29 * c.b + 128) >> 8);
}

int mix(int from, int to, int part, int whole) {
    return from + (to - from) * part / whole;
}

/// Nearest and farthest surface; nearest < farthest when nothing is there.
struct DepthRange {
    int nearest = 0, farthest = 65535;
};

DepthRange depthRange(const GBuffer& g, Workers& workers) {
    std::vector<DepthRange> ranges(size_t(workers.threads()));
    workers.parallelFor(g.height(), 16, [&](int begin, int end, int worker) {
        DepthRange& range = ranges[size_t(worker)];
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < g.width(); ++x) {
                if (g.depth.at(x, y) != 0) {
                    const int depth = logDepth16(g.depth.at(x, y));
                    range.nearest = std::max(range.nearest, depth);
                    range.farthest = std::min(range.farthest, depth);
                }
            }
        }
    });
    DepthRange all;
    for (const DepthRange& range : ranges) {
        all.nearest = std::max(all.nearest, range.nearest);
        all.farthest = std::min(all.farthest, range.farthest);
    }
    return all;
}

/// Red, yellow, green, cyan, blue, magenta, red: a place on the way around, 0 … 6 · 256 − 1.
std::array<int, 3> hueColour(int place) {
    const int sixth = place / 256, within = place % 256;
    const int rising = within, falling = 255 - within;
    switch (sixth) {
        case 0:
            return {255, rising, 0};
        case 1:
            return {falling, 255, 0};
        case 2:
            return {0, 255, rising};
        case 3:
            return {0, falling, 255};
        case 4:
            return {rising, 0, 255};
        default:
            return {255, 0, falling};
    }
}

/// Direction (y down) as a place for hueColour(): right is red, then counter-clockwise. The way
/// along a square stands in for the angle, which keeps it in whole numbers.
int directionPlace(int x, int y) {
    const int length = std::abs(x) + std::abs(y);
    const auto quarter = [&](int part) { return int(int64_t{384} * part / length); };
    const int up = -y;
    if (x > 0 && up >= 0) {
        return std::min(quarter(up), 383);
    }
    if (x <= 0 && up > 0) {
        return 384 + std::min(quarter(-x), 383);
    }
    if (x < 0 && up <= 0) {
        return 768 + std::min(quarter(-up), 383);
    }
    return 1152 + std::min(quarter(x), 383);
}

}  // namespace

void paintColour(const GBuffer& g, const OutputTable& table, ImageView<Rgb8> out,
                 Workers& workers) {
    encodeOutput({g.red.view(), g.green.view(), g.blue.view()}, table, out, workers);
}

void paintDepth(const GBuffer& g, ImageView<Rgb8> out, Workers& workers) {
    constexpr int kDarkest = 24;  // the farthest surface still differs from nothing
    const DepthRange range = depthRange(g, workers);
    const int span = std::max(1, range.nearest - range.farthest);
    paintRows(out, workers, [&](int x, int y) {
        const uint32_t depth = g.depth.at(x, y);
        return depth == 0 ? kNothing
                          : grey(mix(kDarkest, 255, logDepth16(depth) - range.farthest, span));
    });
}

void paintNormal(const GBuffer& g, ImageView<Rgb8> out, Workers& workers) {
    paintRows(out, workers, [&](int x, int y) {
        if ((g.id.at(x, y) & kSurfaceMask) == 0) {
            return kNothing;
        }
        const NormalVector n = decodeOctahedral(g.normal.at(x, y));
        const float scale = 127.5f / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        return Rgb8{toByte(127.5f + n.x * scale), toByte(127.5f + n.y * scale),
                    toByte(127.5f + n.z * scale)};
    });
}

Rgb8 surfaceColour(uint32_t surface) {
    if (surface == 0) {
        return kNothing;
    }
    const uint32_t hash = surface * 0x9E3779B1u;  // neighbours in number fall far apart
    const auto bright = [&](int shift) { return uint8_t(64 + (hash >> shift) % 192); };
    return {bright(24), bright(16), bright(8)};
}

void paintId(const GBuffer& g, ImageView<Rgb8> out, Workers& workers) {
    paintRows(out, workers,
              [&](int x, int y) { return surfaceColour(g.id.at(x, y) & kSurfaceMask); });
}

Rgb8 motionColour(Motion motion) {
    if (motion.x_fx8 == kNoHistory) {
        return kNothing;
    }
    // The plane says where things come from.
    const int x = -motion.x_fx8, y = -motion.y_fx8;
    if (x == 0 && y == 0) {
        return {255, 255, 255};
    }
    const double speed = std::sqrt(double(x) * x + double(y) * y);
    const int colourful = std::min(255, int(255 * std::sqrt(speed / kMotionFull_fx8)));
    const auto hue = hueColour(directionPlace(x, y));
    return {uint8_t(mix(255, hue[0], colourful, 255)), uint8_t(mix(255, hue[1], colourful, 255)),
            uint8_t(mix(255, hue[2], colourful, 255))};
}

void paintMotion(const GBuffer& g, ImageView<Rgb8> out, Workers& workers) {
    paintRows(out, workers, [&](int x, int y) { return motionColour(g.motion.at(x, y)); });
}

void paintLight(const LightPlanes& light, const OutputTable& table, ImageView<Rgb8> out,
                Workers& workers) {
    paintRows(out, workers, [&](int x, int y) {
        if (light.direct.red.empty()) {
            return kNothing;
        }
        const auto at = [&](ImageView<const uint16_t> a, ImageView<const uint16_t> b) {
            const int px = x * a.width / out.width, py = y * a.height / out.height;
            return table[uint16_t(std::min(a.at(px, py) + b.at(px, py), 65535))];
        };
        return Rgb8{at(light.direct.red, light.indirect.red),
                    at(light.direct.green, light.indirect.green),
                    at(light.direct.blue, light.indirect.blue)};
    });
}

/// The value of a plane that may be smaller than the picture.
static int valueUnder(ImageView<const uint8_t> plane, ImageView<Rgb8> out, int x, int y) {
    return plane.at(x * plane.width / out.width, y * plane.height / out.height);
}

void paintCount(ImageView<const uint8_t> count, int full, ImageView<Rgb8> out, Workers& workers) {
    paintRows(out, workers, [&](int x, int y) {
        return count.empty()
                   ? kNothing
                   : grey(int(255 * std::sqrt(double(valueUnder(count, out, x, y)) / full) + 0.5));
    });
}

void paintConfidence(ImageView<const uint8_t> confidence, int full, ImageView<Rgb8> out,
                     Workers& workers) {
    paintRows(out, workers, [&](int x, int y) {
        return confidence.empty() ? kNothing : grey(valueUnder(confidence, out, x, y) * 255 / full);
    });
}

Rgb8 heatColour(int value) {
    constexpr std::array<std::array<int, 3>, 6> kStops{
        {{0, 0, 0}, {0, 0, 200}, {200, 0, 180}, {255, 128, 0}, {255, 255, 0}, {255, 255, 255}}};
    constexpr int kStep = 51;
    const int clamped = std::clamp(value, 0, 255);
    const size_t stop = size_t(std::min(clamped / kStep, 4));
    const int within = clamped - int(stop) * kStep;
    const auto channel = [&](size_t c) {
        return uint8_t(mix(kStops[stop][c], kStops[stop + 1][c], within, kStep));
    };
    return {channel(0), channel(1), channel(2)};
}

Rgb8 verdictColour(Verdict verdict) {
    switch (verdict) {
        case Verdict::taken:
            return kNothing;
        case Verdict::no_history:
            return {255, 255, 255};
        case Verdict::off_screen:
            return {0, 220, 220};
        case Verdict::depth:
            return {230, 30, 30};
        case Verdict::normal:
            return {0, 190, 50};
        case Verdict::id:
            return {245, 225, 0};
        case Verdict::colour:
            return {230, 0, 220};
        case Verdict::velocity:
            return {255, 140, 0};
        case Verdict::epoch:
            return {40, 80, 255};
        case Verdict::seam:
            return {140, 80, 30};
    }
    return kNothing;
}

void paintRejection(ImageView<const Verdict> reason, ImageView<const uint8_t> lost,
                    ImageView<const Rgb8> picture, ImageView<Rgb8> out, Workers& workers) {
    paintRows(out, workers, [&](int x, int y) {
        const Rgb8 under = blend(greyOf(picture.at(x, y)), kNothing, 96);
        const int part = lost.at(x, y);
        return part == 0 ? under : blend(under, verdictColour(reason.at(x, y)), 96 + part * 5 / 8);
    });
}

Rgb8 tileColour(const TileWork& work) {
    if (!work.drawn) {
        return {0, 160, 60};
    }
    if (work.resolved) {
        return {230, 40, 30};
    }
    return work.recorded ? Rgb8{255, 140, 0} : Rgb8{240, 220, 0};
}

void paintTiles(std::span<const TileWork> tiles, ImageView<const Rgb8> picture, ImageView<Rgb8> out,
                Workers& workers) {
    const int tiles_x = (out.width + kTileSize - 1) / kTileSize;
    paintRows(out, workers, [&](int x, int y) {
        const size_t tile = size_t(y / kTileSize * tiles_x + x / kTileSize);
        const Rgb8 colour = tile < tiles.size() ? tileColour(tiles[tile]) : kNothing;
        return blend(greyOf(picture.at(x, y)), colour, 128);
    });
}

void paintOverdraw(ImageView<const uint16_t> triangles, ImageView<Rgb8> out, Workers& workers) {
    constexpr int kStep = 25;  // white from 11 triangles on
    paintRows(out, workers, [&](int x, int y) {
        return heatColour(std::min<int>(triangles.at(x, y), 255) * kStep);
    });
}

void paintError(ImageView<const Rgb8> picture, ImageView<const Rgb8> reference, ImageView<Rgb8> out,
                Workers& workers) {
    constexpr int kGain = 4;
    paintRows(out, workers, [&](int x, int y) {
        const Rgb8 a = picture.at(x, y), b = reference.at(x, y);
        const int difference =
            std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
        return heatColour(difference * kGain);
    });
}

}  // namespace still::inspect
