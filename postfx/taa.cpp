// One frame: note what changed → every tile: keep its samples, sum what stands still → every tile
// that is not settled: gather.

#include "postfx/taa.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <vector>

#include "postfx/internal/evidence.h"
#include "postfx/internal/gather_story.h"
#include "postfx/internal/kernels.h"
#include "postfx/internal/memory.h"
#include "postfx/internal/rules.h"
#include "postfx/internal/started.h"
#include "postfx/limits.h"
#include "postfx/spatial.h"

namespace still {
namespace {

using taa::Job;
using taa::SlotOut;
using taa::SlotPlanes;
using taa::Stillness;
using taa::TileJitter;
using taa::TileMemory;
using taa::TileRect;

}  // namespace

struct Taa::State {
    std::vector<SlotPlanes> ring;
    int cursor = 0;       ///< index of this frame's slot
    int frames = 0;       ///< slots that belong to the present run of frames
    Image<int16_t> hint;  ///< Job::hint
    std::array<Image<uint16_t>, 3> mean, shown;
    std::array<Image<int8_t>, 3> rest;
    Image<uint8_t> count, shown_count;
    int width = 0, height = 0;
    int tiles_x = 0;
    int sample_cap = 0;
    std::vector<TileMemory> tiles;
    std::vector<uint8_t> wanted;   ///< plan()
    std::vector<uint8_t> changed;  ///< changedTiles()
    taa::SurfaceChanges surfaces;
    ImageView<const uint8_t> light_age;  ///< of the last resolve, where it matters
    taa::StartedSurfaces started;
    bool first = true;         ///< no frame was resolved since the last reset
    bool shows_first = false;  ///< the image is a first frame's
    bool gathered = false;     ///< this frame's was gathered in tiles that are not settled
    TaaSettings settings;      ///< of the last resolve …
    TileJitter jitter;         ///< … and where its samples lay
    SpatialFilter spatial;

    TileRect rectOf(int tile) const { return taa::tileRect(tile, width, height); }

    size_t tileCount() const {
        return size_t(tiles_x) * size_t((height + kTileSize - 1) / kTileSize);
    }

