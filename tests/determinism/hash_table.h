#pragma once
// The committed table: what every stage of every frame of every scene hashes to, whole and by tile.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/frame_loop.h"
#include "engine/result.h"

namespace still::determinism {

/// In pipeline order: the first one that differs is where to look.
enum class Stage { depth, id, normal, motion, color, output };
constexpr int kStages = 6;
const char* name(Stage stage);

/// One stage of one frame.
struct StageHash {
    uint64_t whole = 0;
    std::vector<uint16_t> tiles;  ///< row by row, kTileSize
    friend bool operator==(const StageHash&, const StageHash&) = default;
};
using FrameRecord = std::array<StageHash, kStages>;
struct SceneRecord {
    std::string scene;
    std::vector<FrameRecord> frames;
};
using Table = std::vector<SceneRecord>;

/// Of a frame that has all planes.
FrameRecord hashOf(const FrameResult& frame);

/// One line that names stage and tile of the first difference; empty when there is none.
std::string firstDifference(const FrameRecord& expected, const FrameRecord& found, int tiles_x);

/// Lines "SCENE FRAME STAGE HASH TILES", TILES being four hexadecimal digits each.
Result<Table> readTable(const std::filesystem::path& file);
Result<void> writeTable(const std::filesystem::path& file, const Table& table);

}  // namespace still::determinism
