// Everything here is a pure function of the scene and the frame number, in double with the
// operations in a written order; only finished transforms are rounded to float.

#include "engine/timeline.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/camera.h"
#include "engine/det_math.h"
#include "engine/internal/tracks.h"

namespace still {
namespace {

/// Where the highlights are seen from. A parallel projection sees from infinitely far: its eye is
/// put back by 10,000 times what it shows, so that directions to it differ by 0.01° at most.
glm::dvec3 eyeOf(const glm::dmat4& view, const glm::dmat4& projection) {
    constexpr double kFarBehind = 1e4;
    const glm::dvec3 eye = originOf(view);
    if (!isParallel(projection) || projection[1][1] == 0 || projection[2][2] == 0) {
        return eye;
    }
    const auto sizeOf = [](double scale) { return 2 / (scale < 0 ? -scale : scale); };
    const double size = sizeOf(projection[1][1]) + sizeOf(projection[2][2]);
    const glm::dvec3 back(view[0][2], view[1][2], view[2][2]);
    return eye + back * (kFarBehind * size);
}

const CameraFileFrame& fileFrame(const CameraFile& file, int frame) {
    assert(!file.frames.empty());
    return file.frames[std::min(size_t(frame), file.frames.size() - 1)];
}

/// The instant of the scene that a frame shows.
int instantOf(const CameraFile* file, int frame) {
    return file == nullptr ? frame : fileFrame(*file, frame).scene_frame.value_or(frame);
}

CameraState cameraAt(const Scene& scene, const CameraChoice& choice, int frame, double aspect) {
    if (const CameraFile* file = cameraFileOf(scene, choice)) {
        const CameraFileFrame& given = fileFrame(*file, frame);
        return {given.projection * given.view, eyeOf(given.view, given.projection)};
    }
    const CameraPose pose = poseAt(scene, choice, frame);
    const CameraFileFrame made = cameraFrame(pose, scene.camera.near, scene.camera.far, aspect);
    return {made.projection * made.view,
            pose.orthographic ? eyeOf(made.view, made.projection) : pose.eye};
}

std::array<float, 3> scaled(const std::array<float, 3>& colour, const Track<double>& intensity,
                            int frame) {
    const double factor = valueAt(intensity, frame, 1.0);
    return {float(colour[0] * factor), float(colour[1] * factor), float(colour[2] * factor)};
}

std::array<float, 3> toFloat(const glm::dvec3& v) {
    return {float(v.x), float(v.y), float(v.z)};
}

SampledLight sampledAt(const SceneLights& lights, int frame) {
    SampledLight sampled;
    sampled.sun_shadow = lights.sun_shadow;
    sampled.sun_tangent = float(det::tanDegrees(lights.sun_angle_deg / 2));
    sampled.ambient = lights.ambient_light;
    sampled.occlusion_distance = float(lights.occlusion_distance);
    for (const SceneSphere& s : lights.spheres) {
        sampled.spheres.push_back({toFloat(valueAt(s.position, frame, glm::dvec3(0))),
                                   float(s.radius), scaled(s.colour, s.intensity, frame)});
    }
    for (const SceneRectangle& r : lights.rectangles) {
        sampled.rectangles.push_back({toFloat(valueAt(r.centre, frame, glm::dvec3(0))),
                                      toFloat(r.edge_u), toFloat(r.edge_v),
                                      scaled(r.colour, r.intensity, frame)});
    }
    return sampled;
}

Lighting lightingAt(const SceneLights& lights, int frame) {
    Lighting lighting;
    lighting.ambient = scaled(lights.ambient, lights.ambient_intensity, frame);
    lighting.sun = {lights.sun.direction, scaled(lights.sun.colour, lights.sun_intensity, frame)};
    lighting.points = lights.points;
    for (size_t i = 0; i < lights.point_intensity.size(); ++i) {
        lighting.points[i].colour =
            scaled(lights.points[i].colour, lights.point_intensity[i], frame);
    }
    if (lights.sampled()) {
        lighting.sampled = sampledAt(lights, frame);
    }
    return lighting;
}

bool lightingVaries(const SceneLights& lights) {
    const auto sphere_varies = [](const SceneSphere& light) {
        return varies(light.position) || varies(light.intensity);
    };
    const auto rectangle_varies = [](const SceneRectangle& light) {
        return varies(light.centre) || varies(light.intensity);
    };
    return varies(lights.ambient_intensity) || varies(lights.sun_intensity) ||
           std::any_of(lights.point_intensity.begin(), lights.point_intensity.end(),
                       [](const Track<double>& track) { return varies(track); }) ||
           std::any_of(lights.spheres.begin(), lights.spheres.end(), sphere_varies) ||
           std::any_of(lights.rectangles.begin(), lights.rectangles.end(), rectangle_varies);
}

bool sameSun(const Lighting& a, const Lighting& b) {
    return a.sun.direction == b.sun.direction && a.sun.colour == b.sun.colour;
}

/// Of the light that surfaces' colours are made of.
bool samePlainLight(const Lighting& a, const Lighting& b) {
    const auto same_point = [](const PointLight& p, const PointLight& q) {
        return p.position == q.position && p.colour == q.colour;
    };
    return (a.sampled.ambient != AmbientLight::plain || a.ambient == b.ambient) &&
           (a.sampled.sun_shadow != SunShadow::none || sameSun(a, b)) &&
           std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                      same_point);
}

bool sameSampledLight(const Lighting& a, const Lighting& b) {
    const auto same_sphere = [](const SphereLight& p, const SphereLight& q) {
        return p.position == q.position && p.colour == q.colour;
    };
    const auto same_rectangle = [](const RectangleLight& p, const RectangleLight& q) {
        return p.centre == q.centre && p.colour == q.colour;
    };
    const SampledLight& now = a.sampled;
    const SampledLight& before = b.sampled;
    return (now.ambient == AmbientLight::plain || a.ambient == b.ambient) &&
           (now.sun_shadow == SunShadow::none || sameSun(a, b)) &&
           std::equal(now.spheres.begin(), now.spheres.end(), before.spheres.begin(),
                      before.spheres.end(), same_sphere) &&
           std::equal(now.rectangles.begin(), now.rectangles.end(), before.rectangles.begin(),
                      before.rectangles.end(), same_rectangle);
}

/// At `instant`, with the transforms of `before`; a cut has no before.
std::vector<Instance> instancesAt(const Scene& scene, int instant, int before, bool cut) {
    std::vector<Instance> instances;
    instances.reserve(scene.objects.size());
    uint32_t surface = 1;
    for (const SceneObject& object : scene.objects) {
        Instance instance;
        instance.mesh = object.mesh;
        instance.object = uint16_t(instances.size() + 1);
        instance.first_surface = uint16_t(surface);
        instance.transform = toAffine(worldTransform(object, instant));
        instance.transform_before = cut || !varies(object.tracks)
                                        ? instance.transform
                                        : toAffine(worldTransform(object, before));
        instance.identity = instance.transform == kIdentity;
        instance.moved = instance.transform != instance.transform_before;
        surface += uint32_t(scene.meshes[object.mesh].parts.size());
        instances.push_back(instance);
    }
    assert(surface - 1 <= kMaxSurfaces);
    return instances;
}

bool allTexturesRepeat(const Scene& scene, const Material& material) {
    const auto repeats = [](const auto& textures, int32_t texture) {
        return texture == kNoTexture || textures[size_t(texture)].wrap == Wrap::repeat;
    };
    return repeats(scene.textures, material.colour_texture) &&
           repeats(scene.textures, material.normal_texture) &&
           repeats(scene.alpha_textures, material.alpha_texture) &&
           repeats(scene.alpha_textures, material.height_texture);
}

/// The material that `tracks` are of, as it is in `frame`.
Material materialAt(const Scene& scene, const MaterialTracks& tracks, int frame) {
    uint32_t source = tracks.material;
    for (const MaterialSwap& swap : tracks.swaps) {
        source = swap.frame <= frame ? swap.material : source;
    }
    Material material = scene.materials[source];
    if (!tracks.offset.keys.empty()) {
        glm::dvec2 offset = glm::dvec2(double(material.u_offset), double(material.v_offset)) +
                            valueAt(tracks.offset, frame, glm::dvec2(0));
        if (allTexturesRepeat(scene, material)) {
            offset -= glm::dvec2(std::floor(offset.x), std::floor(offset.y));
        }
        material.u_offset = float(offset.x);
        material.v_offset = float(offset.y);
    }
    return material;
}

std::vector<Material> materialsAt(const Scene& scene, int frame) {
    if (scene.material_tracks.empty()) {
        return {};
    }
    std::vector<Material> materials = scene.materials;
    for (const MaterialTracks& tracks : scene.material_tracks) {
        materials[tracks.material] = materialAt(scene, tracks, frame);
    }
    return materials;
}

/// See FrameState::changed_surfaces.
std::vector<uint64_t> changedSurfaces(const Scene& scene, int instant, int before) {
    std::vector<uint8_t> changed(scene.materials.size(), 0);
    for (const MaterialTracks& tracks : scene.material_tracks) {
        changed[tracks.material] =
            materialAt(scene, tracks, instant) != materialAt(scene, tracks, before) ? 1 : 0;
    }
    if (std::find(changed.begin(), changed.end(), 1) == changed.end()) {
        return {};
    }
    std::vector<uint64_t> surfaces(surfaceCount(scene) / 64 + 1, 0);
    uint32_t surface = 1;
    for (const SceneObject& object : scene.objects) {
        for (const MeshPart& part : scene.meshes[object.mesh].parts) {
            if (changed[part.material] != 0) {
                surfaces[surface / 64] |= uint64_t{1} << (surface % 64);
            }
            ++surface;
        }
    }
    return surfaces;
}

/// True when more than the place of the instance changes.
bool turns(const Instance& instance) {
    const Affine& now = instance.transform;
    const Affine& before = instance.transform_before;
    bool same = true;
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 3; ++column) {
            same &= now[4 * row + column] == before[4 * row + column];
        }
    }
    return !same;
}

