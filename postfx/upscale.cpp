// One frame: note what changed → every tile of the frame: keep its samples, sum what stands still →
// every tile whose output pixels the sums do not show: gather.

#include "postfx/upscale.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <utility>

#include "postfx/internal/kernels.h"
#include "postfx/internal/memory.h"
#include "postfx/internal/started.h"
#include "postfx/internal/upscale_gather.h"
#include "postfx/internal/upscale_rules.h"
#include "postfx/internal/upscale_sums.h"
#include "postfx/spatial.h"
#include "postfx/spatial_upscale.h"

namespace still {
namespace {

using taa::SlotPlanes;
using taa::Stillness;
using taa::TileJitter;
using taa::TileMemory;
using taa::TileRect;
using upscale::Axis;
using upscale::Job;

constexpr size_t kSurfaces = size_t(kSurfaceMask) + 1;
constexpr uint32_t kLongAgo = 255;

bool anyOf(std::span<const uint64_t> surfaces) {
    return std::any_of(surfaces.begin(), surfaces.end(), [](uint64_t word) { return word != 0; });
}

bool changesShading(const TaaFrame& frame) {
    return frame.shading_changed || anyOf(frame.changed_surfaces);
}

bool allStill(const GBuffer& gbuffer) {
    return std::all_of(gbuffer.tiles.begin(), gbuffer.tiles.end(),
                       [](const TileFacts& facts) { return facts.still(); });
}

int tilesAcross(int pixels) {
    return (pixels + kTileSize - 1) / kTileSize;
}

/// A frame as it was kept, of the size that frames had then.
struct KeptFrame {
    SlotPlanes planes;
    Axis x, y;

    upscale::Slot slot() {
        return {.in = planes.pointers<taa::SlotIn>(),
                .x = x,
                .y = y,
                .stride = planes.planes[0].view().stride};
    }
};

}  // namespace

struct TemporalUpscaler::State {
    std::vector<KeptFrame> ring;
    int cursor = 0;       ///< index of this frame's
    int frames = 0;       ///< kept ones that belong to the present run of frames
    Image<int16_t> hint;  ///< taa::Job::hint
    std::array<Image<uint32_t>, 3> sums;
    Image<uint16_t> sum_count, sum_frames;
    std::array<Image<uint16_t>, 3> shown;
    Image<uint8_t> shown_count;
    int width = 0, height = 0;              ///< of the image …
    int frame_width = 0, frame_height = 0;  ///< … and of the frame
    int sample_cap = 0;
    std::vector<TileMemory> tiles;     ///< of the frame
    std::vector<uint8_t> wanted;       ///< plan()
    std::vector<uint8_t> changed;      ///< changedTiles()
    std::vector<uint32_t> change_age;  ///< empty until something changes
    std::vector<uint32_t> turning;     ///< taa::Job::turning; empty: null
    ImageView<const uint8_t> light_age;
    int since_change = 0;  ///< frames since any surface changed; counts to the ring's length
    taa::StartedSurfaces started;
    bool first = true;  ///< no frame was resolved since the last reset
    SpatialFilter spatial;
    SpatialUpscaler enlarger;
    std::array<Image<uint16_t>, 3> filtered;  ///< a first frame

    TileRect rectOf(int tile) const {
        const int across = tilesAcross(frame_width);
        const int x0 = tile % across * kTileSize, y0 = tile / across * kTileSize;
        return {x0, y0, std::min(x0 + kTileSize, frame_width),
                std::min(y0 + kTileSize, frame_height)};
    }
    size_t tileCount() const {
        return size_t(tilesAcross(frame_width)) * size_t(tilesAcross(frame_height));
    }

