#include "tests/determinism/hash_table.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "engine/hash.h"

namespace still::determinism {
namespace {

constexpr const char* kNames[kStages] = {"depth", "id", "normal", "motion", "color", "output"};

template <class T>
ImageView<const T> tileOf(ImageView<const T> plane, int tile_x, int tile_y) {
    const int x0 = tile_x * kTileSize, y0 = tile_y * kTileSize;
    return {plane.row(y0) + x0, std::min(kTileSize, plane.width - x0),
            std::min(kTileSize, plane.height - y0), plane.stride};
}

/// Hash of several planes of one size, as a whole and by tile.
template <class... T>
StageHash hashPlanes(ImageView<const T>... planes) {
    const auto combine = [](auto... hashes) {
        uint64_t sum = 0;
        ((sum = sum * 3 + hashes), ...);
        return sum;
    };
    StageHash hash;
    hash.whole = combine(hashPlane(planes)...);
    const int width = std::max({planes.width...}), height = std::max({planes.height...});
    for (int y = 0; y * kTileSize < height; ++y) {
        for (int x = 0; x * kTileSize < width; ++x) {
            hash.tiles.push_back(uint16_t(combine(hashPlane(tileOf(planes, x, y))...)));
        }
    }
    return hash;
}

std::string lineOf(const std::string& scene, size_t frame, int stage, const StageHash& hash) {
    std::string line =
        scene + " " + std::to_string(frame) + " " + kNames[stage] + " " + hex(hash.whole) + " ";
    for (uint16_t tile : hash.tiles) {
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
    stage = int(std::find(kNames, kNames + kStages, stage_name) - kNames);
    hash.whole = std::stoull(whole, nullptr, 16);
    hash.tiles.clear();
    for (size_t k = 0; k < tiles.size(); k += 4) {
        hash.tiles.push_back(uint16_t(std::stoul(tiles.substr(k, 4), nullptr, 16)));
    }
    return stage < kStages;
}

}  // namespace

const char* name(Stage stage) {
    return kNames[int(stage)];
}

FrameRecord hashOf(const FrameResult& frame) {
    const GBuffer& g = *frame.gbuffer;
    FrameRecord record;
    record[size_t(Stage::depth)] = hashPlanes(g.depth.view());
    record[size_t(Stage::id)] = hashPlanes(g.id.view());
    record[size_t(Stage::normal)] = hashPlanes(g.normal.view());
    record[size_t(Stage::motion)] = hashPlanes(g.motion.view(), g.depth_before.view());
    record[size_t(Stage::color)] = hashPlanes(g.red.view(), g.green.view(), g.blue.view());
    record[size_t(Stage::output)] = hashPlanes(frame.output);
    return record;
}

std::string firstDifference(const FrameRecord& expected, const FrameRecord& found, int tiles_x) {
    for (size_t stage = 0; stage < kStages; ++stage) {
        const StageHash &a = expected[stage], &b = found[stage];
        if (a == b) {
            continue;
        }
        const size_t count = std::min(a.tiles.size(), b.tiles.size());
        const auto tile = size_t(
            std::mismatch(a.tiles.begin(), a.tiles.begin() + ptrdiff_t(count), b.tiles.begin())
                .first -
            a.tiles.begin());
        std::ostringstream text;
        text << "stage " << kNames[stage] << ", ";
        if (tile < count) {
            text << "tile (" << tile % size_t(tiles_x) << ", " << tile / size_t(tiles_x) << ")";
        } else {
            text << "no single tile";
        }
        text << ": " << hex(b.whole) << ", expected " << hex(a.whole);
        return text.str();
    }
    return {};
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
                out << lineOf(record.scene, frame, stage, record.frames[frame][size_t(stage)])
                    << "\n";
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