/// See FrameState::turning_surfaces.
std::vector<uint64_t> turningSurfaces(const Scene& scene, const std::vector<Instance>& instances) {
    std::vector<uint64_t> surfaces;
    for (const Instance& instance : instances) {
        if (!instance.moved || !turns(instance)) {
            continue;
        }
        surfaces.resize(surfaceCount(scene) / 64 + 1, 0);
        for (size_t part = 0; part < scene.meshes[instance.mesh].parts.size(); ++part) {
            const size_t surface = instance.first_surface + part;
            surfaces[surface / 64] |= uint64_t{1} << (surface % 64);
        }
    }
    return surfaces;
}

bool materialVaries(const Scene& scene, const MaterialTracks& tracks) {
    const Material first = materialAt(scene, tracks, 0);
    return varies(tracks.offset) ||
           std::any_of(tracks.swaps.begin(), tracks.swaps.end(), [&](const MaterialSwap& swap) {
               return swap.frame > 0 && materialAt(scene, tracks, swap.frame) != first;
           });
}

bool cameraVaries(const Scene& scene, const CameraChoice& choice) {
    if (const CameraFile* file = cameraFileOf(scene, choice)) {
        const auto& frames = file->frames;
        return std::any_of(frames.begin(), frames.end(), [&](const CameraFileFrame& frame) {
            return frame.view != frames[0].view || frame.projection != frames[0].projection ||
                   frame.jitter_fx8 != frames[0].jitter_fx8 ||
                   (frame.cut && &frame != &frames[0]) ||
                   frame.scene_frame != frames[0].scene_frame;
        });
    }
    const Camera& camera = scene.camera;
    const bool keyed = choice.view < 0 && (varies(camera.eye) || varies(camera.target) ||
                                           varies(camera.up) || varies(camera.fov_y_deg));
    return keyed || choice.orbit_deg != 0;
}

}  // namespace

