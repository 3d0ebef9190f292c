#include "postfx/internal/started.h"

#include <algorithm>
#include <atomic>

namespace still::taa {
namespace {

constexpr uint32_t kLongAgo = 255;

/// Sets the bits of all moved surfaces in the tile. Ors commute: the order of tiles is no matter.
/// Words of 32 bits, for small CPUs have no larger atomic ones.
void collectMoved(const GBuffer& gbuffer, int tile, uint32_t* bits) {
    const int x0 = tile % gbuffer.tiles_x * kTileSize, y0 = tile / gbuffer.tiles_x * kTileSize;
    const int x1 = std::min(x0 + kTileSize, gbuffer.width());
    const int y1 = std::min(y0 + kTileSize, gbuffer.height());
    uint16_t last = 0;
    for (int y = y0; y < y1; ++y) {
        const uint16_t* row = gbuffer.id.view().row(y);
        for (int x = x0; x < x1; ++x) {
            if (row[x] == last || (row[x] & kMovedBit) == 0) {
                continue;
            }
            last = row[x];
            const auto surface = size_t(last & kSurfaceMask);
            std::atomic_ref<uint32_t>(bits[surface / 32])
                .fetch_or(uint32_t{1} << (surface % 32), std::memory_order_relaxed);
        }
    }
}

}  // namespace

void StartedSurfaces::note(const GBuffer& gbuffer, bool first, Workers& workers) {
    before_ = now_;
    now_ = {};
    workers.parallelFor(int(gbuffer.tiles.size()), 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) {
            if (gbuffer.tiles[size_t(tile)].moved) {
                collectMoved(gbuffer, tile, now_.data());
            }
        }
    });
    any_ = false;
    for (size_t i = 0; i < started_.size(); ++i) {
        started_[i] = first ? 0 : now_[i] & ~before_[i];
        any_ |= started_[i] != 0;
    }
    const bool camera = !gbuffer.tiles.empty() && gbuffer.tiles[0].camera_moved;
    camera_started_ = camera && !camera_ && !first;
    camera_ = camera;
}

void StartedSurfaces::countAges(bool first, int ring) {
    const bool now = any_ || camera_started_;
    since_ = first ? ring : (now ? 0 : std::min(since_ + 1, ring));
    ring_ = ring;
    if (since_ >= ring) {
        ages_.clear();
        return;
    }
    if (ages_.empty()) {
        ages_.assign(started_.size() * 32, kLongAgo);
    }
    for (size_t surface = 0; surface < ages_.size(); ++surface) {
        const bool starts = camera_started_ || contains(int(surface));
        ages_[surface] = starts ? 0 : std::min(ages_[surface] + 1, kLongAgo);
    }
}

void forgetStarted(const StartedSurfaces& started, ImageView<const int16_t> last,
                   const TileRect& tile, ImageView<uint8_t> count) noexcept {
    for (int y = std::max(tile.y0 - 1, 0); y < std::min(tile.y1 + 1, last.height); ++y) {
        for (int x = std::max(tile.x0 - 1, 0); x < std::min(tile.x1 + 1, last.width); ++x) {
            if (!started.contains(last.at(x, y) & int(kSurfaceMask))) {
                continue;
            }
            for (int j = std::max(y - 1, tile.y0); j <= std::min(y + 1, tile.y1 - 1); ++j) {
                for (int i = std::max(x - 1, tile.x0); i <= std::min(x + 1, tile.x1 - 1); ++i) {
                    count.at(i, j) = 0;
                }
            }
        }
    }
}

}  // namespace still::taa
