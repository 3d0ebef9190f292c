#include "engine/scene_work.h"

namespace still {

std::vector<SurfaceWork> sceneWork(const Scene& scene, const CameraChoice& choice, int frame) {
    const FrameState state = frameStateAt(scene, choice, frame, 1, 1);
    const DrawList list{.meshes = scene.meshes,
                        .materials = materialsOf(scene, state),
                        .textures = scene.textures,
                        .alpha_textures = scene.alpha_textures,
                        .instances = state.instances,
                        .windings = {},
                        .lighting = state.lighting,
                        .background = scene.background};
    const FrameView view{.width = 1,
                         .height = 1,
                         .view_projection = state.camera.view_projection,
                         .view_projection_before = state.camera_before.view_projection,
                         .eye = glm::vec3(state.camera.eye)};
    Rasterizer rasterizer;
    rasterizer.setUp(list, view, {});
    return rasterizer.surfaceWork();
}

}  // namespace still
