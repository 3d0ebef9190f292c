#pragma once
// What the scenes of the failure atlas share: a stage whose scale is known in pixels, walls and
// boxes that show ghosts, and the camera's ways of moving.
//
//   eye (0, 0, 10) ── looks along −z ──► the plane z = 0 is 16 × 9 units large, 20 pixels per unit
//                                        at 320×180, the atlas's size. Speeds are in those pixels.

#include <functional>

#include "demos/scenes/scene_builder.h"
#include "engine/scene.h"
#include "rasterizer/texture_layout.h"

namespace still::scenes::atlas {

constexpr double kPixel = 0.05;         ///< width of a pixel on the plane z = 0
constexpr double kEyeDistance = 10;     ///< of the eye from that plane
constexpr double kPixelsPerUnit = 200;  ///< pixels per unit of (offset / distance), at 320×180
constexpr double kFovY_deg = 48.45549063590834;  ///< 2 atan(0.45), so that 9 units fit at z = 0
constexpr int kFrames = 64;                      ///< tracks run from frame 0 to this one

/// Speed of the slow pans: 0.1 pixels per frame up to frame 24, then faster until it is 0.5 from
/// frame 39 on.
double slowPanSpeed(int frame);
/// Way in pixels from frame 0 to `frame` at that speed.
double slowPanWay(int frame);

/// Scene with the stage's camera, daylight, and a name.
Scene makeStage(const char* name);

/// Replaces light and shading by the texture's own colours.
void setFlatLight(Scene& scene);

/// Moves the camera sideways by `pixels(frame)` as seen at z = 0, without turning it.
void truck(Scene& scene, const std::function<dvec2(int frame)>& pixels);
/// With constant speed, in pixels per frame; halfway at frame 32.
void truck(Scene& scene, const dvec2& speed);
/// Turns the camera about the vertical through its eye, away from −z, by an angle that moves what
/// is in the middle of the picture by `pixels(frame)`.
void turn(Scene& scene, const std::function<double(int frame)>& pixels);

/// A key for every frame up to kFrames.
template <class T>
void setTrack(Track<T>& track, const std::function<T(int frame)>& value) {
    track.keys.clear();
    for (int frame = 0; frame <= kFrames; ++frame) {
        track.keys.push_back({double(frame), value(frame)});
    }
}

/// Object moves on a straight line: at `middle` at frame 32, `speed` in pixels at z = 0 per frame.
void slide(SceneObject& object, const dvec3& middle, const dvec2& speed);

/// Brick wall at depth z, from −half to +half, bricks of about 17 × 8 pixels at z = 0.
void addWall(Scene& scene, double z, const dvec2& half, uint32_t seed);

/// Checkered boxes of all sizes, standing and hanging, between x = −half and half, at depths from
/// −2.5 to 1.
void addBoxes(Scene& scene, double half, int count, uint32_t seed);

}  // namespace still::scenes::atlas
