#pragma once
// Golden pictures: a folder with a manifest that lists scenes and frames, and with what they were
// recorded to be. verify() renders again and compares bit for bit, with no tolerance. For tests of
// any framework:
//
//     CHECK(still::golden::verify("golden"));                                         // Catch2
//     EXPECT_TRUE(verdict.ok) << verdict.message;                                     // GoogleTest
//
// `stillframe golden record` writes the recordings. Both formats: engine/README.md.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/frame_loop.h"
#include "engine/result.h"
#include "engine/stage_hash.h"
#include "rasterizer/image.h"

namespace still::golden {

/// One entry of the manifest.
struct Case {
    std::string name;            ///< letters, digits, - and _; files are named after it
    std::string scene;           ///< file beside the manifest, or builtin:NAME
    std::string view;            ///< one of the scene's; empty: its own camera
    std::string cameras;         ///< camera file beside the manifest; empty: none
    std::vector<int> frames;     ///< those that are compared; strictly increasing
    FrameSettings settings;      ///< without what the scene decides (view, cameras)
    std::optional<int> samples;  ///< sub-frames; empty: the rule of renderCase()
    std::string place;           ///< in the manifest, for messages: "FILE: /cases/2"
};

struct Manifest {
    std::filesystem::path folder;
    std::vector<Case> cases;
    std::vector<std::string> warnings;  ///< one line each, for standard error
};

/// Reads FOLDER/golden.json. The error names file, place and what was expected.
Result<Manifest> readManifest(const std::filesystem::path& folder);

/// What a case was recorded to be.
struct Record {
    struct Frame {
        int frame = 0;
        StageHashes stages{};
        friend bool operator==(const Frame&, const Frame&) = default;
    };
    int width = 0, height = 0;
    std::vector<Frame> frames;
    friend bool operator==(const Record&, const Record&) = default;
};

/// Where the recording of case `name` stands, and the picture of one of its frames.
std::filesystem::path recordFile(const Manifest& manifest, const std::string& name);
std::filesystem::path pictureFile(const Manifest& manifest, const std::string& name, int frame);

/// The bytes of a recording, and back. Errors are "FILE:LINE: expected …".
std::string recordText(const Record& record);
Result<Record> readRecord(const std::filesystem::path& file);

struct Options {
    std::vector<std::string> only;  ///< names of cases; empty: all
    /// Of `shards` parts of the (chosen) cases the `shard`th, from 1; each case is in exactly one.
    int shard = 1, shards = 1;
    int threads = 0;  ///< 0: all cores; nothing depends on it
    SimdTarget simd = bestSimdTarget();
    /// Makes the scene that a manifest calls builtin:NAME of NAME; empty: there are none.
    std::function<Result<Scene>(const std::string& name)> builtin{};
    /// See LoadOptions. The manifest's own names are held to its folder, and scenes in it to it.
    std::filesystem::path cache_folder{};
    bool allow_outside = false;
    uint64_t max_memory_bytes = std::numeric_limits<uint64_t>::max();
    std::function<void()> frame_done{};              ///< called after each compared frame
    std::function<void(const std::string&)> warn{};  ///< receives each warning of a scene, a line
};

/// The cases that `options` choose, in the manifest's order. An error for unknown names.
Result<std::vector<const Case*>> chosenCases(const Manifest& manifest, const Options& options);

/// Receives each frame of a case.
using FrameSink = std::function<Result<void>(const Record::Frame&, const FrameResult&)>;

/// Renders a case. One frame of TAA, frame 0 of a scene in which nothing moves, is a finished
/// picture (kTaaPeriod samples) unless the case says how many; all others have one sample a frame.
Result<Record> renderCase(const Manifest& manifest, const Case& golden_case, const Options& options,
                          const FrameSink& sink = {});

enum class Finding {
    equal,
    differs,
    no_golden,  ///< there is no recording, or it is of other frames or another size
    error,      ///< scene or recording cannot be read
};

/// Pixels of a picture's tile.
struct TileRectangle {
    int tile_x = 0, tile_y = 0;
    int x = 0, y = 0, width = 0, height = 0;
};
TileRectangle tileRectangle(int tile, int width, int height);

/// The first frame of a case that differs.
struct FrameDifference {
    int frame = 0;
    int width = 0, height = 0;
    int frame_width = 0, frame_height = 0;  ///< of the planes before Stage::linear
    StageDifference stages;
    Image<Rgb8> actual;
    Image<Rgb8> expected;  ///< empty when the recorded picture is not there, or is another one
    std::optional<uint64_t> pixels;  ///< how many are different; nothing without `expected`
    /// The topmost and in its row leftmost one of the first tile of `stages`, if that has one, else
    /// of the picture; −1: none.
    int first_x = -1, first_y = -1;
    double psnr_db = 0;  ///< infinite when pictures are equal
};

/// The picture's pixels that one of `difference.stages.tiles` covers.
TileRectangle tileRectangle(const FrameDifference& difference, int tile);

struct CaseVerdict {
    std::string name;
    Finding finding = Finding::equal;
    std::string message;  ///< one line that begins with the name; empty when equal
    int frames = 0;       ///< compared
    int differing = 0;    ///< of them
    std::optional<FrameDifference> first;
};

/// Renders a case and compares it with its recording.
CaseVerdict verifyCase(const Manifest& manifest, const Case& golden_case, const Options& options);

struct Verdict {
    bool ok = false;
    /// A line for each case that is not equal, in the end the command that accepts the change;
    /// when ok, how many cases are equal.
    std::string message;
    std::vector<std::string> failed;  ///< names of cases

    explicit operator bool() const { return ok; }
    friend std::ostream& operator<<(std::ostream& stream, const Verdict& verdict);
};

/// Verifies the cases of a folder that `options` choose. Whatever is wrong is a line of the
/// message, with warnings about the manifest before it.
Verdict verify(const std::filesystem::path& folder, const Options& options = {});

/// `stillframe golden record …` for these cases, to be pasted into a shell.
std::string acceptCommand(const std::filesystem::path& folder,
                          const std::vector<std::string>& names);

}  // namespace still::golden