    void begin(int new_width, int new_height, bool reset, const TaaSettings& settings);
    bool finished(int cap) const;
    Job makeJob(const GBuffer& gbuffer, const TaaSettings& settings);
    PixelSource sourceAt(int x, int y) const;
    template <class Tell>
    void tellPicture(Workers& workers, Tell&& tell) const;
    void showFirst(const GBuffer& gbuffer, const TaaFrame& frame, SimdTarget simd,
                   Workers& workers);
    void forgetStarted(Workers& workers);
    void advanceRing(const TaaFrame& frame, bool shading_changed, Workers& workers);
    void keepAndSum(const Job& job, const taa::TileKernels& kernels, int tile);
};

/// Makes the planes fit; a changed size, a changed ring and a reset leave nothing of the past. Done
/// twice for a frame it changes nothing more.
void Taa::State::begin(int new_width, int new_height, bool reset, const TaaSettings& settings) {
    const bool resized = width != new_width || height != new_height;
    if (resized || reset || ring.size() != size_t(settings.ring)) {
        frames = 0;
        first = true;
        surfaces.forget(settings.ring);
    }
    if (resized || ring.size() != size_t(settings.ring)) {
        width = new_width;
        height = new_height;
        tiles_x = (width + kTileSize - 1) / kTileSize;
        cursor = 0;
        ring.resize(size_t(settings.ring));
        for (SlotPlanes& slot : ring) {
            slot.resize(width, height);
            slot.tile_jitter.assign(tileCount(), {});
        }
        hint.resize(width, height);
        for (size_t c = 0; c < 3; ++c) {
            mean[c].resize(width, height);
            rest[c].resize(width, height);
            shown[c].resize(width, height);
        }
        count.resize(width, height);
        shown_count.resize(width, height);
    }
    // Complete sums may have too much, and settled ones may not be so any more.
    if (first || settings.sample_cap < sample_cap ||
        std::min(taa::kSettled, settings.sample_cap) != std::min(taa::kSettled, sample_cap)) {
        tiles.assign(tileCount(), TileMemory{});
    }
}

/// Without motion or change the picture stays.
bool Taa::State::finished(int cap) const {
    return !first && cap == sample_cap && taa::allFinished(tiles);
}

Job Taa::State::makeJob(const GBuffer& gbuffer, const TaaSettings& settings) {
    Job job;
    job.width = width;
    job.height = height;
    job.tiles_x = tiles_x;
    job.stride = gbuffer.red.view().stride;
    job.now = taa::currentOf(gbuffer);
    job.frames = frames;
    for (int k = 0; k < frames; ++k) {
        const int slot = (cursor + settings.ring - k) % settings.ring;
        job.slot[k] = ring[size_t(slot)].pointers<taa::SlotIn>();
    }
    job.record = ring[size_t(cursor)].pointers<SlotOut>();
    job.hint = hint.view().data;
    for (size_t c = 0; c < 3; ++c) {
        job.sums.mean[c] = mean[c].view().data;
        job.sums.rest[c] = rest[c].view().data;
        job.shown[c] = shown[c].view().data;
    }
    job.sums.count = count.view().data;
    job.shown_count = shown_count.view().data;
    job.change_age = surfaces.ages(settings.ring);
    job.start_age = started.ages();
    job.turning = surfaces.turning();
    job.light_age = light_age.data;
    job.sample_cap = settings.sample_cap;
    job.settled = std::min(taa::kSettled, settings.sample_cap);
    job.camera_moved = !gbuffer.tiles.empty() && gbuffer.tiles[0].camera_moved;
    return job;
}

/// Before this frame is kept: the cursor's slot still holds the last one.
void Taa::State::forgetStarted(Workers& workers) {
    if (!started.any()) {
        return;
    }
    const Image<int16_t>& last = ring[size_t(cursor)].planes[SlotPlanes::id];
    workers.parallelFor(int(tiles.size()), 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) {
            if (tiles[size_t(tile)].summed && tiles[size_t(tile)].tested) {
                taa::forgetStarted(started, last.view(), rectOf(tile), count.view());
            }
        }
    });
}

/// The cursor's slot becomes this frame's, and what is counted in kept frames goes on.
void Taa::State::advanceRing(const TaaFrame& frame, bool shading_changed, Workers& workers) {
    const int slots = int(ring.size());
    surfaces.note(frame, shading_changed, slots);
    forgetStarted(workers);
    started.countAges(first, slots);
    cursor = (cursor + 1) % slots;
    frames = std::min(frames + 1, slots);
    taa::noteJitter(ring[size_t(cursor)], frame, tiles);
}

void Taa::State::keepAndSum(const Job& job, const taa::TileKernels& kernels, int tile) {
    TileMemory& memory = tiles[size_t(tile)];
    memory.adds = false;
    if (memory.keeps) {
        kernels.record(job, rectOf(tile));
        memory.quiet = std::min(memory.quiet + 1, int(ring.size()));
    }
    if (job.camera_moved && !first) {
        memory.summed = memory.finished = memory.settled = false;
        memory.changed = true;
        memory.quiet = 0;
        return;
    }
    if (!memory.tested && memory.summed && memory.finished && job.sample_cap == sample_cap) {
        memory.changed = false;
        return;
    }
    const taa::SumsResult result = kernels.accumulate(
        job, rectOf(tile), memory.tested ? Stillness::tested : Stillness::all, !memory.summed);
    memory.summed = memory.adds = true;
    memory.finished = result.finished;
    memory.settled = result.settled;
    memory.changed = result.changed || !result.settled;
}

