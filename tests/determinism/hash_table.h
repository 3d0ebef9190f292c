#pragma once
// The committed table: what every stage of every frame of every scene hashes to, whole and by tile.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/result.h"
#include "engine/stage_hash.h"

namespace still::determinism {

/// The hashes that the table keeps: all stages but `linear`, of a tile the lowest 16 bits.
using FrameRecord = StageHashes;
struct SceneRecord {
    std::string scene;
    std::vector<FrameRecord> frames;
};
using Table = std::vector<SceneRecord>;

/// Of a frame that has all planes.
FrameRecord hashOf(const FrameResult& frame);

/// One hash over all stages of all frames.
uint64_t digest(const SceneRecord& record);

/// One line that names stage and tile of the first difference; empty when there is none.
std::string differenceLine(const FrameRecord& expected, const FrameRecord& found, int tiles_x);

/// Lines "SCENE FRAME STAGE HASH TILES", TILES being four hexadecimal digits each.
Result<Table> readTable(const std::filesystem::path& file);
Result<void> writeTable(const std::filesystem::path& file, const Table& table);

}  // namespace still::determinism
