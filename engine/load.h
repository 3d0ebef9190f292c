#pragma once
// Files in, Scene out. Everything here returns an Error with one clear line instead of crashing.

#include <filesystem>
#include <string>

#include "engine/result.h"
#include "engine/scene.h"

namespace still {

/// Loads NAME.obj (framed by its projected bounds, default light) or NAME.json (scene file).
/// Colour textures are decoded from sRGB and get mip chains built in linear light.
/// With a `cache_folder`, models of a megabyte and more are kept there, as they are in memory, and
/// taken from there the next time, unless a file that they are made of or the program has changed.
/// Scene and warnings are the same; a folder that cannot be used costs time only.
Result<Scene> loadScene(const std::filesystem::path& file,
                        const std::filesystem::path& cache_folder = {});

/// Text of a scene file, which begins with a brace, or else of an OBJ. `name` stands for it in
/// messages; files that it names are looked for in the present folder.
Result<Scene> loadSceneText(std::string text, const std::string& name);

/// Gives the scene `light` or `lights`, and `background`, of a scene file instead of its own; the
/// file's other keys are not looked at. Nothing changes after an error.
Result<void> loadLights(const std::filesystem::path& file, Scene& scene);

/// For a scene, just loaded, whose up is not +y (`up` is not zero): that of the camera and all
/// views. Automatic light and camera are turned along, +x staying to the right unless up is ±x.
void setUpAxis(Scene& scene, glm::dvec3 up);

/// Loads {"width":W,"height":H,"frames":[{"view":[16],"proj":[16],"jitter":[x,y],"frame":N,
/// "cut":true}…]}: column-major, OpenGL clip space, proj unjittered, jitter in pixels = sample
/// offset from the pixel centre, x to the right and y down, in [−0.5, 0.5), rounded to 1/256; the
/// last three are optional, see CameraFileFrame.
Result<CameraFile> loadCameraFile(const std::filesystem::path& file);

/// Sets eye, target, near and far so that the projected bounds of frame 0 fill the picture with a
/// 5 % margin, seen from `direction` (from the scene towards the eye). Aspect = width / height.
void frameScene(Scene& scene, glm::dvec3 direction, double aspect, glm::dvec3 up = {0, 1, 0});

/// The same from where an automatic camera stands, for pictures that are not 16:9; other cameras
/// stay as they are.
void frameForAspect(Scene& scene, int width, int height);

}  // namespace still
