// What came with a frame, and what its tiles need.

#include "postfx/internal/upscale_state.h"

#include <utility>

#include "postfx/internal/upscale_rules.h"

namespace still {
namespace {

using taa::SlotPlanes;
using taa::TileMemory;
using taa::TileRect;
using upscale::Axis;
using upscale::Job;
using upscale::KeptFrame;
using upscale::tilesAcross;

}  // namespace

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
        surfaces.forget(settings.ring);
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
    return !first && cap == sample_cap && taa::allFinished(tiles);
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

/// The cursor's slot becomes this frame's, and what is counted in kept frames goes on.
void TemporalUpscaler::State::advanceRing(const TaaFrame& frame, bool shading_changed) {
    const int slots = int(ring.size());
    surfaces.note(frame, shading_changed, slots);
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
    taa::noteJitter(kept.planes, frame, tiles);
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
    frame.now = taa::currentOf(gbuffer);
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
    frame.change_age = surfaces.ages(settings.ring);
    frame.start_age = started.ages();
    frame.turning = surfaces.turning();
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

}  // namespace still
