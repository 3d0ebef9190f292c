#pragma once
// Where the camera stands and which instant of the scene it sees: the next entry of the recording.

#include "demos/inspect/rig.h"
#include "engine/scene.h"

namespace still::inspect {

/// Of the last key, swap or cut of a scene; 0 when nothing happens.
int lastFrameOf(const Scene& scene);

class Director {
  public:
    /// Forgets everything but, when asked to, rig and time.
    void begin(Scene& scene, double aspect, bool keep);

    const Rig& rig() const { return rig_; }
    Rig& steer();
    bool follows() const { return follows_; }
    void reset(const Scene& scene);
    void frame(Scene& scene, const glm::dvec3& towards_eye, double aspect);
    void show(const Scene& scene, const CameraPose& pose);

    bool playing() const { return playing_; }
    void play(bool on) { playing_ = on; }
    void scrub(const Scene& scene, int frame);
    int sceneFrame() const { return scene_frame_; }
    int lastSceneFrame() const { return last_scene_frame_; }

    /// One frame on, while playing.
    void tick(const Scene& scene);
    /// What the next frame sees; a cut where camera or time have jumped since the last call.
    CameraFileFrame take(const Scene& scene, double aspect);

  private:
    void followScene(const Scene& scene);
    bool ownMatrices(const Scene& scene) const { return follows_ && scene.camera_file.has_value(); }

    Rig rig_;
    Bounds bounds_{};
    bool follows_ = true;
    bool playing_ = false;
    bool jumped_ = true;
    int scene_frame_ = 0, last_scene_frame_ = 0;
    int taken_frame_ = -1;  ///< what the last take() saw
};

}  // namespace still::inspect
