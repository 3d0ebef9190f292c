#pragma once
// A scene as it stands in memory: assets, objects, tracks over time. Built by engine/load.h from
// files or by demos/scenes from code. The scene file format is documented in engine/README.md.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rasterizer/draw_list.h"

namespace still {

/// A value over time, in frames. Empty track: the default. Before the first key and after the last
/// one the value is held; between keys it is interpolated linearly in double.
template <class T>
struct Track {
    struct Key {
        double frame;
        T value;
    };
    std::vector<Key> keys;  ///< strictly increasing frames
    bool animated() const { return keys.size() > 1; }
};

/// Rotation keys: degrees about `axis` (unit). Keys may exceed 360.
struct ObjectTracks {
    Track<glm::dvec3> translation;
    Track<double> rotation_deg;
    glm::dvec3 rotation_axis{0, 1, 0};
    Track<glm::dvec3> scale;  ///< non-zero components
};

/// From `frame` on the animated material has the values of Scene::materials[material], until the
/// next swap.
struct MaterialSwap {
    int frame = 0;
    uint32_t material = 0;
};

/// What happens to one of Scene::materials over time: first the swaps choose its values, then the
/// offset is added to the texture coordinates (see Material::u_offset), in repeats of the texture.
/// Flip books and screens are swaps, scrolling textures and light that wanders are offsets.
struct MaterialTracks {
    uint32_t material = 0;            ///< which one; each at most once in Scene::material_tracks
    Track<glm::dvec2> offset;         ///< u to the right, v upwards
    std::vector<MaterialSwap> swaps;  ///< strictly increasing frames
};

/// world = T(frame) · R(frame) · S(frame) · base
struct SceneObject {
    std::string name;
    uint32_t mesh = 0;
    glm::dmat4 base{1.0};
    ObjectTracks tracks;
};

/// One camera pose.
struct CameraPose {
    glm::dvec3 eye{0, 0, 5};
    glm::dvec3 target{0, 0, 0};
    glm::dvec3 up{0, 1, 0};
    double fov_y_deg = 45;  ///< vertical
    /// Parallel projection: everything has the size that a perspective camera of this pose would
    /// show at the target. The near plane may then lie behind the eye.
    bool orthographic = false;
};

struct NamedView {
    std::string name;
    CameraPose pose;
};

struct Camera {
    Track<glm::dvec3> eye, target, up;
    Track<double> fov_y_deg;
    double near = 0.1, far = 1000.0;
    bool orthographic = false;  ///< see CameraPose
};

/// One frame of a camera file: explicit matrices from another renderer or of a live session, OpenGL
/// conventions.
struct CameraFileFrame {
    glm::dmat4 view{1.0}, projection{1.0};
    std::optional<std::array<int, 2>>
        jitter_fx8{};  ///< sample offset from the pixel centre, y down
    /// The instant of the scene that is shown, ≥ 0: tracks and cuts are taken there. Empty: the
    /// frame's own number. Sessions pause, repeat and skip.
    std::optional<int> scene_frame{};
    bool cut = false;  ///< the frame has no past
};
struct CameraFile {
    int width = 0, height = 0;
    std::vector<CameraFileFrame> frames{};
    std::vector<std::string> warnings{};  ///< one line each, for standard error
};

/// See SphereLight.
struct SceneSphere {
    Track<glm::dvec3> position;
    double radius = 1;  ///< > 0
    std::array<float, 3> colour{1, 1, 1};
    Track<double> intensity{};  ///< multiplies; empty = 1
};

/// See RectangleLight.
struct SceneRectangle {
    Track<glm::dvec3> centre;
    glm::dvec3 edge_u{1, 0, 0}, edge_v{0, 0, 1};
    std::array<float, 3> colour{1, 1, 1};
    Track<double> intensity{};
};

struct SceneLights {
    std::array<float, 3> ambient{0.25f, 0.25f, 0.25f};
    Track<double> ambient_intensity;  ///< multiplies; empty = 1
    DirectionalLight sun;
    Track<double> sun_intensity;
    std::vector<PointLight> points;
    std::vector<Track<double>> point_intensity;  ///< one per point light, or empty

    // Light that is sampled, see SampledLight.
    SunShadow sun_shadow = SunShadow::none;
    double sun_angle_deg = 0.53;  ///< that the sun's disc spans, 0 … 90
    AmbientLight ambient_light = AmbientLight::plain;
    double occlusion_distance = 1;  ///< > 0, with AmbientLight::…_occlusion
    std::vector<SceneSphere> spheres{};
    std::vector<SceneRectangle> rectangles{};

    bool sampled() const {
        return sun_shadow != SunShadow::none || ambient_light != AmbientLight::plain ||
               !spheres.empty() || !rectangles.empty();
    }
};

struct Bounds {
    glm::dvec3 min{0}, max{0};
    bool valid = false;
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<std::string> mesh_names;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<AlphaTexture> alpha_textures;
    std::vector<MaterialTracks> material_tracks;
    std::vector<SceneObject> objects;
    Camera camera;
    std::optional<CameraFile>
        camera_file;  ///< goes before `camera`, unless a view or an orbit is chosen
    /// The camera comes from frameScene() for 16:9; whoever knows the real aspect calls it again.
    bool automatic_camera = false;
    bool automatic_light = false;  ///< `lights` are what a file gets that says nothing of them
    std::vector<NamedView> views;
    SceneLights lights;
    std::array<float, 3> background{0.0f, 0.0f, 0.0f};  ///< linear light
    std::vector<int> cuts;                              ///< frames whose camera has no past, sorted
    std::vector<std::string> warnings;                  ///< one line each, for standard error
    /// Every file that loading read or looked for in vain, each at least once: when none of them
    /// changes, the same is loaded again. Empty for scenes made by code.
    std::vector<std::string> files;

    uint64_t triangleCount() const;     ///< over all objects
    Bounds bounds(double frame) const;  ///< world box of all vertices
};

}  // namespace still
