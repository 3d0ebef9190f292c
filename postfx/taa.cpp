#include "postfx/taa.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#include "postfx/internal/history.h"
#include "postfx/internal/resolve.h"

namespace still {
namespace {

using taa::HistoryIn;
using taa::HistoryOut;
using taa::ResolveJob;
using taa::TileRect;
using taa::TileResult;
using taa::TileWork;

struct HistoryPlanes {
    std::array<Image<uint16_t>, 3> mean;
    std::array<Image<int8_t>, 3> rest;
    Image<uint8_t> count;
    Image<uint16_t> surface, depth, normal;

    void resize(int width, int height) {
        for (int c = 0; c < 3; ++c) {
            mean[size_t(c)].resize(width, height);
            rest[size_t(c)].resize(width, height);
        }
        count.resize(width, height);
        surface.resize(width, height);
        depth.resize(width, height);
        normal.resize(width, height);
    }

    HistoryOut pointers() {
        HistoryOut p;
        for (size_t c = 0; c < 3; ++c) {
            p.mean[c] = mean[c].view().data;
            p.rest[c] = rest[c].view().data;
        }
        p.count = count.view().data;
        p.surface = surface.view().data;
        p.depth = depth.view().data;
        p.normal = normal.view().data;
        return p;
    }
};

HistoryIn readOnly(const HistoryOut& p) {
    HistoryIn in;
    for (size_t c = 0; c < 3; ++c) {
        in.mean[c] = p.mean[c];
        in.rest[c] = p.rest[c];
    }
    in.count = p.count;
    in.surface = p.surface;
    in.depth = p.depth;
    in.normal = p.normal;
    return in;
}

/// What is remembered of a tile between frames.
struct TileMemory {
    bool finished = false;  ///< every pixel had the cap's number of samples
    bool changed = true;    ///< the last frame added samples
    bool twin = false;      ///< both buffers hold the same tile
};

constexpr int kSurfaceWords = (int(kSurfaceMask) + 1) / 64;
using SurfaceBits = std::array<uint64_t, size_t(kSurfaceWords)>;

/// Marks the surfaces of one tile that are seen without the moved bit.
void markResting(const GBuffer& gbuffer, const TileRect& rect, SurfaceBits& bits) {
    const ImageView<const uint16_t> id = gbuffer.id.view();
    uint16_t last = kMovedBit;
    for (int y = rect.y0; y < rect.y1; ++y) {
        const uint16_t* row = id.row(y);
        for (int x = rect.x0; x < rect.x1; ++x) {
            if (row[x] != last && (row[x] & kMovedBit) == 0) {
                bits[row[x] >> 6] |= uint64_t{1} << (row[x] & 63);
            }
            last = row[x];
        }
    }
}

}  // namespace

struct Taa::State {
    std::array<HistoryPlanes, 2> history;
    int shown = 0;  ///< index of the planes written last
    int width = 0, height = 0;
    int tiles_x = 0;
    std::vector<TileMemory> tiles;
    std::vector<TileWork> work;
    std::vector<SurfaceBits> resting;  ///< per worker; [0] becomes the union
    int sample_cap = 0;
    bool has_history = false;

    TileRect rectOf(int tile) const {
        const int x0 = tile % tiles_x * kTileSize, y0 = tile / tiles_x * kTileSize;
        return {x0, y0, std::min(x0 + kTileSize, width), std::min(y0 + kTileSize, height)};
    }

    void resize(const GBuffer& gbuffer) {
        if (width == gbuffer.width() && height == gbuffer.height()) {
            return;
        }
        width = gbuffer.width();
        height = gbuffer.height();
        tiles_x = gbuffer.tiles_x;
        history[0].resize(width, height);
        history[1].resize(width, height);
        has_history = false;
    }

