#pragma once
// Puts a Scene together by name instead of by index arithmetic.

#include <string>
#include <utility>

#include "demos/scenes/mesh_builder.h"
#include "engine/scene.h"

namespace still::scenes {

inline int32_t addTexture(Scene& scene, Texture texture) {
    scene.textures.push_back(std::move(texture));
    return int32_t(scene.textures.size() - 1);
}

inline int32_t addTexture(Scene& scene, AlphaTexture texture) {
    scene.alpha_textures.push_back(std::move(texture));
    return int32_t(scene.alpha_textures.size() - 1);
}

inline uint32_t addMaterial(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return uint32_t(scene.materials.size() - 1);
}

inline uint32_t addMesh(Scene& scene, std::string name, Mesh mesh) {
    scene.meshes.push_back(std::move(mesh));
    scene.mesh_names.push_back(std::move(name));
    return uint32_t(scene.meshes.size() - 1);
}

/// The returned reference is valid until the next object is added.
inline SceneObject& addObject(Scene& scene, std::string name, uint32_t mesh) {
    SceneObject& object = scene.objects.emplace_back();
    object.name = std::move(name);
    object.mesh = mesh;
    return object;
}

inline SceneObject& addObject(Scene& scene, std::string name, Mesh mesh) {
    const uint32_t index = addMesh(scene, name, std::move(mesh));
    return addObject(scene, std::move(name), index);
}

inline void setCamera(Scene& scene, const CameraPose& pose, double near, double far) {
    scene.camera.eye.keys = {{0, pose.eye}};
    scene.camera.target.keys = {{0, pose.target}};
    scene.camera.up.keys = {{0, pose.up}};
    scene.camera.fov_y_deg.keys = {{0, pose.fov_y_deg}};
    scene.camera.near = near;
    scene.camera.far = far;
}

/// Ambient light and a white sun from above left behind the camera, for the small scenes.
inline void setDaylight(Scene& scene) {
    const dvec3 sun = unit({0.4, -0.8, -0.6});
    scene.lights.ambient = {0.25f, 0.27f, 0.32f};
    scene.lights.sun.direction = {float(sun.x), float(sun.y), float(sun.z)};
    scene.lights.sun.colour = {0.8f, 0.76f, 0.7f};
}

/// Translation · scale, without rotation.
inline dmat4 placed(const dvec3& at, const dvec3& scale) {
    dmat4 m{1.0};
    m[0][0] = scale.x;
    m[1][1] = scale.y;
    m[2][2] = scale.z;
    m[3] = glm::dvec4(at, 1.0);
    return m;
}

}  // namespace still::scenes
