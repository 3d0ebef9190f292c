#include "demos/scenes/bench_scenes.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/det_math.h"

namespace still {
namespace {

using glm::dvec3;

/// Holds a track at its first key.
template <class T>
void hold(Track<T>& track) {
    if (!track.keys.empty()) {
        track.keys.erase(track.keys.begin() + 1, track.keys.end());
    }
}

void holdCamera(Scene& scene) {
    hold(scene.camera.eye);
    hold(scene.camera.target);
    hold(scene.camera.up);
    hold(scene.camera.fov_y_deg);
    if (scene.camera_file) {
        auto& frames = scene.camera_file->frames;
        frames.erase(frames.begin() + 1, frames.end());
    }
}

template <class T>
T firstOf(const Track<T>& track, T otherwise) {
    return track.keys.empty() ? otherwise : track.keys[0].value;
}

CameraPose firstPose(const Camera& camera) {
    const CameraPose fallback;
    return {firstOf(camera.eye, fallback.eye), firstOf(camera.target, fallback.target),
            firstOf(camera.up, fallback.up), firstOf(camera.fov_y_deg, fallback.fov_y_deg)};
}

/// Steps from the start of the path, there and back again.
double pathAt(int frame) {
    const int phase = frame % (2 * kPanTurn);
    return double(phase <= kPanTurn ? phase : 2 * kPanTurn - phase);
}

void panSideways(Scene& scene, int height) {
    const CameraPose pose = firstPose(scene.camera);
    const dvec3 forward = pose.target - pose.eye;
    const double picture_height = 2 * glm::length(forward) * det::tanDegrees(pose.fov_y_deg / 2);
    const dvec3 step =
        glm::normalize(glm::cross(forward, pose.up)) * (kPanPx * picture_height / height);
    Camera& camera = scene.camera;
    camera.eye.keys.clear();
    camera.target.keys.clear();
    for (int frame = 0; frame <= kBenchFrames; frame += kPanTurn) {
        camera.eye.keys.push_back({double(frame), pose.eye + step * pathAt(frame)});
        camera.target.keys.push_back({double(frame), pose.target + step * pathAt(frame)});
    }
}

void panAround(Scene& scene) {
    const CameraPose pose = firstPose(scene.camera);
    const dvec3 axis = glm::normalize(pose.up), arm = pose.eye - pose.target;
    const dvec3 along = axis * glm::dot(axis, arm), out = arm - along;
    const dvec3 side = glm::cross(axis, out);
    scene.camera.eye.keys.clear();
    for (int frame = 0; frame <= kBenchFrames; ++frame) {
        const double turns = pathAt(frame) * kPanDeg / 360;
        const dvec3 eye =
            pose.target + along + out * det::cosTurns(turns) + side * det::sinTurns(turns);
        scene.camera.eye.keys.push_back({double(frame), eye});
    }
}

/// Whether an object of the scene moves.
bool hasMovers(const Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& object) {
        const ObjectTracks& tracks = object.tracks;
        return tracks.translation.animated() || tracks.rotation_deg.animated() ||
               tracks.scale.animated();
    });
}

}  // namespace

const char* name(BenchMotion motion) {
    switch (motion) {
        case BenchMotion::still:
            return "still";
        case BenchMotion::pan:
            return "pan";
        case BenchMotion::objects:
            return "objects";
    }
    return "";
}

Scene frozen(Scene scene) {
    for (SceneObject& object : scene.objects) {
        hold(object.tracks.translation);
        hold(object.tracks.rotation_deg);
        hold(object.tracks.scale);
    }
    for (MaterialTracks& tracks : scene.material_tracks) {
        hold(tracks.offset);
        std::erase_if(tracks.swaps, [](const MaterialSwap& swap) { return swap.frame > 0; });
    }
    hold(scene.lights.ambient_intensity);
    hold(scene.lights.sun_intensity);
    for (Track<double>& intensity : scene.lights.point_intensity) {
        hold(intensity);
    }
    for (SceneSphere& sphere : scene.lights.spheres) {
        hold(sphere.position);
        hold(sphere.intensity);
    }
    for (SceneRectangle& rectangle : scene.lights.rectangles) {
        hold(rectangle.centre);
        hold(rectangle.intensity);
    }
    holdCamera(scene);
    scene.cuts.clear();
    return scene;
}

std::optional<Scene> benchScene(Scene scene, BenchMotion motion, int height) {
    if (motion == BenchMotion::objects) {
        if (!hasMovers(scene)) {
            return std::nullopt;
        }
        holdCamera(scene);
        scene.cuts.clear();
        return scene;
    }
    std::optional<CameraFile> cameras = scene.camera_file;
    scene = frozen(std::move(scene));
    if (motion == BenchMotion::pan && cameras) {
        scene.camera_file = std::move(cameras);
    } else if (motion == BenchMotion::pan && scene.automatic_camera) {
        panAround(scene);
    } else if (motion == BenchMotion::pan) {
        panSideways(scene, height);
    }
    return scene;
}

}  // namespace still
