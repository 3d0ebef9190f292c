#pragma once
// What goes to standard output: JSON for programs, plain lines for people.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/outcome.h"
#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "postfx/metrics.h"

namespace still::command {

/// A pixel that is not the same in both pictures.
struct Difference {
    int frame = 0, x = 0, y = 0;
    Rgb8 a, b;
};

struct CompareReport {
    struct Frame {
        int frame = 0;
        PixelError error;
        double ssim = 1;
    };
    std::vector<Frame> frames;
    bool numbered = false;                ///< frame patterns were compared, not two pictures
    bool with_differences = false;        ///< --exact
    std::vector<Difference> differences;  ///< the first ones

    PixelError error() const;  ///< over all frames
    double ssim() const;       ///< mean over the frames
};

struct RenderReport {
    std::string scene;
    uint64_t triangles = 0;
    int width = 0, height = 0;
    int threads = 1;
    SimdTarget simd = SimdTarget::scalar;
    std::string anti_aliasing;  ///< as typed
    std::string preset;         ///< of TAA; empty without
    std::string taa;            ///< settings over the preset's, as typed
    struct Frame {
        int frame = 0;
        StageTimes times;
        double total_ms = 0;  ///< wall time, replayed frames (--start) included
        FrameHashes hashes;
    };
    std::vector<Frame> frames;
    bool with_hashes = false;
    std::optional<CompareReport> reference;  ///< --reference
};

/// An object; {"results": [object…]} of several.
std::string renderJson(const std::vector<RenderReport>& reports);
/// One line a frame; with several reports, "scene NAME" before each one's.
std::string hashLines(const std::vector<RenderReport>& reports);
/// How the frames compare with the reference, in the form of compareLines().
std::string referenceLines(const std::vector<RenderReport>& reports);

std::string compareJson(const CompareReport& report);
std::string compareLines(const CompareReport& report);

/// The presets of TAA and the settings of --taa.
std::string presetsJson();
std::string presetsLines();
/// The settings of --taa with their values, one a line, indented; long lists are wrapped.
std::string taaSettingsLines();

/// The failure's line on standard error, whatever a file's name in it is made of.
void printFailure(const Failure& failure);

/// Writes `text` to standard output, with an error when that fails.
Outcome<void> print(const std::string& text);

}  // namespace still::command
