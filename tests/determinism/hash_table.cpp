#include "tests/determinism/hash_table.h"

#include <fstream>
#include <sstream>

#include "engine/hash.h"

namespace still::determinism {
namespace {

std::string lineOf(const std::string& scene, size_t frame, Stage stage, const StageHash& hash) {
    std::string line =
        scene + " " + std::to_string(frame) + " " + name(stage) + " " + hex(hash.whole) + " ";
    for (uint32_t tile : hash.tiles) {
        line += hex(tile).substr(12);
    }
    return line;
}

/// False when the line is not one that lineOf() makes.
bool parseLine(const std::string& line, std::string& scene, size_t& frame, int& stage,
               StageHash& hash) {
    std::istringstream words(line);
    std::string stage_name, whole, tiles;
    if (!(words >> scene >> frame >> stage_name >> whole >> tiles) || whole.size() != 16 ||
        tiles.size() % 4 != 0 ||
        (whole + tiles).find_first_not_of("0123456789abcdef") != std::string::npos) {
        return false;
    }
    for (stage = 0; stage < kStages && stage_name != name(Stage(stage)); ++stage) {
    }
    hash.whole = std::stoull(whole, nullptr, 16);
    hash.tiles.clear();
    for (size_t k = 0; k < tiles.size(); k += 4) {
        hash.tiles.push_back(uint32_t(std::stoul(tiles.substr(k, 4), nullptr, 16)));
    }
    return stage < kStages;
}

}  // namespace

FrameRecord hashOf(const FrameResult& frame) {
    FrameRecord record = hashStages(frame);
    record[size_t(Stage::linear)] = {};
    for (StageHash& hash : record) {
        for (uint32_t& tile : hash.tiles) {
            tile &= 0xFFFF;
        }
    }
    return record;
}

uint64_t digest(const SceneRecord& record) {
    std::string text;  // digits, whose order does not depend on the CPU's
    for (const FrameRecord& frame : record.frames) {
        for (const StageHash& stage : frame) {
            text += hex(stage.whole);
            for (uint32_t tile : stage.tiles) {
                text += hex(tile);
            }
        }
    }
    return hashBytes(text);
}

std::string differenceLine(const FrameRecord& expected, const FrameRecord& found, int tiles_x) {
    const auto difference = firstDifference(expected, found);
    if (!difference) {
        return {};
    }
    std::ostringstream text;
    text << "stage " << name(difference->stage) << ", ";
    if (difference->tiles.empty()) {
        text << "no single tile";
    } else {
        const int tile = difference->tiles.front();
        text << "tile (" << tile % tiles_x << ", " << tile / tiles_x << ")";
    }
    const auto stage = size_t(difference->stage);
    text << ": " << hex(found[stage].whole) << ", expected " << hex(expected[stage].whole);
    return text.str();
}

Result<Table> readTable(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) {
        return fail(file.string() + ": cannot be read, expected the table of hashes");
    }
    Table table;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        if (line.empty() || line[0] == '#') {
            continue;
        }
        std::string scene;
        size_t frame = 0;
        int stage = 0;
        StageHash hash;
        if (!parseLine(line, scene, frame, stage, hash)) {
            return fail(file.string() + ":" + std::to_string(number) +
                        ": not understood, expected SCENE FRAME STAGE HASH TILES");
        }
        if (table.empty() || table.back().scene != scene) {
            table.push_back({scene, {}});
        }
        std::vector<FrameRecord>& frames = table.back().frames;
        if (frame > frames.size() || (frame == frames.size() && stage != 0)) {
            return fail(file.string() + ":" + std::to_string(number) +
                        ": frames out of order, expected frame " + std::to_string(frames.size()));
        }
        frames.resize(std::max(frames.size(), frame + 1));
        frames[frame][size_t(stage)] = hash;
    }
    return table;
}

Result<void> writeTable(const std::filesystem::path& file, const Table& table) {
    std::ofstream out(file);
    out << "# SCENE FRAME STAGE HASH TILES: written by `determinism --update`. A change of any "
           "line\n"
           "# is a change of pixels; the commit that makes it says why.\n";
    for (const SceneRecord& record : table) {
        for (size_t frame = 0; frame < record.frames.size(); ++frame) {
            for (int stage = 0; stage < kStages; ++stage) {
                const StageHash& hash = record.frames[frame][size_t(stage)];
                if (!hash.tiles.empty()) {
                    out << lineOf(record.scene, frame, Stage(stage), hash) << "\n";
                }
            }
        }
    }
    out.close();
    if (!out) {
        return fail(file.string() + ": cannot be written");
    }
    return {};
}

}  // namespace still::determinism
