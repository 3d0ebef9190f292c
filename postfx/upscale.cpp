// One frame: note what changed → every tile of the frame: keep its samples, sum what stands still →
// every tile whose output pixels the sums do not show: gather.

#include "postfx/upscale.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "postfx/internal/upscale_gather.h"
#include "postfx/internal/upscale_state.h"
#include "postfx/internal/upscale_sums.h"

namespace still {
namespace {

using taa::Stillness;
using taa::TileMemory;
using taa::TileRect;
using upscale::Axis;
using upscale::Job;
using upscale::tilesAcross;

}  // namespace

void TemporalUpscaler::State::keepAndSum(const Job& job, const taa::TileKernels& kernels,
                                         int tile) {
    TileMemory& memory = tiles[size_t(tile)];
    memory.adds = false;
    if (memory.keeps) {
        kernels.record(job.frame, rectOf(tile));
        memory.quiet = std::min(memory.quiet + 1, int(ring.size()));
    }
    if (job.frame.camera_moved && !first) {
        memory.summed = memory.finished = memory.settled = false;
        memory.changed = true;
        memory.quiet = 0;
        return;
    }
    if (!memory.tested && memory.summed && memory.finished && job.sample_cap == sample_cap) {
        memory.changed = false;
        return;
    }
    const taa::SumsResult result = upscale::accumulateTile(
        job, rectOf(tile), memory.tested ? Stillness::tested : Stillness::all, !memory.summed);
    memory.summed = memory.adds = true;
    memory.finished = result.finished;
    memory.settled = result.settled;
    memory.changed = result.changed || !result.settled;
}

/// Tiles of the image that the frame's changed tiles reach.
void TemporalUpscaler::State::noteChanged(const Job& job) {
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (!tiles[i].changed) {
            continue;
        }
        const TileRect out = upscale::outputRect(job, rectOf(int(i)));
        for (int y = out.y0 / kTileSize; y <= (out.y1 - 1) / kTileSize; ++y) {
            for (int x = out.x0 / kTileSize; x <= (out.x1 - 1) / kTileSize; ++x) {
                changed[size_t(y * tilesAcross(width) + x)] = 1;
            }
        }
    }
}

/// Without a past there is only this frame, filtered in space and enlarged.
void TemporalUpscaler::State::showFirst(const GBuffer& gbuffer, const TaaFrame& frame,
                                        SimdTarget simd, Workers& workers) {
    for (Image<uint16_t>& plane : filtered) {
        plane.resize(frame_width, frame_height);
    }
    spatial.run(spatialInput(gbuffer, frame.jitter_x_fx8, frame.jitter_y_fx8), {.simd = simd},
                {filtered[0].view(), filtered[1].view(), filtered[2].view()}, workers);
    enlarger.run({filtered[0].view(), filtered[1].view(), filtered[2].view()}, EnlargeFilter::edge,
                 {shown[0].view(), shown[1].view(), shown[2].view()}, simd, workers);
    for (int y = 0; y < height; ++y) {
        std::memset(shown_count.view().row(y), 1, size_t(width));
    }
}

TemporalUpscaler::TemporalUpscaler() : state_(std::make_unique<State>()) {}
TemporalUpscaler::~TemporalUpscaler() = default;
TemporalUpscaler::TemporalUpscaler(TemporalUpscaler&&) noexcept = default;
TemporalUpscaler& TemporalUpscaler::operator=(TemporalUpscaler&&) noexcept = default;

bool TemporalUpscaler::rest(int frame_width, int frame_height, const UpscaleSettings& settings) {
    State& s = *state_;
    if (s.width != settings.width || s.height != settings.height || s.frame_width != frame_width ||
        s.frame_height != frame_height || int(s.ring.size()) != settings.ring ||
        !s.finished(settings.sample_cap)) {
        return false;
    }
    s.started.noteRest();
    taa::restTiles(s.tiles);
    return true;
}

std::span<const uint8_t> TemporalUpscaler::plan(int frame_width, int frame_height,
                                                std::span<const TileFacts> facts,
                                                const TaaFrame& frame,
                                                const UpscaleSettings& settings) {
    State& s = *state_;
    s.begin(frame_width, frame_height, frame.reset, settings);
    assert(facts.size() == s.tiles.size());
    taa::planTiles(s.tiles, facts, s.first, !s.first && taa::changesShading(frame), frame.repeats,
                   settings.ring);
    s.planDrawing(settings.sample_cap == s.sample_cap);
    return s.wanted;
}