CameraPose poseAt(const Scene& scene, const CameraChoice& choice, int frame) {
    CameraPose pose;
    if (choice.view >= 0) {
        assert(size_t(choice.view) < scene.views.size());
        pose = scene.views[size_t(choice.view)].pose;
    } else {
        const Camera& camera = scene.camera;
        pose.eye = valueAt(camera.eye, frame, pose.eye);
        pose.target = valueAt(camera.target, frame, pose.target);
        pose.up = valueAt(camera.up, frame, pose.up);
        pose.fov_y_deg = valueAt(camera.fov_y_deg, frame, pose.fov_y_deg);
        pose.orthographic = camera.orthographic;
    }
    if (choice.orbit_deg != 0) {
        const double turns = choice.orbit_deg * frame / (360.0 * choice.orbit_frames);
        pose.eye = pose.target + rotationAbout(unit(pose.up), turns) * (pose.eye - pose.target);
    }
    return pose;
}

const CameraFile* cameraFileOf(const Scene& scene, const CameraChoice& choice) {
    if (choice.file != nullptr) {
        return choice.file;
    }
    const bool own = scene.camera_file && choice.view < 0 && choice.orbit_deg == 0;
    return own ? &*scene.camera_file : nullptr;
}

/// The last of the scene's cuts up to an instant.
static int lastSceneCut(const Scene& scene, int instant) {
    const auto after = std::upper_bound(scene.cuts.begin(), scene.cuts.end(), instant);
    return after == scene.cuts.begin() ? 0 : std::max(0, *(after - 1));
}

