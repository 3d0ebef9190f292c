#pragma once
// The command line as it was typed, and the meaning of its values.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/camera_options.h"
#include "demos/stillframe/limits.h"
#include "demos/stillframe/outcome.h"
#include "engine/anti_aliasing.h"
#include "engine/frame_loop.h"

namespace still::command {

struct Size {
    int width = 0, height = 0;
};

struct RenderOptions {
    std::vector<std::string> scenes;  ///< FILE.obj, FILE.json, builtin:NAME or -
    std::string output;               ///< empty: no picture is written
    std::string reference;            ///< picture or pattern to compare with
    std::optional<Size> resolution;   ///< empty: 1280x720, or the camera file's
    std::optional<int> frames;        ///< empty: 1, 60 of a turntable, or the camera file's count
    std::optional<int> start;         ///< empty: 0; typed, the frames are part of a longer run
    std::string lights;               ///< scene file; empty: the scene's own
    std::string cameras;
    std::string view;
    CameraOptions camera;
    double orbit_deg = 0;
    std::optional<int> orbit_frames;  ///< of the whole run; empty: up to the last frame
    bool turntable = false;
    std::optional<std::array<float, 3>> background;  ///< linear light; empty: the scene's
    bool no_background = false;
    double exposure_stops = 0;
    std::string anti_aliasing;   ///< empty: taa, or ssaa:16 of a turntable
    std::string taa;             ///< comma-separated settings over the preset's
    std::optional<int> samples;  ///< of a finished picture; empty: 64
    std::string denoise = "on";  ///< sampled light
    std::string dump;            ///< comma-separated planes
    int threads = 0;             ///< 0: all cores
    std::string simd;            ///< empty: the best
    std::string shading = "deferred";
    std::string tone_map = "none";
    int fps = 30;
    bool no_cache = false;
    bool hash = false;
    bool json = false;
    bool quiet = false;
    bool watch = false;
    Limits limits;
};

struct CompareOptions {
    std::string a, b;
    std::string diff;
    bool exact = false;
    bool json = false;
    bool quiet = false;
};

/// "1280x720" or "1280,720", each side 1 … kMaxTargetSize.
Outcome<Size> parseResolution(const std::string& text);

/// See engine/anti_aliasing.h.
Outcome<AntiAliasingChoice> parseAntiAliasing(const std::string& text);
Outcome<TaaPolicy> parseTaaSettings(const std::string& text, TaaPolicy policy);

/// 2 to the power of `stops`, the same everywhere, exact for whole numbers.
double exposureFactor(double stops);

/// Planes that --dump can write.
enum class DumpPlane { color, depth, normal, motion, id, confidence };
std::string dumpName(DumpPlane plane);
/// "depth,normal"; empty text is an empty list.
Outcome<std::vector<DumpPlane>> parseDump(const std::string& text);

/// One of availableSimdTargets(); empty text is the best one.
Outcome<SimdTarget> parseSimd(const std::string& text);

}  // namespace still::command
