#pragma once
// Frame N of a scene: what stands where, and what changed since frame N−1. A pure function.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/scene.h"
#include "rasterizer/draw_list.h"

namespace still {

/// The camera in explicit form.
struct CameraState {
    glm::dmat4 view_projection{1.0};  ///< unjittered, OpenGL clip space
    glm::dvec3 eye{0};
};

struct FrameState {
    std::vector<Instance> instances;  ///< with surfaces numbered, moved flags set
    Lighting lighting;
    CameraState camera, camera_before;
    bool cut = false;                    ///< first frame, or a cut: no past
    bool lighting_changed = false;       ///< of the light that is not sampled
    bool sampled_light_changed = false;  ///< lamps, sun or ambient that are
    /// Those of this frame; empty while the scene's own are drawn, see materialsOf().
    std::vector<Material> materials;
    /// Bit s % 64 of word s / 64 is set for each surface s whose material differs from that of the
    /// frame before, up to the last surface. Empty: no material differs, or a cut.
    std::vector<uint64_t> changed_surfaces;
    /// The same form: surfaces of objects that turn or change their scale. Empty: none does.
    std::vector<uint64_t> turning_surfaces;
    std::optional<std::array<int, 2>> jitter_fx8;  ///< given by a camera file
};

/// How the camera is chosen: a file excludes the others; without a view the scene's camera is used,
/// and an orbit turns whichever of the two it is.
struct CameraChoice {
    const CameraFile* file = nullptr;  ///< explicit matrices; frame N uses entry min(N, last)
    int view = -1;                     ///< index into Scene::views, a fixed pose
    double orbit_deg = 0;              ///< circles the target by this angle over `orbit_frames`
    int orbit_frames = 1;
};

/// The explicit matrices that `choice` leads to, or null: the chosen file, or the scene's own
/// unless a view or an orbit is chosen.
const CameraFile* cameraFileOf(const Scene& scene, const CameraChoice& choice);

/// The pose of the scene's camera, or of the view, with the orbit; explicit matrices have none.
CameraPose poseAt(const Scene& scene, const CameraChoice& choice, int frame);

/// State of frame `frame` ≥ 0. `width` and `height` give the aspect.
FrameState frameStateAt(const Scene& scene, const CameraChoice& choice, int frame, int width,
                        int height);

/// The materials to draw `state` with; valid as long as both arguments.
std::span<const Material> materialsOf(const Scene& scene, const FrameState& state);

/// The last frame ≤ `frame` that has no past: 0, one that goes over one of the scene's cuts, or one
/// that the camera file calls a cut.
int lastCut(const Scene& scene, const CameraChoice& choice, int frame);

/// What changes from frame to frame.
struct Changes {
    bool objects = false, materials = false, lights = false, camera = false, cuts = false;
};
Changes changesOf(const Scene& scene, const CameraChoice& choice);

/// True when no frame differs from frame 0 (no animation of objects, materials, lights or
/// camera, no orbit, cut or moving camera file).
bool isStill(const Scene& scene, const CameraChoice& choice);

/// Surfaces of the scene: the objects' mesh parts in order. Loaders refuse more than kMaxSurfaces,
/// and more than 65535 objects.
uint32_t surfaceCount(const Scene& scene);

}  // namespace still
