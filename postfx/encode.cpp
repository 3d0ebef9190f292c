// The tables are walked, not computed entry by entry: code c begins at the smallest input that is
// nearer to c than to c − 1 after encoding, i.e. at decode((c − ½) / 255). So only the decoding
// curve of IEC 61966-2-1 is needed, and its power 2.4 is x² · ⁵√x² with a root by Newton's method.

#include "postfx/encode.h"

#include <algorithm>
#include <cassert>

#include "rasterizer/fixed.h"

namespace still {
namespace {

/// ⁵√a for a in (0, 1]. Newton from above: falls monotonically, by a fifth at first, then doubles
/// its digits; 40 steps are more than enough for a > 1e-4.
double fifthRoot(double a) {
    double y = 1.0;
    for (int i = 0; i < 40; ++i) {
        const double y2 = y * y;
        y = (4.0 * y + a / (y2 * y2)) / 5.0;
    }
    return y;
}

/// sRGB value in 0 … 1 → linear light.
double decodeSrgb(double s) {
    if (s <= 0.04045) {
        return s / 12.92;
    }
    const double x = (s + 0.055) / 1.055;
    const double x2 = x * x;
    return x2 * fifthRoot(x2);
}

double toneMapped(double c, ToneMap tone_map) {
    return tone_map == ToneMap::none ? c : c * (1.0 + c / 256.0) / (1.0 + c);
}

constexpr int kGrainRows = 16;

}  // namespace

OutputTable::OutputTable(ToneMap tone_map, double exposure) {
    int code = 0;
    double next_begins = decodeSrgb(0.5 / 255.0);
    for (int v = 0; v < 65536; ++v) {
        const double light = toneMapped(double(v) / double(kColourOne) * exposure, tone_map);
        while (code < 255 && light >= next_begins) {
            ++code;
            next_begins = decodeSrgb((double(code) + 0.5) / 255.0);
        }
        table_[size_t(v)] = uint8_t(code);
    }
}

void encodeOutput(const ColourPlanes& colour, const OutputTable& table, ImageView<Rgb8> out,
                  Workers& workers, std::span<const uint8_t> changed) {
    assert(out.width == colour.red.width && out.height == colour.red.height);
    const int tiles_x = (out.width + kTileSize - 1) / kTileSize;
    const auto encode = [&](int y, int x0, int x1) {
        const uint16_t* red = colour.red.row(y);
        const uint16_t* green = colour.green.row(y);
        const uint16_t* blue = colour.blue.row(y);
        Rgb8* row = out.row(y);
        for (int x = x0; x < x1; ++x) {
            row[x] = {table[red[x]], table[green[x]], table[blue[x]]};
        }
    };
    workers.parallelFor(out.height, kGrainRows, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            if (changed.empty()) {
                encode(y, 0, out.width);
                continue;
            }
            const uint8_t* tiles = changed.data() + y / kTileSize * tiles_x;
            for (int tile = 0; tile < tiles_x; ++tile) {
                if (tiles[tile] != 0) {
                    encode(y, tile * kTileSize, std::min((tile + 1) * kTileSize, out.width));
                }
            }
        }
    });
}

}  // namespace still
