#pragma once
// Scenes to measure speed on, and the ways in which any scene is moved meanwhile. Programs that
// measure other renderers draw the very same frames: frameStateAt(benchScene(…), {}, frame, …).

#include <optional>
#include <string>
#include <vector>

#include "engine/scene.h"

namespace still {

/// What moves while a scene is measured.
enum class BenchMotion {
    still,    ///< nothing
    pan,      ///< the camera alone
    objects,  ///< whatever the scene moves, before a camera at rest
};
constexpr BenchMotion kBenchMotions[] = {BenchMotion::still, BenchMotion::pan,
                                         BenchMotion::objects};
const char* name(BenchMotion motion);

/// Built-in scenes for measuring, as builtinScene() takes them.
std::vector<std::string> benchSceneNames();

/// The scene without motion of any kind, as it stands in its first frame.
Scene frozen(Scene scene);

/// `scene` with that motion and no other; empty: it has no objects that move. The camera pans along
/// the scene's camera file; without one it goes sideways and back, so that what is as far as its
/// target moves by kPanPx on a picture of that height, or, where the camera was chosen by the
/// loader, around the target by kPanDeg. Its path ends after kBenchFrames.
std::optional<Scene> benchScene(Scene scene, BenchMotion motion, int height);

constexpr double kPanPx = 4.3;  ///< per frame; no whole number, which resampling would gain from
constexpr double kPanDeg = 1.0 / 3;
constexpr int kPanTurn = 32;  ///< frames from one end of the path to the other
constexpr int kBenchFrames = 4096;

}  // namespace still
