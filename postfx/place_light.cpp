#include "postfx/place_light.h"

#include <algorithm>
#include <cstdlib>

#include "rasterizer/fixed.h"

namespace still {
namespace {

constexpr int kRowGrain = 16;
/// Octahedral normals (snorm16) of a smooth surface differ by less, per coordinate.
constexpr int kSameNormal = 3000;

bool alike(const GBuffer& g, int x, int y, int other_x, int other_y) {
    const int surfaces = g.id.at(x, y) ^ g.id.at(other_x, other_y);
    const uint32_t a = g.normal.at(x, y), b = g.normal.at(other_x, other_y);
    const int dx = int16_t(a & 0xFFFF) - int16_t(b & 0xFFFF);
    const int dy = int16_t(a >> 16) - int16_t(b >> 16);
    return (surfaces & kSurfaceMask) == 0 && std::abs(dx) < kSameNormal &&
           std::abs(dy) < kSameNormal;
}

/// Four pixels around a sample and their weights, 1.0 = 2^16; those of another surface weigh
/// nothing.
struct Taps {
    int x[4] = {}, y[4] = {}, weight[4] = {};
};

Taps tapsOf(const GBuffer& g, int x, int y, int jitter_x_fx8, int jitter_y_fx8) {
    const int part_x = std::abs(jitter_x_fx8), part_y = std::abs(jitter_y_fx8);
    const int side_x = std::clamp(x + (jitter_x_fx8 < 0 ? -1 : 1), 0, g.width() - 1);
    const int side_y = std::clamp(y + (jitter_y_fx8 < 0 ? -1 : 1), 0, g.height() - 1);
    Taps taps{{x, side_x, x, side_x},
              {y, y, side_y, side_y},
              {(256 - part_x) * (256 - part_y), part_x * (256 - part_y), (256 - part_x) * part_y,
               part_x * part_y}};
    for (int i = 1; i < 4; ++i) {
        if (!alike(g, x, y, taps.x[i], taps.y[i])) {
            taps.weight[0] += taps.weight[i];
            taps.weight[i] = 0;
        }
    }
    return taps;
}

uint16_t lightAt(ImageView<const uint16_t> plane, const Taps& taps) {
    uint32_t sum = 0;  // 65535 · 2^16 + 2^15 at most
    for (int i = 0; i < 4; ++i) {
        sum += uint32_t(taps.weight[i]) * plane.at(taps.x[i], taps.y[i]);
    }
    return uint16_t(roundShift(sum, 16));
}

}  // namespace

void placeLight(const GBuffer& gbuffer, const LightPlanes& light, int jitter_x_fx8,
                int jitter_y_fx8, LightImages& out, Workers& workers) {
    out.resize(gbuffer.width(), gbuffer.height());
    const ImageView<const uint16_t> from[6] = {light.direct.red,     light.direct.green,
                                               light.direct.blue,    light.indirect.red,
                                               light.indirect.green, light.indirect.blue};
    Image<uint16_t>* const to[6] = {&out.direct_red,   &out.direct_green,   &out.direct_blue,
                                    &out.indirect_red, &out.indirect_green, &out.indirect_blue};
    workers.parallelFor(gbuffer.height(), kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < gbuffer.width(); ++x) {
                const Taps taps = tapsOf(gbuffer, x, y, jitter_x_fx8, jitter_y_fx8);
                for (int p = 0; p < 6; ++p) {
                    to[p]->at(x, y) = lightAt(from[p], taps);
                }
            }
        }
    });
}

}  // namespace still