    void begin(int new_width, int new_height, bool reset, const UpscaleSettings& settings);
    void resizeImage(const UpscaleSettings& settings);
    void noteChanges(const TaaFrame& frame, bool now);
    void noteTurning(std::span<const uint64_t> surfaces);
    bool noteLightAge(ImageView<const uint8_t> age, int past);
    bool planTiles(std::span<const TileFacts> facts, bool shading_changed, int repeats);
    void planDrawing(bool same_cap);
    bool finished(int cap) const;
    void advanceRing(const TaaFrame& frame, bool shading_changed);
    void forgetStarted();
    void noteJitter(SlotPlanes& slot);
    Job makeJob(const GBuffer& gbuffer, const UpscaleSettings& settings);
    void keepAndSum(const Job& job, const taa::TileKernels& kernels, int tile);
    void noteChanged(const Job& job);
    void showFirst(const GBuffer& gbuffer, const TaaFrame& frame, SimdTarget simd,
                   Workers& workers);
};

void TemporalUpscaler::State::resizeImage(const UpscaleSettings& settings) {
    width = settings.width;
    height = settings.height;
    cursor = 0;
    ring.clear();
    ring.resize(size_t(settings.ring));
    for (size_t c = 0; c < 3; ++c) {
        sums[c].resize(width, height);
        shown[c].resize(width, height);
    }
    sum_count.resize(width, height);
    sum_frames.resize(width, height);
    shown_count.resize(width, height);
    changed.assign(size_t(tilesAcross(width)) * size_t(tilesAcross(height)), 1);
}

/// Makes the planes fit; a changed image, a changed ring and a reset leave nothing of the past.
/// Done twice for a frame it changes nothing more.
void TemporalUpscaler::State::begin(int new_width, int new_height, bool reset,
                                    const UpscaleSettings& settings) {
    const bool resized = width != settings.width || height != settings.height ||
                         ring.size() != size_t(settings.ring);
    if (resized || reset) {
        frames = 0;
        first = true;
        since_change = settings.ring;
    }
    if (resized) {
        resizeImage(settings);
    }
    const bool other_size = frame_width != new_width || frame_height != new_height;
    if (other_size) {
        frame_width = new_width;
        frame_height = new_height;
        hint.resize(frame_width, frame_height);
    }
    // The offsets of all frames belong to one size; complete sums may have too much.
    if (first || other_size || settings.sample_cap < sample_cap) {
        tiles.assign(tileCount(), TileMemory{});
    }
}

/// Keeps for each surface how many kept frames ago its shading changed; `now`: some did.
void TemporalUpscaler::State::noteChanges(const TaaFrame& frame, bool now) {
    const int slots = int(ring.size());
    if (!now && since_change >= slots) {
        return;
    }
    if (change_age.empty() || since_change >= slots) {
        change_age.assign(kSurfaces, kLongAgo);
    }
    for (uint32_t& age : change_age) {
        age = age < kLongAgo - 1 ? age + 1 : kLongAgo;
    }
    if (frame.shading_changed) {
        std::fill(change_age.begin(), change_age.end(), 0u);
    }
    for (size_t i = 0; i < frame.changed_surfaces.size() * 64; ++i) {
        if (((frame.changed_surfaces[i / 64] >> (i % 64)) & 1) != 0) {
            change_age[i] = 0;
        }
    }
    since_change = now ? 0 : since_change + 1;
}

void TemporalUpscaler::State::noteTurning(std::span<const uint64_t> surfaces) {
    turning.clear();
    if (!anyOf(surfaces)) {
        return;
    }
    turning.resize(kSurfaces);
    for (size_t i = 0; i < std::min(surfaces.size() * 64, kSurfaces); ++i) {
        turning[i] = uint32_t((surfaces[i / 64] >> (i % 64)) & 1);
    }
}

/// Which tiles have pixels that were lit otherwise within the last `past` frames; whether any has.
bool TemporalUpscaler::State::noteLightAge(ImageView<const uint8_t> age, int past) {
    bool any = false;
    for (size_t i = 0; i < tiles.size(); ++i) {
        const TileRect rect = rectOf(int(i));
        uint8_t least = 255;
        for (int y = rect.y0; !age.empty() && y < rect.y1; ++y) {
            least = std::min(least, *std::min_element(age.row(y) + rect.x0, age.row(y) + rect.x1));
        }
        tiles[i].young = least < std::min(past, 255);
        any |= tiles[i].young;
    }
    return any;
}

/// Notes what each tile needs; whether any needs the ring: see Taa.
bool TemporalUpscaler::State::planTiles(std::span<const TileFacts> facts, bool shading_changed,
                                        int repeats) {
    const bool overwritten = repeats >= int(ring.size());
    bool any = false;
    for (size_t i = 0; i < tiles.size(); ++i) {
        TileMemory& tile = tiles[i];
        tile.tested = shading_changed || facts[i].moved || tile.young;
        tile.quiet = tile.tested ? 0 : tile.quiet;
        tile.keeps =
            first || facts[i].camera_moved || !tile.settled || tile.quiet < int(ring.size());
        tile.keeps &= !overwritten || tile.tested || facts[i].camera_moved;
        any |= tile.keeps;
    }
    return any;
}

/// Sums read a pixel beside their tiles.
void TemporalUpscaler::State::planDrawing(bool same_cap) {
    const int across = tilesAcross(frame_width), down = tilesAcross(frame_height);
    wanted.assign(tiles.size(), 0);
    for (int i = 0; i < int(tiles.size()); ++i) {
        const TileMemory& tile = tiles[size_t(i)];
        const bool sums = !tile.summed || !tile.finished || !same_cap || tile.tested;
        if (!sums) {
            wanted[size_t(i)] |= tile.keeps ? 1 : 0;
            continue;
        }
        const int x = i % across, y = i / across;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, down - 1); ++v) {
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, across - 1); ++u) {
                wanted[size_t(v * across + u)] = 1;
            }
        }
    }
}