    bool disturbed(const GBuffer& gbuffer, int tile) const;
    void chooseWork(const GBuffer& gbuffer, const TaaFrame& frame, int cap);
    const uint64_t* findResting(const GBuffer& gbuffer, Workers& workers);
    ResolveJob makeJob(const GBuffer& gbuffer, const TaaFrame& frame, int cap);
};

/// Something moved in the tile or in one of its neighbours, whose pixels reach into its windows.
bool Taa::State::disturbed(const GBuffer& gbuffer, int tile) const {
    const int tx = tile % tiles_x, ty = tile / tiles_x;
    bool moved = false;
    for (int y = std::max(ty - 1, 0); y <= std::min(ty + 1, gbuffer.tiles_y - 1); ++y) {
        for (int x = std::max(tx - 1, 0); x <= std::min(tx + 1, tiles_x - 1); ++x) {
            moved |= !gbuffer.tiles[size_t(y * tiles_x + x)].still();
        }
    }
    return moved;
}

void Taa::State::chooseWork(const GBuffer& gbuffer, const TaaFrame& frame, int cap) {
    work.assign(gbuffer.tiles.size(), TileWork::general);
    tiles.resize(gbuffer.tiles.size());
    for (size_t i = 0; i < work.size(); ++i) {
        if (!has_history) {
            work[i] = TileWork::fresh;
        } else if (!frame.shading_changed && !disturbed(gbuffer, int(i))) {
            const bool idle = tiles[i].finished && tiles[i].twin && cap == sample_cap;
            work[i] = idle ? TileWork::idle : TileWork::still;
        }
    }
}

/// Surfaces that stand still, seen anywhere in the picture. A stored surface that is not seen any
/// more may have moved, so only what is seen counts. Null when nothing moves at all.
const uint64_t* Taa::State::findResting(const GBuffer& gbuffer, Workers& workers) {
    if (std::none_of(gbuffer.tiles.begin(), gbuffer.tiles.end(),
                     [](const TileFacts& facts) { return facts.moved; })) {
        return nullptr;
    }
    resting.assign(size_t(workers.threads()), SurfaceBits{});
    workers.parallelFor(int(gbuffer.tiles.size()), 1, [&](int begin, int end, int worker) {
        for (int tile = begin; tile < end; ++tile) {
            markResting(gbuffer, rectOf(tile), resting[size_t(worker)]);
        }
    });
    for (size_t w = 1; w < resting.size(); ++w) {
        for (size_t i = 0; i < resting[0].size(); ++i) {
            resting[0][i] |= resting[w][i];
        }
    }
    return resting[0].data();
}

ResolveJob Taa::State::makeJob(const GBuffer& gbuffer, const TaaFrame& frame, int cap) {
    ResolveJob job;
    job.width = width;
    job.height = height;
    job.stride = gbuffer.red.view().stride;
    job.now.colour[0] = gbuffer.red.view().data;
    job.now.colour[1] = gbuffer.green.view().data;
    job.now.colour[2] = gbuffer.blue.view().data;
    job.now.depth = gbuffer.depth.view().data;
    job.now.id = gbuffer.id.view().data;
    job.now.normal = gbuffer.planes.normal ? gbuffer.normal.view().data : nullptr;
    job.now.motion = gbuffer.motion.view().data;
    job.now.depth_before = gbuffer.depth_before.view().data;
    job.before = readOnly(history[size_t(shown)].pointers());
    job.next = history[size_t(1 - shown)].pointers();
    job.sample_cap = cap;
    job.camera_moved = !gbuffer.tiles.empty() && gbuffer.tiles[0].camera_moved;
    job.shading_changed = frame.shading_changed;
    return job;
}

Taa::Taa() : state_(std::make_unique<State>()) {}
Taa::~Taa() = default;

void Taa::resolve(const GBuffer& gbuffer, const TaaFrame& frame, const TaaSettings& settings,
                  Workers& workers) {
    assert(gbuffer.planes.motion);
    assert(settings.sample_cap >= 1 && settings.sample_cap <= 255);
    State& s = *state_;
    s.resize(gbuffer);
    s.has_history = s.has_history && !frame.reset;
    s.chooseWork(gbuffer, frame, settings.sample_cap);
    ResolveJob job = s.makeJob(gbuffer, frame, settings.sample_cap);
    job.at_rest = s.has_history ? s.findResting(gbuffer, workers) : nullptr;
    const taa::TileKernel kernel = taa::tileKernel(settings.simd);
    workers.parallelFor(int(s.work.size()), 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) {
            TileMemory& memory = s.tiles[size_t(tile)];
            if (s.work[size_t(tile)] == TileWork::idle) {
                continue;
            }
            const TileResult result = kernel(job, s.rectOf(tile), s.work[size_t(tile)]);
            memory = {result.finished, result.changed,
                      s.work[size_t(tile)] == TileWork::still && !result.changed};
        }
    });
    s.shown = 1 - s.shown;
    s.has_history = true;
    s.sample_cap = settings.sample_cap;
}

ColourPlanes Taa::colour() const {
    const HistoryPlanes& h = state_->history[size_t(state_->shown)];
    return {h.mean[0].view(), h.mean[1].view(), h.mean[2].view()};
}

ImageView<const uint8_t> Taa::sampleCount() const {
    return state_->history[size_t(state_->shown)].count.view();
}

bool Taa::converged() const {
    return state_->has_history &&
           std::all_of(state_->tiles.begin(), state_->tiles.end(),
                       [](const TileMemory& t) { return t.finished && !t.changed; });
}

}  // namespace still
