#pragma once
// A camera that people steer. All motions are given in parts of what is seen, so that they feel the
// same at any size of scene and window. Sines and cosines come from engine/det_math.h: a script of
// motions leads to the same matrices everywhere.

#include <glm/vec3.hpp>

#include "engine/scene.h"

namespace still::inspect {

class Rig {
  public:
    Rig() = default;
    /// `near` and `far` belong to the pose's projection.
    Rig(const CameraPose& pose, double near, double far);
    /// The pose that leads to matrices from elsewhere; orbits circle a point near `middle`.
    Rig(const CameraFileFrame& given, const glm::dvec3& middle);

    const CameraPose& pose() const { return pose_; }
    /// As an entry of a camera file.
    CameraFileFrame entry(double aspect) const;

    /// Circles the target; 1 is a whole turn. Up and down ends just before the poles.
    void orbit(double right_turns, double up_turns);
    /// Turns about the eye.
    void look(double right_turns, double up_turns);
    /// Moves eye and target sideways, in heights of the picture at the target's distance.
    void pan(double right, double up);
    /// Multiplies the distance to the target; > 0, less than 1 comes nearer.
    void dolly(double factor);
    /// The same towards any point, which keeps its place in the picture.
    void dollyTo(const glm::dvec3& point, double factor);
    /// Moves eye and target along the view, in units of the world.
    void fly(double right, double up, double forward);
    /// The point that orbits circle from now on. The camera turns to it.
    void centre(const glm::dvec3& point);
    /// What is seen at the target keeps its size.
    void setOrthographic(bool on);

    /// Moves the clipping planes apart, when they must be, so that all of `bounds` is seen.
    void fitPlanes(const Bounds& bounds);

  private:
    CameraPose pose_{};
    double near_ = 0.1, far_ = 1000;  ///< perspective
    double parallel_near_ = -1000, parallel_far_ = 1000;
};

}  // namespace still::inspect