/// Without motion or change the picture stays.
bool TemporalUpscaler::State::finished(int cap) const {
    return !first && cap == sample_cap &&
           std::all_of(tiles.begin(), tiles.end(),
                       [](const TileMemory& t) { return t.summed && t.finished; });
}

/// taa::forgetStarted(). Before this frame is kept: the cursor's is still the last one.
void TemporalUpscaler::State::forgetStarted() {
    const ImageView<const int16_t> last =
        std::as_const(ring[size_t(cursor)].planes.planes[SlotPlanes::id]).view();
    if (!started.any() || last.width != frame_width || last.height != frame_height) {
        return;
    }
    const Axis x_axis(frame_width, width), y_axis(frame_height, height);
    for (size_t i = 0; i < tiles.size(); ++i) {
        const TileRect tile = rectOf(int(i));
        for (int y = std::max(tile.y0 - 1, 0);
             tiles[i].summed && tiles[i].tested && y < std::min(tile.y1 + 1, frame_height); ++y) {
            for (int x = std::max(tile.x0 - 1, 0); x < std::min(tile.x1 + 1, frame_width); ++x) {
                if (!started.contains(last.at(x, y) & int(kSurfaceMask))) {
                    continue;
                }
                const int x0 = x_axis.firstOf(std::max(x - 1, tile.x0));
                const int x1 = x_axis.firstOf(std::min(x + 2, tile.x1));
                const int y1 = y_axis.firstOf(std::min(y + 2, tile.y1));
                for (int v = y_axis.firstOf(std::max(y - 1, tile.y0)); v < y1; ++v) {
                    std::fill(sum_frames.view().row(v) + x0, sum_frames.view().row(v) + x1, 0);
                    std::fill(sum_count.view().row(v) + x0, sum_count.view().row(v) + x1, 0);
                }
            }
        }
    }
}

/// Of the tiles that are kept; the others' samples lie where they lay.
void TemporalUpscaler::State::noteJitter(SlotPlanes& slot) {
    const TileJitter now{int16_t(slot.jitter_x_fx8), int16_t(slot.jitter_y_fx8)};
    slot.apart = false;
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i].keeps) {
            slot.tile_jitter[i] = now;
        }
        slot.apart |= !slot.tile_jitter[i].sameAs(now);
    }
}

/// The cursor's slot becomes this frame's, and what is counted in kept frames goes on.
void TemporalUpscaler::State::advanceRing(const TaaFrame& frame, bool shading_changed) {
    const int slots = int(ring.size());
    noteChanges(frame, shading_changed);
    noteTurning(frame.turning_surfaces);
    forgetStarted();
    started.countAges(first, slots);
    cursor = (cursor + 1) % slots;
    frames = std::min(frames + 1, slots);
    KeptFrame& kept = ring[size_t(cursor)];
    if (kept.x.frame != frame_width || kept.y.frame != frame_height) {
        kept.x = {frame_width, width};
        kept.y = {frame_height, height};
        kept.planes.resize(frame_width, frame_height);
        kept.planes.tile_jitter.assign(tileCount(), {});
    }
    kept.planes.jitter_x_fx8 = frame.jitter_x_fx8;
    kept.planes.jitter_y_fx8 = frame.jitter_y_fx8;
    noteJitter(kept.planes);
}

/// Samples with which a still pixel's mean is nearer to the truth than what is gathered: a few more
/// than the ring's frames bring. Measured at ratios of 1.5, 2 and 3: postfx/README.md.
static int settledCount(const UpscaleSettings& settings, const Job& job) {
    const int64_t frame_pixels = int64_t(job.x.frame) * job.y.frame;
    const int64_t image_pixels = int64_t(job.x.image) * job.y.image;
    return 1 + int(settings.ring * 5 * frame_pixels / (4 * image_pixels));
}

