#include "postfx/internal/evidence.h"

#include <algorithm>

namespace still::taa {
namespace {

constexpr size_t kSurfaces = size_t(kSurfaceMask) + 1;
constexpr uint32_t kLongAgo = 255;

bool anyOf(std::span<const uint64_t> surfaces) {
    return std::any_of(surfaces.begin(), surfaces.end(), [](uint64_t word) { return word != 0; });
}

bool contains(std::span<const uint64_t> surfaces, size_t surface) {
    return ((surfaces[surface / 64] >> (surface % 64)) & 1) != 0;
}

}  // namespace

bool changesShading(const TaaFrame& frame) {
    return frame.shading_changed || anyOf(frame.changed_surfaces);
}

bool allStill(const GBuffer& gbuffer) {
    return std::all_of(gbuffer.tiles.begin(), gbuffer.tiles.end(),
                       [](const TileFacts& facts) { return facts.still(); });
}

Current currentOf(const GBuffer& gbuffer) {
    return {
        .colour = {gbuffer.red.view().data, gbuffer.green.view().data, gbuffer.blue.view().data},
        .depth = gbuffer.depth.view().data,
        .id = gbuffer.id.view().data,
        .normal = gbuffer.planes.normal ? gbuffer.normal.view().data : nullptr,
        .motion = gbuffer.motion.view().data,
        .depth_before = gbuffer.depth_before.view().data};
}

void SurfaceChanges::reserve() {
    ages_.reserve(kSurfaces);
    turning_.reserve(kSurfaces);
}

void SurfaceChanges::note(const TaaFrame& frame, bool now, int ring) {
    if (now || since_ < ring) {
        countAges(frame, now, ring);
    }
    noteTurning(frame.turning_surfaces);
}

void SurfaceChanges::countAges(const TaaFrame& frame, bool now, int ring) {
    if (ages_.empty() || since_ >= ring) {
        ages_.assign(kSurfaces, kLongAgo);
    }
    for (uint32_t& age : ages_) {
        age = age < kLongAgo - 1 ? age + 1 : kLongAgo;
    }
    if (frame.shading_changed) {
        std::fill(ages_.begin(), ages_.end(), 0u);
    }
    for (size_t i = 0; i < frame.changed_surfaces.size() * 64; ++i) {
        if (contains(frame.changed_surfaces, i)) {
            ages_[i] = 0;
        }
    }
    since_ = now ? 0 : since_ + 1;
}

void SurfaceChanges::noteTurning(std::span<const uint64_t> surfaces) {
    turning_.clear();
    if (!anyOf(surfaces)) {
        return;
    }
    turning_.resize(kSurfaces);
    for (size_t i = 0; i < std::min(surfaces.size() * 64, kSurfaces); ++i) {
        turning_[i] = contains(surfaces, i) ? 1 : 0;
    }
}

bool noteLightAge(std::span<TileMemory> tiles, ImageView<const uint8_t> age, int past,
                  Workers& workers) {
    if (age.empty()) {
        for (TileMemory& tile : tiles) {
            tile.young = false;
        }
        return false;
    }
    workers.parallelFor(int(tiles.size()), 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) {
            const TileRect rect = tileRect(tile, age.width, age.height);
            uint8_t least = 255;
            for (int y = rect.y0; y < rect.y1; ++y) {
                const uint8_t* row = age.row(y);
                for (int x = rect.x0; x < rect.x1; ++x) {
                    least = std::min(least, row[x]);
                }
            }
            tiles[size_t(tile)].young = least < std::min(past, 255);
        }
    });
    return std::any_of(tiles.begin(), tiles.end(), [](const TileMemory& t) { return t.young; });
}

bool planTiles(std::span<TileMemory> tiles, std::span<const TileFacts> facts, bool first,
               bool shading_changed, int repeats, int ring) {
    const bool overwritten = repeats >= ring;
    bool any = false;
    for (size_t i = 0; i < tiles.size(); ++i) {
        TileMemory& tile = tiles[i];
        tile.tested = shading_changed || facts[i].moved || tile.young;
        tile.quiet = tile.tested ? 0 : tile.quiet;
        tile.keeps = first || facts[i].camera_moved || !tile.settled || tile.quiet < ring;
        tile.keeps &= !overwritten || tile.tested || facts[i].camera_moved;
        any |= tile.keeps;
    }
    return any;
}

void noteJitter(SlotPlanes& slot, const TaaFrame& frame, std::span<const TileMemory> tiles) {
    const TileJitter now{int16_t(frame.jitter_x_fx8), int16_t(frame.jitter_y_fx8)};
    slot.jitter_x_fx8 = frame.jitter_x_fx8;
    slot.jitter_y_fx8 = frame.jitter_y_fx8;
    slot.apart = false;
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i].keeps) {
            slot.tile_jitter[i] = now;
        }
        slot.apart |= !slot.tile_jitter[i].sameAs(now);
    }
}

bool allFinished(std::span<const TileMemory> tiles) {
    return std::all_of(tiles.begin(), tiles.end(),
                       [](const TileMemory& t) { return t.summed && t.finished; });
}

bool allConverged(std::span<const TileMemory> tiles) {
    return allFinished(tiles) &&
           std::none_of(tiles.begin(), tiles.end(), [](const TileMemory& t) { return t.changed; });
}

void restTiles(std::span<TileMemory> tiles) {
    for (TileMemory& tile : tiles) {
        tile.changed = tile.keeps = tile.adds = false;
    }
}

}  // namespace still::taa
