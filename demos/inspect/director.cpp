#include "demos/inspect/director.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/load.h"
#include "engine/timeline.h"

namespace still::inspect {
namespace {

template <class T>
int lastKey(const Track<T>& track) {
    return track.animated() ? int(std::ceil(track.keys.back().frame)) : 0;
}

int lastOfObjects(const Scene& scene) {
    int last = 0;
    for (const SceneObject& object : scene.objects) {
        const ObjectTracks& tracks = object.tracks;
        last = std::max({last, lastKey(tracks.translation), lastKey(tracks.rotation_deg),
                         lastKey(tracks.scale)});
    }
    return last;
}

int lastOfSurroundings(const Scene& scene) {
    int last =
        std::max(lastKey(scene.lights.ambient_intensity), lastKey(scene.lights.sun_intensity));
    for (const Track<double>& point : scene.lights.point_intensity) {
        last = std::max(last, lastKey(point));
    }
    for (const MaterialTracks& tracks : scene.material_tracks) {
        last = std::max(last, lastKey(tracks.offset));
        last = tracks.swaps.empty() ? last : std::max(last, tracks.swaps.back().frame);
    }
    return last;
}

int lastOfCamera(const Scene& scene) {
    const Camera& camera = scene.camera;
    int last = std::max({lastKey(camera.eye), lastKey(camera.target), lastKey(camera.up),
                         lastKey(camera.fov_y_deg)});
    if (scene.camera_file) {
        last = std::max(last, int(scene.camera_file->frames.size()) - 1);
    }
    return scene.cuts.empty() ? last : std::max(last, scene.cuts.back());
}

glm::dvec3 middleOf(const Bounds& bounds) {
    return (bounds.min + bounds.max) * 0.5;
}

}  // namespace

int lastFrameOf(const Scene& scene) {
    return std::max({0, lastOfObjects(scene), lastOfSurroundings(scene), lastOfCamera(scene)});
}

void Director::begin(Scene& scene, double aspect, bool keep) {
    bounds_ = scene.bounds(0);
    last_scene_frame_ = lastFrameOf(scene);
    jumped_ = true;
    if (keep) {
        scene_frame_ = std::min(scene_frame_, last_scene_frame_);
    } else {
        scene_frame_ = 0;
        playing_ = false;
    }
    const Camera& camera = scene.camera;
    if (scene.automatic_camera && !camera.eye.keys.empty() && !camera.target.keys.empty()) {
        frameScene(scene, camera.eye.keys[0].value - camera.target.keys[0].value, aspect);
    }
    follows_ = follows_ || !keep;
    followScene(scene);
}

void Director::followScene(const Scene& scene) {
    if (!follows_) {
        return;
    }
    if (scene.camera_file) {
        const auto& frames = scene.camera_file->frames;
        rig_ = Rig(frames[std::min(size_t(scene_frame_), frames.size() - 1)], middleOf(bounds_));
    } else {
        rig_ = Rig(poseAt(scene, {}, scene_frame_), scene.camera.near, scene.camera.far);
    }
}

Rig& Director::steer() {
    follows_ = false;
    return rig_;
}

void Director::reset(const Scene& scene) {
    follows_ = true;
    jumped_ = true;
    followScene(scene);
}

void Director::frame(Scene& scene, const glm::dvec3& towards_eye, double aspect) {
    const Camera own = scene.camera;
    const CameraPose before = rig_.pose();
    scene.camera.fov_y_deg = {{{0, before.fov_y_deg}}};
    scene.camera.orthographic = before.orthographic;
    frameScene(scene, towards_eye, aspect, before.up);
    CameraPose pose = before;
    if (bounds_.valid) {
        pose.eye = scene.camera.eye.keys[0].value;
        pose.target = scene.camera.target.keys[0].value;
    }
    scene.camera = own;
    show(scene, pose);
}

void Director::show(const Scene& scene, const CameraPose& pose) {
    follows_ = false;
    jumped_ = true;
    rig_ = Rig(pose, scene.camera.near, scene.camera.far);
}

void Director::scrub(const Scene& scene, int frame) {
    const int wanted = std::clamp(frame, 0, last_scene_frame_);
    jumped_ |= std::abs(wanted - scene_frame_) > 1;
    scene_frame_ = wanted;
    playing_ = false;
    followScene(scene);
}

void Director::tick(const Scene& scene) {
    if (!playing_ || last_scene_frame_ == 0) {
        return;
    }
    jumped_ |= scene_frame_ == last_scene_frame_;
    scene_frame_ = scene_frame_ == last_scene_frame_ ? 0 : scene_frame_ + 1;
    followScene(scene);
}

CameraFileFrame Director::take(const Scene& scene, double aspect) {
    CameraFileFrame entry;
    if (ownMatrices(scene)) {
        const auto& frames = scene.camera_file->frames;
        entry = frames[std::min(size_t(scene_frame_), frames.size() - 1)];
    } else {
        if (!follows_) {
            rig_.fitPlanes(bounds_);
        }
        entry = rig_.entry(aspect);
    }
    entry.jitter_fx8.reset();  // it would be the same in every frame while time stands
    entry.scene_frame = scene_frame_;
    // A cut of the scene's own file is one when time arrives there, not while it stands.
    entry.cut = jumped_ || (entry.cut && scene_frame_ != taken_frame_);
    jumped_ = false;
    taken_frame_ = scene_frame_;
    return entry;
}

}  // namespace still::inspect