Job TemporalUpscaler::State::makeJob(const GBuffer& gbuffer, const UpscaleSettings& settings) {
    Job job;
    taa::Job& frame = job.frame;
    frame.width = frame_width;
    frame.height = frame_height;
    frame.tiles_x = tilesAcross(frame_width);
    frame.stride = gbuffer.red.view().stride;
    frame.now.colour[0] = gbuffer.red.view().data;
    frame.now.colour[1] = gbuffer.green.view().data;
    frame.now.colour[2] = gbuffer.blue.view().data;
    frame.now.depth = gbuffer.depth.view().data;
    frame.now.id = gbuffer.id.view().data;
    frame.now.normal = gbuffer.planes.normal ? gbuffer.normal.view().data : nullptr;
    frame.now.motion = gbuffer.motion.view().data;
    frame.now.depth_before = gbuffer.depth_before.view().data;
    job.frames = frames;
    for (int k = 0; k < frames; ++k) {
        const int slot = (cursor + settings.ring - k) % settings.ring;
        job.slot[k] = ring[size_t(slot)].slot();
    }
    // Those of the frame's size.
    while (frame.frames <= frames && job.slot[frame.frames - 1].x.frame == frame_width &&
           job.slot[frame.frames - 1].y.frame == frame_height) {
        frame.slot[frame.frames - 1] = job.slot[frame.frames - 1].in;
        ++frame.frames;
    }
    --frame.frames;
    frame.record = ring[size_t(cursor)].planes.pointers<taa::SlotOut>();
    frame.hint = hint.view().data;
    frame.change_age = since_change < settings.ring ? change_age.data() : nullptr;
    frame.start_age = started.ages();
    frame.turning = turning.empty() ? nullptr : turning.data();
    frame.light_age = light_age.data;
    frame.camera_moved = !gbuffer.tiles.empty() && gbuffer.tiles[0].camera_moved;
    frame.centre_tolerance = upscale::kCentreTolerance;
    job.x = {frame_width, width};
    job.y = {frame_height, height};
    job.stride = shown[0].view().stride;
    for (size_t c = 0; c < 3; ++c) {
        job.sums.colour[c] = sums[c].view().data;
        job.shown[c] = shown[c].view().data;
    }
    job.sums.count = sum_count.view().data;
    job.sums.frames = sum_frames.view().data;
    job.shown_count = shown_count.view().data;
    job.sample_cap = settings.sample_cap;
    job.sum_kernels = upscale::sumKernels(settings.simd);
    job.settled = std::min(settledCount(settings, job), settings.sample_cap);
    return job;
}

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

bool TemporalUpscaler::rest(int frame_width, int frame_height, const UpscaleSettings& settings) {
    State& s = *state_;
    if (s.width != settings.width || s.height != settings.height || s.frame_width != frame_width ||
        s.frame_height != frame_height || int(s.ring.size()) != settings.ring ||
        !s.finished(settings.sample_cap)) {
        return false;
    }
    s.started.noteRest();
    for (TileMemory& tile : s.tiles) {
        tile.changed = tile.keeps = tile.adds = false;
    }
    return true;
}

std::span<const uint8_t> TemporalUpscaler::plan(int frame_width, int frame_height,
                                                std::span<const TileFacts> facts,
                                                const TaaFrame& frame,
                                                const UpscaleSettings& settings) {
    State& s = *state_;
    s.begin(frame_width, frame_height, frame.reset, settings);
    assert(facts.size() == s.tiles.size());
    s.planTiles(facts, !s.first && changesShading(frame), frame.repeats);
    s.planDrawing(settings.sample_cap == s.sample_cap);
    return s.wanted;
}

void TemporalUpscaler::resolve(const GBuffer& gbuffer, const TaaFrame& frame,
                               const UpscaleSettings& settings, Workers& workers) {
    assert(gbuffer.planes.motion);
    assert(settings.ring >= 1 && settings.ring <= kMaxUpscaleRing);
    assert(settings.width >= gbuffer.width() && settings.height >= gbuffer.height());
    State& s = *state_;
    s.begin(gbuffer.width(), gbuffer.height(), frame.reset, settings);
    const bool shading_changed = !s.first && changesShading(frame);
    const int past = std::max(settings.sample_cap, settings.ring);
    const bool young = !s.first && s.noteLightAge(frame.light_age, past);
    if (!shading_changed && !young && allStill(gbuffer) &&
        rest(gbuffer.width(), gbuffer.height(), settings)) {
        return;
    }
    s.light_age = young ? frame.light_age : ImageView<const uint8_t>{};
    s.started.note(gbuffer, s.first, workers);
    const bool first = s.first;
    if (s.planTiles(gbuffer.tiles, shading_changed, frame.repeats)) {
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
    return !state_->first &&
           std::all_of(state_->tiles.begin(), state_->tiles.end(),
                       [](const TileMemory& t) { return t.summed && t.finished && !t.changed; });
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
