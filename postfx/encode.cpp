// The tables are walked, not computed entry by entry: code c begins at the smallest input that is
// nearer to c than to c − 1 after encoding, i.e. at decode((c − ½) / 255). So only the decoding
// curve of IEC 61966-2-1 is needed, and its power 2.4 is x² · ⁵√x² with a root by Newton's method.

#include "postfx/encode.h"

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

OutputTable::OutputTable(ToneMap tone_map) {
    int code = 0;
    double next_begins = decodeSrgb(0.5 / 255.0);
    for (int v = 0; v < 65536; ++v) {
        const double light = toneMapped(double(v) / double(kColourOne), tone_map);
        while (code < 255 && light >= next_begins) {
            ++code;
            next_begins = decodeSrgb((double(code) + 0.5) / 255.0);
        }
        table_[size_t(v)] = uint8_t(code);
    }
}

void encodeOutput(const ColourPlanes& colour, const OutputTable& table, ImageView<Rgb8> out,
                  Workers& workers) {
    assert(out.width == colour.red.width && out.height == colour.red.height);
    workers.parallelFor(out.height, kGrainRows, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const uint16_t* red = colour.red.row(y);
            const uint16_t* green = colour.green.row(y);
            const uint16_t* blue = colour.blue.row(y);
            Rgb8* row = out.row(y);
            for (int x = 0; x < out.width; ++x) {
                row[x] = {table[red[x]], table[green[x]], table[blue[x]]};
            }
        }
    });
}

}  // namespace still
