#pragma once
// What the upscaler keeps between frames, and the steps of a frame: upscale.cpp puts them in order,
// upscale_state.cpp notes what came and what is needed.

#include <algorithm>
#include <array>
#include <vector>

#include "postfx/internal/evidence.h"
#include "postfx/internal/kernels.h"
#include "postfx/internal/memory.h"
#include "postfx/internal/started.h"
#include "postfx/internal/upscale_job.h"
#include "postfx/spatial.h"
#include "postfx/spatial_upscale.h"

namespace still {
namespace upscale {

inline int tilesAcross(int pixels) {
    return (pixels + kTileSize - 1) / kTileSize;
}

/// A frame as it was kept, of the size that frames had then.
struct KeptFrame {
    taa::SlotPlanes planes;
    Axis x, y;

    Slot slot() {
        return {.in = planes.pointers<taa::SlotIn>(),
                .x = x,
                .y = y,
                .stride = planes.planes[0].view().stride};
    }
};

}  // namespace upscale

struct TemporalUpscaler::State {
    std::vector<upscale::KeptFrame> ring;
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
    std::vector<taa::TileMemory> tiles;  ///< of the frame
    std::vector<uint8_t> wanted;         ///< plan()
    std::vector<uint8_t> changed;        ///< changedTiles()
    taa::SurfaceChanges surfaces;
    ImageView<const uint8_t> light_age;
    taa::StartedSurfaces started;
    bool first = true;  ///< no frame was resolved since the last reset
    SpatialFilter spatial;
    SpatialUpscaler enlarger;
    std::array<Image<uint16_t>, 3> filtered;  ///< a first frame

    taa::TileRect rectOf(int tile) const { return taa::tileRect(tile, frame_width, frame_height); }
    size_t tileCount() const {
        return size_t(upscale::tilesAcross(frame_width)) *
               size_t(upscale::tilesAcross(frame_height));
    }

    void begin(int new_width, int new_height, bool reset, const UpscaleSettings& settings);
    void resizeImage(const UpscaleSettings& settings);
    void planDrawing(bool same_cap);
    bool finished(int cap) const;
    void advanceRing(const TaaFrame& frame, bool shading_changed);
    void forgetStarted();
    upscale::Job makeJob(const GBuffer& gbuffer, const UpscaleSettings& settings);
    void keepAndSum(const upscale::Job& job, const taa::TileKernels& kernels, int tile);
    void noteChanged(const upscale::Job& job);
    void showFirst(const GBuffer& gbuffer, const TaaFrame& frame, SimdTarget simd,
                   Workers& workers);
};

}  // namespace still