/// Without a past there is only this frame, filtered in space.
void Taa::State::showFirst(const GBuffer& gbuffer, const TaaFrame& frame, SimdTarget simd,
                           Workers& workers) {
    spatial.run(spatialInput(gbuffer, frame.jitter_x_fx8, frame.jitter_y_fx8), {.simd = simd},
                {shown[0].view(), shown[1].view(), shown[2].view()}, workers);
    for (int y = 0; y < height; ++y) {
        std::memset(shown_count.view().row(y), 1, size_t(width));
    }
}

Taa::Taa() : state_(std::make_unique<State>()) {}
Taa::~Taa() = default;
Taa::Taa(Taa&&) noexcept = default;
Taa& Taa::operator=(Taa&&) noexcept = default;

void Taa::reserve(int width, int height, const TaaSettings& settings) {
    static_assert(sizeof(State) <= taa::kStateBytes);
    static_assert(sizeof(SlotPlanes) <= taa::kSlotBytes);
    static_assert(sizeof(TileJitter) == taa::kTileJitterBytes);
    static_assert(sizeof(TileMemory) == taa::kTileMemoryBytes);
    State& s = *state_;
    s.begin(width, height, true, settings);
    s.wanted.reserve(s.tileCount());
    s.changed.reserve(s.tileCount());
    s.surfaces.reserve();
    s.started.reserve();
    s.spatial.reserve(width, height);
}

bool Taa::rest(const TaaSettings& settings) {
    State& s = *state_;
    if (int(s.ring.size()) != settings.ring || !s.finished(settings.sample_cap)) {
        return false;
    }
    s.started.noteRest();
    taa::restTiles(s.tiles);
    s.gathered = false;
    return true;
}

std::span<const uint8_t> Taa::plan(int width, int height, std::span<const TileFacts> facts,
                                   const TaaFrame& frame, const TaaSettings& settings) {
    State& s = *state_;
    s.begin(width, height, frame.reset, settings);
    assert(facts.size() == s.tiles.size());
    taa::planTiles(s.tiles, facts, s.first, !s.first && taa::changesShading(frame), frame.repeats,
                   settings.ring);
    const bool same_cap = settings.sample_cap == s.sample_cap;
    s.wanted.resize(s.tiles.size());
    std::transform(s.tiles.begin(), s.tiles.end(), s.wanted.begin(), [&](const TileMemory& tile) {
        return uint8_t(tile.keeps || !tile.summed || !tile.finished || !same_cap ? 1 : 0);
    });
    return s.wanted;
}

void Taa::resolve(const GBuffer& gbuffer, const TaaFrame& frame, const TaaSettings& settings,
                  Workers& workers) {
    assert(gbuffer.planes.motion);
    assert(settings.sample_cap >= 1 && settings.sample_cap <= 255);
    assert(settings.ring >= 1 && settings.ring <= kMaxRing);
    State& s = *state_;
    s.begin(gbuffer.width(), gbuffer.height(), frame.reset, settings);
    const bool shading_changed = !s.first && taa::changesShading(frame);
    const int past = std::max(settings.sample_cap, settings.ring);
    const bool young = !s.first && taa::noteLightAge(s.tiles, frame.light_age, past, workers);
    if (!s.first && !shading_changed && !young && taa::allStill(gbuffer) && rest(settings)) {
        return;
    }
    s.started.note(gbuffer, s.first, workers);
    const bool first = s.first;
    if (taa::planTiles(s.tiles, gbuffer.tiles, first, shading_changed, frame.repeats,
                       settings.ring)) {
        s.advanceRing(frame, shading_changed, workers);
    } else if (first) {
        s.started.countAges(first, settings.ring);
    }
    s.light_age = young ? frame.light_age : ImageView<const uint8_t>{};
    const Job job = s.makeJob(gbuffer, settings);
    const taa::TileKernels kernels = taa::tileKernels(settings.simd);
    workers.parallelFor(int(s.tiles.size()), 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) {
            s.keepAndSum(job, kernels, tile);
        }
    });
    s.changed.resize(s.tiles.size());
    for (size_t i = 0; i < s.tiles.size(); ++i) {
        s.changed[i] |= s.tiles[i].changed ? 1 : 0;
    }
    s.sample_cap = settings.sample_cap;
    s.first = false;
    s.settings = settings;
    s.jitter = {int16_t(frame.jitter_x_fx8), int16_t(frame.jitter_y_fx8)};
    s.shows_first = first;
    s.gathered = frame.looked_at;
    if (!frame.looked_at) {
        return;
    }
    if (first) {
        s.showFirst(gbuffer, frame, settings.simd, workers);
        return;
    }
    workers.parallelFor(int(s.tiles.size()), 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) {
            if (!s.tiles[size_t(tile)].settled) {
                kernels.gather(job, s.rectOf(tile), s.tiles[size_t(tile)].summed);
            }
        }
    });
}

