#include <algorithm>
#include <bit>
#include <cstdlib>

#include "random_frames.h"
#include "rasterizer/fixed.h"

namespace random_frames {
namespace {

using namespace still;

int within(Random& random, int range) {
    return random.below(2 * range + 1) - range;
}

/// Pixels per frame in 1/256: none, whole, half, slow, any, and so fast that little remains.
int randomSpeed(Random& random) {
    switch (random.below(7)) {
        case 0:
        case 1:
            return 0;
        case 2:
            return within(random, 4) * 256;
        case 3:
            return within(random, 4) * 128;
        case 4:
            return within(random, 24);
        case 5:
            return within(random, 900);
        default:
            return within(random, random.chance(20) ? 32767 : 4000);
    }
}

int grainAt(int x, int y, int surface) {
    uint32_t h = uint32_t(x) * 0x9E3779B1u ^ uint32_t(y) * 0x85EBCA77u ^ uint32_t(surface) * 40503u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    return int(h >> 20);
}

uint16_t saturated(int v) {
    return uint16_t(std::clamp(v, 0, 65535));
}

}  // namespace

Film::Film(int width, int height, bool with_normals, uint64_t seed)
    : width_(width), height_(height), with_normals_(with_normals), random_(seed) {
    // Surfaces with all their bits in use, too; the last boxes share theirs.
    constexpr uint16_t kSurfaces[] = {0, 1, 2, 3, 4, 0x4001, 0x7FFF, 7, 8, 2, 3};
    const int count = 1 + random_.below(int(std::size(kSurfaces)));
    for (int i = 0; i < count; ++i) {
        Box box;
        box.surface = kSurfaces[i];
        box.x_fx8 = random_.below(width * 256);
        box.y_fx8 = random_.below(height * 256);
        const int thin = 12 + random_.below(120), wide = 256 + random_.below(40 * 256);
        const int shape = random_.below(3);
        box.half_x_fx8 = shape == 0 ? thin : wide;
        box.half_y_fx8 = shape == 1 ? thin : wide;
        box.depth =
            i == 0 ? (random_.chance(20) ? 0.0f : 0.02f)
                   : 0.02f + float(1 + random_.below(60)) * (random_.chance(50) ? 0.01f : 0.0003f);
        box.slope_x = random_.chance(40) ? float(within(random_, 100)) * 0.0001f : 0;
        box.slope_y = random_.chance(40) ? float(within(random_, 100)) * 0.0001f : 0;
        box.parallax_fx8 = random_.chance(50) ? 256 : 128 + random_.below(300);
        box.depth_step = random_.chance(30) ? within(random_, 40) : 0;
        box.normal = uint32_t(random_.below(65536)) << 16 | uint32_t(random_.below(65536));
        box.colour = random_.chance(90) ? random_.below(5000) : random_.below(65536);
        // Rough, next to flat, flat.
        box.grain = 1 + (random_.chance(50) ? random_.below(5) : random_.below(5000));
        boxes_.push_back(box);
    }
}

/// New orders, now and then, for the camera, for things and for the noise.
void Film::direct() {
    if (random_.chance(15)) {
        const bool rest = random_.chance(45);
        camera_x_fx8_ = rest ? 0 : randomSpeed(random_);
        camera_y_fx8_ = rest ? 0 : randomSpeed(random_);
        zoom_ = rest || random_.chance(70) ? 0 : within(random_, 4);
    }
    for (size_t i = 1; i < boxes_.size(); ++i) {
        if (random_.chance(12)) {
            const bool rest = random_.chance(50);
            boxes_[i].own_x_fx8 = rest ? 0 : randomSpeed(random_);
            boxes_[i].own_y_fx8 = rest ? 0 : randomSpeed(random_);
        }
        if (random_.chance(8)) {
            boxes_[i].normal ^= uint32_t(random_.below(65536)) << random_.below(17);
        }
    }
    if (random_.chance(30)) {
        noise_percent_ = random_.chance(50) ? 0 : random_.below(30);
    }
}

void Film::step(Box& box) {
    box.step_x_fx8 = ((camera_x_fx8_ * box.parallax_fx8) >> 8) + box.own_x_fx8;
    box.step_y_fx8 = ((camera_y_fx8_ * box.parallax_fx8) >> 8) + box.own_y_fx8;
    box.x_fx8 += box.step_x_fx8;
    box.y_fx8 += box.step_y_fx8;
    // What leaves comes back at the other side.
    const int reach_x = (width_ + 80) * 256, reach_y = (height_ + 80) * 256;
    box.x_fx8 += std::abs(box.x_fx8) > reach_x ? (box.x_fx8 > 0 ? -reach_x : reach_x) : 0;
    box.y_fx8 += std::abs(box.y_fx8) > reach_y ? (box.y_fx8 > 0 ? -reach_y : reach_y) : 0;
}

void Film::draw(int x, int y, const TaaFrame& frame, GBuffer& out) {
    const int sx = x * 256 + frame.jitter_x_fx8, sy = y * 256 + frame.jitter_y_fx8;
    const auto depthOf = [&](const Box& box) {
        return box.depth * (1.0f + box.slope_x * float(sx - box.x_fx8) / 256.0f +
                            box.slope_y * float(sy - box.y_fx8) / 256.0f);
    };
    const Box* top = &boxes_[0];
    float depth = std::clamp(depthOf(*top), 0.0f, 1.0f);
    for (const Box& box : boxes_) {
        const bool covers =
            std::abs(sx - box.x_fx8) < box.half_x_fx8 && std::abs(sy - box.y_fx8) < box.half_y_fx8;
        const float candidate = std::clamp(depthOf(box), 0.0f, 1.0f);
        if (covers && candidate > depth) {
            top = &box;
            depth = candidate;
        }
    }
    const bool moved = top->own_x_fx8 != 0 || top->own_y_fx8 != 0;
    const bool moves = moved || out.tiles[0].camera_moved;
    const int grain = grainAt((sx - top->x_fx8) >> 9, (sy - top->y_fx8) >> 9, top->surface);
    out.red.at(x, y) = saturated(top->colour + grain / top->grain);
    out.green.at(x, y) = saturated(top->colour / 2 + (grain * 7 & 4095) / top->grain);
    out.blue.at(x, y) = saturated(top->colour / 3 + (grain * 13 & 4095) / top->grain);
    out.depth.at(x, y) = std::bit_cast<uint32_t>(depth);
    out.id.at(x, y) = uint16_t(top->surface | (moved ? kMovedBit : 0));
    const int zoomed = out.tiles[0].camera_moved ? zoom_ : 0;
    const int mx = -top->step_x_fx8 + (((x - width_ / 2) * zoomed) >> 1);
    const int my = -top->step_y_fx8 + (((y - height_ / 2) * zoomed) >> 1);
    const bool far = std::abs(mx) > 32767 || std::abs(my) > 32767;
    out.motion.at(x, y) =
        !moves ? Motion{} : (far ? Motion{kNoHistory, 0} : Motion{int16_t(mx), int16_t(my)});
    out.depth_before.at(x, y) =
        saturated(int(logDepth16(out.depth.at(x, y))) + (moves ? top->depth_step : 0));
    if (with_normals_) {
        out.normal.at(x, y) = top->normal;
    }
}

/// Something that does not fit. What moves without the camera belongs to a moved object.
void Film::disturb(int x, int y, GBuffer& out) {
    switch (random_.below(6)) {
        case 0:
        case 1:
            out.motion.at(x, y) =
                random_.chance(30)
                    ? Motion{kNoHistory, int16_t(within(random_, 500))}
                    : Motion{int16_t(within(random_, 32767)), int16_t(randomSpeed(random_))};
            if (!out.tiles[0].camera_moved) {
                out.id.at(x, y) |= kMovedBit;
            }
            break;
        case 2:
            out.depth.at(x, y) = std::bit_cast<uint32_t>(float(random_.below(1001)) * 0.001f);
            break;
        case 3:
            out.id.at(x, y) =
                uint16_t((out.id.at(x, y) & kMovedBit) | (random_.below(0x8000) & kSurfaceMask));
            break;
        case 4:
            out.depth_before.at(x, y) = uint16_t(random_.below(65536));
            break;
        default:
            out.red.at(x, y) = 65535;
            out.green.at(x, y) = uint16_t(random_.below(65536));
            if (with_normals_) {
                out.normal.at(x, y) = uint32_t(random_.below(65536)) << 16;
            }
            break;
    }
}

void Film::fillFacts(GBuffer& out) {
    std::vector<uint8_t> moved(out.tiles.size());
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const int tile = y / kTileSize * out.tiles_x + x / kTileSize;
            moved[size_t(tile)] |= (out.id.at(x, y) & kMovedBit) != 0 ? 1 : 0;
        }
    }
    moved_before_.resize(moved.size());
    for (size_t t = 0; t < moved.size(); ++t) {
        out.tiles[t].moved = moved[t] != 0 || moved_before_[t] != 0;
    }
    moved_before_ = moved;
}

TaaFrame Film::next(GBuffer& out) {
    direct();
    out.resize(width_, height_, {.normal = with_normals_, .motion = true});
    TaaFrame frame;
    frame.reset = random_.chance(3);
    frame.shading_changed = random_.chance(4);
    frame.jitter_x_fx8 = random_.chance(5) ? -128 : random_.below(256) - 128;
    frame.jitter_y_fx8 = random_.chance(5) ? 127 : random_.below(256) - 128;
    if (random_.chance(12)) {
        changed_ = {};
        for (const Box& box : boxes_) {
            changed_[box.surface / 64u] |= uint64_t(random_.chance(40) ? 1 : 0)
                                           << (box.surface % 64u);
        }
        frame.changed_surfaces = changed_;
    }
    const bool camera_moved = camera_x_fx8_ != 0 || camera_y_fx8_ != 0 || zoom_ != 0;
    for (TileFacts& facts : out.tiles) {
        facts = {.moved = false, .camera_moved = camera_moved};
    }
    for (Box& box : boxes_) {
        step(box);
    }
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            draw(x, y, frame, out);
            if (random_.chance(noise_percent_)) {
                disturb(x, y, out);
            }
        }
    }
    fillFacts(out);
    return frame;
}

}  // namespace random_frames
