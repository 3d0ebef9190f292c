#pragma once
// Files in, Scene out. Everything here returns an Error with one clear line instead of crashing.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

#include "engine/result.h"
#include "engine/scene.h"

namespace still {

/// A scene of more triangles, over all objects, is refused.
constexpr uint64_t kMaxTriangles = uint64_t{1} << 27;

/// What scenes may take from the system.
struct LoadOptions {
    /// Models of a megabyte and more are kept here, as they are in memory, and taken from here the
    /// next time, unless a file that they are made of or the program has changed. Scene and
    /// warnings are the same; a folder that cannot be used costs time only. Empty: none.
    std::filesystem::path cache_folder{};
    /// Files that a scene names, and those that they name, may lie anywhere; else only in
    /// `folder` and below, links followed.
    bool allow_outside = false;
    std::filesystem::path folder{};  ///< empty: that of the scene
    /// A file or image that needs more memory is refused before it is read, as far as its size
    /// tells.
    uint64_t max_memory_bytes = std::numeric_limits<uint64_t>::max();
};

/// Loads NAME.obj (framed by its projected bounds, default light) or NAME.json (scene file).
/// Colour textures are decoded from sRGB and get mip chains built in linear light.
Result<Scene> loadScene(const std::filesystem::path& file, const LoadOptions& options = {});

/// Text of a scene file, which begins with a brace, or else of an OBJ. `name` stands for it in
/// messages; files that it names are looked for in the present folder.
Result<Scene> loadSceneText(std::string text, const std::string& name,
                            const LoadOptions& options = {});

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