std::span<const uint8_t> Taa::changedTiles() const {
    return state_->changed;
}

void Taa::forgetChanges() {
    std::fill(state_->changed.begin(), state_->changed.end(), uint8_t{0});
}

ColourPlanes Taa::colour() const {
    const auto& shown = state_->shown;
    return {shown[0].view(), shown[1].view(), shown[2].view()};
}

ImageView<const uint8_t> Taa::sampleCount() const {
    return state_->shown_count.view();
}

std::vector<TileWork> Taa::tileWork() const {
    const State& s = *state_;
    std::vector<TileWork> work;
    for (const TileMemory& tile : s.tiles) {
        work.push_back({.drawn = tile.keeps || tile.adds,
                        .recorded = tile.keeps,
                        .summed = tile.adds,
                        .resolved = s.gathered && (s.shows_first || !tile.settled),
                        .finished = tile.summed && tile.finished});
    }
    return work;
}

/// What the image shows there.
PixelSource Taa::State::sourceAt(int x, int y) const {
    if (shows_first) {
        return PixelSource::first;
    }
    const TileMemory& tile = tiles[size_t(y / kTileSize * tiles_x + x / kTileSize)];
    const bool mean = tile.summed && count.at(x, y) >= std::min(taa::kSettled, sample_cap);
    return mean ? PixelSource::mean : PixelSource::gathered;
}

// The gather writes nothing but the image, so what it read is still there.
PixelStory Taa::story(const GBuffer& gbuffer, int x, int y) const {
    State& s = *state_;
    PixelStory story = taa::tellPixel(s.makeJob(gbuffer, s.settings), s.sourceAt(x, y), x, y);
    story.jitter_x_fx8 = s.jitter.x_fx8;
    story.jitter_y_fx8 = s.jitter.y_fx8;
    return story;
}

/// Calls tell(x, y) for all pixels.
template <class Tell>
void Taa::State::tellPicture(Workers& workers, Tell&& tell) const {
    constexpr int kRows = 4;
    workers.parallelFor(height, kRows, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < width; ++x) {
                tell(x, y);
            }
        }
    });
}

void Taa::storyPlane(const GBuffer& gbuffer, StoryPlane plane, ColourTargets out,
                     Workers& workers) const {
    State& s = *state_;
    const Job job = s.makeJob(gbuffer, s.settings);
    s.tellPicture(workers, [&](int x, int y) {
        const StoryColour colour = taa::tellColour(job, plane, s.sourceAt(x, y), x, y);
        out.red.row(y)[x] = uint16_t(colour[0]);
        out.green.row(y)[x] = uint16_t(colour[1]);
        out.blue.row(y)[x] = uint16_t(colour[2]);
    });
}

void Taa::rejections(const GBuffer& gbuffer, const RejectionTargets& out, Workers& workers) const {
    State& s = *state_;
    const Job job = s.makeJob(gbuffer, s.settings);
    s.tellPicture(workers, [&](int x, int y) {
        const StoryLoss loss = taa::tellLoss(job, s.sourceAt(x, y), x, y);
        out.reason.row(y)[x] = loss.reason;
        out.lost.row(y)[x] = uint8_t(loss.lost);
    });
}

bool Taa::converged() const {
    return !state_->first && taa::allConverged(state_->tiles);
}

}  // namespace still