static bool isCut(const Scene& scene, const CameraFile* file, int frame) {
    if (frame == 0 || (file != nullptr && size_t(frame) < file->frames.size() &&
                       file->frames[size_t(frame)].cut)) {
        return true;
    }
    return lastSceneCut(scene, instantOf(file, frame)) !=
           lastSceneCut(scene, instantOf(file, frame - 1));
}

int lastCut(const Scene& scene, const CameraChoice& choice, int frame) {
    const CameraFile* file = cameraFileOf(scene, choice);
    if (file == nullptr) {
        return lastSceneCut(scene, frame);
    }
    while (!isCut(scene, file, frame)) {
        --frame;
    }
    return frame;
}

FrameState frameStateAt(const Scene& scene, const CameraChoice& choice, int frame, int width,
                        int height) {
    assert(frame >= 0 && width > 0 && height > 0);
    const double aspect = double(width) / height;
    const CameraFile* file = cameraFileOf(scene, choice);
    FrameState state;
    state.cut = isCut(scene, file, frame);
    const int instant = instantOf(file, frame);
    const int before = state.cut ? instant : instantOf(file, frame - 1);
    state.instances = instancesAt(scene, instant, before, state.cut);
    state.turning_surfaces = turningSurfaces(scene, state.instances);
    state.lighting = lightingAt(scene.lights, instant);
    state.camera = cameraAt(scene, choice, frame, aspect);
    state.camera_before = state.cut ? state.camera : cameraAt(scene, choice, frame - 1, aspect);
    if (!state.cut) {
        const Lighting lighting_before = lightingAt(scene.lights, before);
        state.lighting_changed = !samePlainLight(state.lighting, lighting_before);
        state.sampled_light_changed = !sameSampledLight(state.lighting, lighting_before);
    }
    state.materials = materialsAt(scene, instant);
    if (!scene.material_tracks.empty() && !state.cut) {
        state.changed_surfaces = changedSurfaces(scene, instant, before);
    }
    if (file != nullptr) {
        state.jitter_fx8 = fileFrame(*file, frame).jitter_fx8;
    }
    return state;
}

std::span<const Material> materialsOf(const Scene& scene, const FrameState& state) {
    return state.materials.empty() ? scene.materials : state.materials;
}

Changes changesOf(const Scene& scene, const CameraChoice& choice) {
    Changes changes;
    changes.camera = cameraVaries(scene, choice);
    const CameraFile* file = cameraFileOf(scene, choice);
    if (file != nullptr && file->frames[0].scene_frame && !changes.camera) {
        return changes;  // all of its frames show one instant
    }
    changes.cuts =
        std::any_of(scene.cuts.begin(), scene.cuts.end(), [](int cut) { return cut > 0; });
    changes.objects = std::any_of(scene.objects.begin(), scene.objects.end(),
                                  [](const SceneObject& object) { return varies(object.tracks); });
    changes.materials =
        std::any_of(scene.material_tracks.begin(), scene.material_tracks.end(),
                    [&](const MaterialTracks& tracks) { return materialVaries(scene, tracks); });
    changes.lights = lightingVaries(scene.lights);
    return changes;
}

bool isStill(const Scene& scene, const CameraChoice& choice) {
    const Changes changes = changesOf(scene, choice);
    return !changes.objects && !changes.materials && !changes.lights && !changes.camera &&
           !changes.cuts;
}

uint32_t surfaceCount(const Scene& scene) {
    uint32_t count = 0;
    for (const SceneObject& object : scene.objects) {
        count += uint32_t(scene.meshes[object.mesh].parts.size());
    }
    return count;
}

}  // namespace still
