#include "synthetic.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "rasterizer/fixed.h"

namespace synthetic {
namespace {

struct Hit {
    const Layer* layer = nullptr;
    Point local;
    double depth = 0;
};

Hit hitAt(const World& world, int frame, Point screen) {
    Hit hit;
    for (const Layer& layer : world.layers) {
        const Point local = layer.pose(frame).toLocal(screen);
        const double depth =
            layer.depth * (1 + layer.depth_slope.x * local.x + layer.depth_slope.y * local.y);
        if (layer.covers(local) && depth > hit.depth) {
            hit = {&layer, local, depth};
        }
    }
    return hit;
}

uint16_t fx12(double v) {
    return uint16_t(std::clamp(std::floor(v * 4096 + 0.5), 0.0, 65535.0));
}

double encoded(double v) {
    v = std::clamp(v, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

double hashed(int x, int y, int channel) {
    uint32_t h =
        uint32_t(x) * 0x9E3779B1u ^ uint32_t(y) * 0x85EBCA77u ^ uint32_t(channel + 1) * 0xC2B2AE3Du;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 13;
    return double(h & 0xFFFF) / 65535;
}

bool differs(const Pose& a, const Pose& b) {
    return a.offset.x != b.offset.x || a.offset.y != b.offset.y || a.angle != b.angle ||
           a.scale != b.scale;
}

void renderPixel(const World& world, int frame, int x, int y, Point screen, still::GBuffer& out) {
    const Hit hit = hitAt(world, frame, screen);
    const Layer& layer = *hit.layer;
    const int last = std::max(frame - 1, 0);
    const Pose before = layer.pose(last);
    const Colour c = layer.colour(hit.local);
    out.red.at(x, y) = fx12(c[0]);
    out.green.at(x, y) = fx12(c[1]);
    out.blue.at(x, y) = fx12(c[2]);
    out.depth.at(x, y) = std::bit_cast<uint32_t>(float(hit.depth));
    const bool moved = layer.moves && differs(layer.pose(frame), before);
    out.id.at(x, y) = uint16_t(layer.surface | (moved ? still::kMovedBit : 0));
    if (out.planes.normal) {
        out.normal.at(x, y) = layer.normal;
    }
    const Point old = before.toScreen(hit.local);
    const auto fx8 = [](double v) { return int(std::floor(v * 256 + 0.5)); };
    const int mx = fx8(old.x - screen.x), my = fx8(old.y - screen.y);
    const bool far = std::abs(mx) > 32766 || std::abs(my) > 32766;
    out.motion.at(x, y) =
        far ? still::Motion{still::kNoHistory, 0} : still::Motion{int16_t(mx), int16_t(my)};
    out.depth_before.at(x, y) = still::logDepth16(out.depth.at(x, y));
}

/// Marks tiles that a moving layer is now or was before within 2 pixels of, by points half a pixel
/// apart.
void fillFacts(const World& world, int frame, still::GBuffer& out) {
    for (int t = 0; t < int(out.tiles.size()); ++t) {
        still::TileFacts& facts = out.tiles[size_t(t)];
        facts = {};
        facts.camera_moved = world.camera_moves && frame > 0;
        const int x0 = t % out.tiles_x * still::kTileSize, y0 = t / out.tiles_x * still::kTileSize;
        for (const Layer& layer : world.layers) {
            const Pose now = layer.pose(frame), old = layer.pose(std::max(frame - 1, 0));
            if (!layer.moves || !differs(now, old)) {
                continue;
            }
            for (int y = 2 * (y0 - 2); y < 2 * (y0 + still::kTileSize + 2); ++y) {
                for (int x = 2 * (x0 - 2); x < 2 * (x0 + still::kTileSize + 2); ++x) {
                    const Point p{x * 0.5, y * 0.5};
                    facts.moved |= layer.covers(now.toLocal(p)) || layer.covers(old.toLocal(p));
                }
            }
        }
    }
}

}  // namespace

Point Pose::toScreen(Point p) const {
    const double c = std::cos(angle) * scale, s = std::sin(angle) * scale;
    return {c * p.x - s * p.y + offset.x, s * p.x + c * p.y + offset.y};
}

Point Pose::toLocal(Point p) const {
    const double c = std::cos(angle) / scale, s = std::sin(angle) / scale;
    const double x = p.x - offset.x, y = p.y - offset.y;
    return {c * x + s * y, -s * x + c * y};
}

std::array<int, 2> jitter(int frame) {
    const uint32_t i = uint32_t(frame) % 64;
    uint32_t a = 0, b = 0, direction = 32;
    for (uint32_t bit = 0; bit < 6; ++bit) {
        if ((i >> bit & 1) != 0) {
            a |= 32u >> bit;
            b ^= direction;
        }
        direction ^= direction >> 1;
    }
    return {int(a) * 4 + 2 - 128, int(b) * 4 + 2 - 128};
}

void render(const World& world, int frame, std::array<int, 2> jitter_fx8, still::GBuffer& out,
            bool with_normals) {
    out.resize(world.width, world.height, {.normal = with_normals, .motion = true});
    for (int y = 0; y < world.height; ++y) {
        for (int x = 0; x < world.width; ++x) {
            renderPixel(world, frame, x, y, {x + jitter_fx8[0] / 256.0, y + jitter_fx8[1] / 256.0},
                        out);
        }
    }
    fillFacts(world, frame, out);
}

void render(const World& world, int frame, still::GBuffer& out, bool with_normals) {
    render(world, frame, jitter(frame), out, with_normals);
}

std::vector<Colour> reference(const World& world, int frame, int grid) {
    std::vector<Colour> image(size_t(world.width * world.height));
    for (int y = 0; y < world.height; ++y) {
        for (int x = 0; x < world.width; ++x) {
            Colour& sum = image[size_t(y * world.width + x)];
            for (int k = 0; k < grid * grid; ++k) {
                const Point p{x + (k % grid + 0.5) / grid - 0.5, y + (k / grid + 0.5) / grid - 0.5};
                const Hit hit = hitAt(world, frame, p);
                const Colour c = hit.layer->colour(hit.local);
                for (size_t i = 0; i < 3; ++i) {
                    sum[i] += c[i] / (grid * grid);
                }
            }
        }
    }
    return image;
}

double psnr(still::ImageView<const uint16_t> red, still::ImageView<const uint16_t> green,
            still::ImageView<const uint16_t> blue, const std::vector<Colour>& wanted, int margin) {
    double sum = 0;
    int n = 0;
    for (int y = margin; y < red.height - margin; ++y) {
        for (int x = margin; x < red.width - margin; ++x) {
            const Colour& w = wanted[size_t(y * red.width + x)];
            const double d[3] = {encoded(red.at(x, y) / 4096.0) - encoded(w[0]),
                                 encoded(green.at(x, y) / 4096.0) - encoded(w[1]),
                                 encoded(blue.at(x, y) / 4096.0) - encoded(w[2])};
            sum += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            n += 3;
        }
    }
    return sum == 0 ? 200.0 : 10 * std::log10(n / sum);
}

Colour noise(Point p, double size) {
    Colour result{};
    const double u = p.x / size, v = p.y / size;
    const int x = int(std::floor(u)), y = int(std::floor(v));
    const double fu = u - x, fv = v - y;
    const double su = fu * fu * (3 - 2 * fu), sv = fv * fv * (3 - 2 * fv);
    for (int c = 0; c < 3; ++c) {
        const double top = hashed(x, y, c) * (1 - su) + hashed(x + 1, y, c) * su;
        const double low = hashed(x, y + 1, c) * (1 - su) + hashed(x + 1, y + 1, c) * su;
        result[size_t(c)] = 0.05 + 0.9 * (top * (1 - sv) + low * sv);
    }
    return result;
}

Colour checker(Point p, double size) {
    const bool odd = ((int(std::floor(p.x / size)) ^ int(std::floor(p.y / size))) & 1) != 0;
    return odd ? Colour{0.8, 0.75, 0.6} : Colour{0.06, 0.08, 0.1};
}

}  // namespace synthetic