void TemporalUpscaler::resolve(const GBuffer& gbuffer, const TaaFrame& frame,
                               const UpscaleSettings& settings, Workers& workers) {
    assert(gbuffer.planes.motion);
    assert(settings.ring >= 1 && settings.ring <= kMaxRing);
    assert(settings.width >= gbuffer.width() && settings.height >= gbuffer.height());
    State& s = *state_;
    s.begin(gbuffer.width(), gbuffer.height(), frame.reset, settings);
    const bool shading_changed = !s.first && taa::changesShading(frame);
    const int past = std::max(settings.sample_cap, settings.ring);
    const bool young = !s.first && taa::noteLightAge(s.tiles, frame.light_age, past, workers);
    if (!shading_changed && !young && taa::allStill(gbuffer) &&
        rest(gbuffer.width(), gbuffer.height(), settings)) {
        return;
    }
    s.light_age = young ? frame.light_age : ImageView<const uint8_t>{};
    s.started.note(gbuffer, s.first, workers);
    const bool first = s.first;
    if (taa::planTiles(s.tiles, gbuffer.tiles, first, shading_changed, frame.repeats,
                       settings.ring)) {
        s.advanceRing(frame, shading_changed);
    }
    Job job = s.makeJob(gbuffer, settings);
    // Sums need it whether the frame is kept or not.
    job.frame.record.jitter_x_fx8 = frame.jitter_x_fx8;
    job.frame.record.jitter_y_fx8 = frame.jitter_y_fx8;
    const taa::TileKernels kernels = taa::tileKernels(settings.simd);
    const auto forTiles = [&](auto&& visit) {
        workers.parallelFor(int(s.tiles.size()), 1, [&](int begin, int end, int) {
            for (int tile = begin; tile < end; ++tile) {
                visit(tile);
            }
        });
    };
    forTiles([&](int tile) { s.keepAndSum(job, kernels, tile); });
    s.noteChanged(job);
    s.sample_cap = settings.sample_cap;
    s.first = false;
    if (!frame.looked_at) {
        return;
    }
    if (first) {
        s.showFirst(gbuffer, frame, settings.simd, workers);
        return;
    }
    const upscale::GatherKernel gather = job.frame.frames == job.frames
                                             ? taa::upscaleKernel(settings.simd)
                                             : upscale::gatherTileReference;
    forTiles([&](int tile) {
        const TileMemory& memory = s.tiles[size_t(tile)];
        if (!memory.settled) {
            gather(job, s.rectOf(tile), memory.summed);
        }
    });
}

std::span<const uint8_t> TemporalUpscaler::changedTiles() const {
    return state_->changed;
}

void TemporalUpscaler::forgetChanges() {
    std::fill(state_->changed.begin(), state_->changed.end(), uint8_t{0});
}

ColourPlanes TemporalUpscaler::colour() const {
    const auto& shown = state_->shown;
    return {shown[0].view(), shown[1].view(), shown[2].view()};
}

ImageView<const uint8_t> TemporalUpscaler::sampleCount() const {
    return state_->shown_count.view();
}

bool TemporalUpscaler::converged() const {
    return !state_->first && taa::allConverged(state_->tiles);
}

std::vector<TileWork> TemporalUpscaler::tileWork() const {
    const State& s = *state_;
    std::vector<TileWork> work;
    const Axis x_axis(s.frame_width, s.width), y_axis(s.frame_height, s.height);
    for (int y = 0; y < s.height; y += kTileSize) {
        for (int x = 0; x < s.width; x += kTileSize) {
            // Of the frame's tile that holds its middle.
            const int column = x_axis.pixelOf(std::min(x + kTileSize / 2, s.width - 1));
            const int row = y_axis.pixelOf(std::min(y + kTileSize / 2, s.height - 1));
            const TileMemory& tile =
                s.tiles[size_t(row / kTileSize * tilesAcross(s.frame_width) + column / kTileSize)];
            work.push_back({.drawn = tile.keeps || tile.adds,
                            .recorded = tile.keeps,
                            .summed = tile.adds,
                            .resolved = !tile.settled,
                            .finished = tile.summed && tile.finished});
        }
    }
    return work;
}

}  // namespace still
