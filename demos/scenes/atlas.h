#pragma once
// The failure atlas: one small scene for each way in which temporal methods fail, with the frames
// that show it and the measure that exposes it. And a suite of noisy scenes in the same form.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene.h"

namespace still {

/// Frames that are measured together.
struct AtlasSegment {
    std::string name;         ///< "still", "moving", "first", "event"
    int first = 0, last = 0;  ///< inclusive
    int step = 1;             ///< every step-th frame is compared with a reference
    int ssaa_samples = 256;   ///< of the reference
};

struct AtlasCase {
    std::string name;     ///< "disocclusion"
    std::string failure;  ///< one sentence: what goes wrong, and why
    std::string measure;  ///< the metric that exposes it: a column of the atlas
    std::function<Scene()> make{};
    std::vector<AtlasSegment> segments;  ///< in order of frames
    std::optional<int> event_frame{};    ///< recovery is counted from here
    std::optional<int> resize_frame{};   ///< earlier frames are rendered at half the size
    bool slow = false;                   ///< left out unless asked for by name
    /// Things pass under a camera that stands, and what they leave behind is measured.
    bool trail = false;
};

/// All cases, in the order of the issue they answer. Scenes are made when asked for.
const std::vector<AtlasCase>& atlasCases();

/// The suite of noise: scenes with light that is sampled. Their references are of the same
/// estimator, with many samples.
const std::vector<AtlasCase>& noiseCases();

/// A case of that suite: a scene that stands still, looked at when it has had 32 frames.
AtlasCase settledNoise(std::string name, std::string failure, std::function<Scene()> make);

/// Of either suite; null when there is no such case.
const AtlasCase* findAtlasCase(const std::string& name);

}  // namespace still
