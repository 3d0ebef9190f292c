#include "engine/stage_hash.h"

#include <algorithm>

#include "engine/hash.h"

namespace still {
namespace {

template <class T>
ImageView<const T> tileOf(ImageView<const T> plane, int tile_x, int tile_y) {
    const int x0 = tile_x * kTileSize, y0 = tile_y * kTileSize;
    return {plane.row(y0) + x0, std::min(kTileSize, plane.width - x0),
            std::min(kTileSize, plane.height - y0), plane.stride};
}

/// Hash of several planes of one size, as a whole and by tile.
template <class... T>
StageHash hashPlanes(ImageView<const T>... planes) {
    const auto combine = [](auto... hashes) {
        uint64_t sum = 0;
        ((sum = sum * 3 + hashes), ...);
        return sum;
    };
    StageHash hash;
    hash.whole = combine(hashPlane(planes)...);
    const int width = std::max({planes.width...}), height = std::max({planes.height...});
    for (int y = 0; y * kTileSize < height; ++y) {
        for (int x = 0; x * kTileSize < width; ++x) {
            hash.tiles.push_back(uint32_t(combine(hashPlane(tileOf(planes, x, y))...)));
        }
    }
    return hash;
}

StageHash hashLight(const LightPlanes& light) {
    const ColourPlanes &a = light.direct, &b = light.indirect;
    return hashPlanes(a.red, a.green, a.blue, b.red, b.green, b.blue);
}

}  // namespace

const char* name(Stage stage) {
    constexpr const char* kNames[kStages] = {"depth", "id",       "normal", "motion", "albedo",
                                             "light", "denoised", "color",  "linear", "output"};
    return kNames[int(stage)];
}

StageHashes hashStages(const FrameResult& frame) {
    const GBuffer& g = *frame.gbuffer;
    StageHashes hashes;
    const auto at = [&](Stage stage) -> StageHash& { return hashes[size_t(stage)]; };
    at(Stage::depth) = hashPlanes(g.depth.view());
    at(Stage::id) = hashPlanes(g.id.view());
    if (g.planes.normal) {
        at(Stage::normal) = hashPlanes(g.normal.view());
    }
    if (g.planes.motion) {
        at(Stage::motion) = hashPlanes(g.motion.view(), g.depth_before.view());
    }
    if (g.planes.albedo) {
        at(Stage::albedo) =
            hashPlanes(g.albedo_red.view(), g.albedo_green.view(), g.albedo_blue.view());
    }
    if (!frame.light.direct.red.empty()) {
        at(Stage::light) = hashLight(frame.light);
    }
    if (!frame.denoised.direct.red.empty()) {
        at(Stage::denoised) = hashLight(frame.denoised);
    }
    at(Stage::color) = hashPlanes(g.red.view(), g.green.view(), g.blue.view());
    at(Stage::linear) = hashPlanes(frame.linear.red, frame.linear.green, frame.linear.blue);
    at(Stage::output) = hashPlanes(frame.output);
    return hashes;
}

std::optional<StageDifference> firstDifference(const StageHashes& expected,
                                               const StageHashes& found) {
    for (int stage = 0; stage < kStages; ++stage) {
        const StageHash &a = expected[size_t(stage)], &b = found[size_t(stage)];
        if (a == b) {
            continue;
        }
        StageDifference difference{Stage(stage), {}};
        for (size_t i = 0; a.tiles.size() == b.tiles.size() && i < a.tiles.size(); ++i) {
            if (a.tiles[i] != b.tiles[i]) {
                difference.tiles.push_back(int(i));
            }
        }
        return difference;
    }
    return std::nullopt;
}

}  // namespace still
