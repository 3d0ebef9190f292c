#pragma once
// What each stage of a frame hashes to, whole and tile by tile, so that a difference has a place.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/frame_loop.h"

namespace still {

/// In pipeline order: the first one that differs is where to look.
enum class Stage {
    depth,
    id,
    normal,
    motion,    ///< motion and the previous depth
    albedo,    ///< this and the next two: of scenes with sampled light
    light,     ///< one sample of it
    denoised,  ///< the same after the denoiser
    color,     ///< of the G-buffer: this frame's sample
    linear,    ///< the resolved picture before encoding
    output,
};
constexpr int kStages = 10;
const char* name(Stage stage);
/// Whether frames of scenes without sampled light do not have it.
constexpr bool isOfSampledLight(Stage stage) {
    return stage == Stage::albedo || stage == Stage::light || stage == Stage::denoised;
}

/// One stage of one frame. Without pixels there are no tiles.
struct StageHash {
    uint64_t whole = 0;
    std::vector<uint32_t> tiles;  ///< row by row, kTileSize
    friend bool operator==(const StageHash&, const StageHash&) = default;
};
using StageHashes = std::array<StageHash, kStages>;

/// Planes that a frame does not have (see PlaneSet) have no tiles. The G-buffer is this frame's
/// own only with FrameSettings::fresh_gbuffer.
StageHashes hashStages(const FrameResult& frame);

struct StageDifference {
    Stage stage = Stage::output;
    /// Those that differ, in order; empty when the number of tiles is not the same, or when the
    /// tiles' shorter hashes happen to agree.
    std::vector<int> tiles;
};

/// Nothing when all stages are equal.
std::optional<StageDifference> firstDifference(const StageHashes& expected,
                                               const StageHashes& found);

}  // namespace still
