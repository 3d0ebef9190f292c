#include "random_frames.h"

#include <bit>
#include <vector>

#include "rasterizer/fixed.h"

namespace random_frames {
namespace {

struct Patch {
    uint16_t id;
    float depth;
    still::Motion motion;
    uint32_t normal;
    int colour;
};

still::Motion randomMotion(Random& random) {
    const auto component = [&] {
        switch (random.below(4)) {
            case 0:
                return 0;
            case 1:
                return (random.below(9) - 4) * 256;
            case 2:
                return random.below(2048) - 1024;
            default:
                return random.below(65535) - 32767;
        }
    };
    if (random.chance(4)) {
        return {still::kNoHistory, int16_t(random.below(1000))};
    }
    const int x = component(), y = component();
    return {int16_t(x), int16_t(y)};
}

Patch randomPatch(const Options& options, Random& random) {
    Patch patch;
    const int surface = random.below(5);
    const bool moved = surface >= 3;
    patch.id = uint16_t(surface | (moved ? still::kMovedBit : 0));
    patch.depth = random.chance(60) ? 0.05f : 0.05f + float(random.below(100)) * 0.009f;
    patch.motion = options.camera_moved || moved ? randomMotion(random) : still::Motion{};
    patch.normal = random.chance(70)
                       ? 0x1234'0321u
                       : uint32_t(random.below(65536)) << 16 | uint32_t(random.below(65536));
    patch.colour = random.chance(80) ? random.below(6000) : random.below(65536);
    return patch;
}

void fillPixel(const Patch& patch, const Options& options, Random& random, int x, int y,
               still::GBuffer& out) {
    const auto near = [&](int v) {
        const int wide = v + random.below(601) - 300;
        return uint16_t(wide < 0 ? 0 : (wide > 65535 ? 65535 : wide));
    };
    out.red.at(x, y) = near(patch.colour);
    out.green.at(x, y) = near(patch.colour / 2);
    out.blue.at(x, y) = random.chance(1) ? 65535 : near(patch.colour / 3);
    const float depth = patch.depth * (1.0f + float(x - y) * 0.0005f);
    out.depth.at(x, y) = std::bit_cast<uint32_t>(depth);
    out.id.at(x, y) = patch.id;
    out.motion.at(x, y) = patch.motion;
    if (random.chance(20) && patch.motion.x_fx8 != still::kNoHistory &&
        (options.camera_moved || (patch.id & still::kMovedBit) != 0)) {
        out.motion.at(x, y).x_fx8 = int16_t((patch.motion.x_fx8 & ~255) | random.below(256));
    }
    const int before = int(still::logDepth16(out.depth.at(x, y))) + random.below(31) - 15;
    out.depth_before.at(x, y) = uint16_t(before < 0 ? 0 : before);
    if (options.with_normals) {
        out.normal.at(x, y) = patch.normal;
    }
}

}  // namespace

int Random::below(int bound) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return int((state_ >> 33) % uint64_t(bound));
}

void fill(const Options& options, Random& random, still::GBuffer& out) {
    out.resize(options.width, options.height, {.normal = options.with_normals, .motion = true});
    const int across = options.width / options.patch + 1;
    std::vector<Patch> row;
    for (int y = 0; y < options.height; ++y) {
        if (y % options.patch == 0) {
            row.clear();
            for (int i = 0; i < across; ++i) {
                row.push_back(randomPatch(options, random));
            }
        }
        for (int x = 0; x < options.width; ++x) {
            fillPixel(row[size_t(x / options.patch)], options, random, x, y, out);
        }
    }
    for (still::TileFacts& facts : out.tiles) {
        facts = {};
        facts.camera_moved = options.camera_moved;
        facts.moved = random.chance(70);
    }
}

}  // namespace random_frames
