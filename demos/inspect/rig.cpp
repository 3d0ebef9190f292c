#include "demos/inspect/rig.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/camera.h"
#include "engine/det_math.h"

namespace still::inspect {
namespace {

/// The view stays this far from straight up and down: cosine of 1.8°.
constexpr double kPole = 0.9995;

struct Frame {
    glm::dvec3 right, up, forward;
};

/// The camera's axes, as the view matrix has them.
Frame frameOf(const CameraPose& pose) {
    const glm::dmat4 view = viewMatrix(pose);
    return {{view[0][0], view[1][0], view[2][0]},
            {view[0][1], view[1][1], view[2][1]},
            {-view[0][2], -view[1][2], -view[2][2]}};
}

glm::dvec3 unitOf(const glm::dvec3& v) {
    return v / std::sqrt(glm::dot(v, v));
}

/// Rodrigues' formula; the axis is of unit length.
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double turns) {
    const double cosine = det::cosTurns(turns);
    const double sine = det::sinTurns(turns);
    return v * cosine + glm::cross(axis, v) * sine + axis * (glm::dot(axis, v) * (1 - cosine));
}

/// `arm` turned around the pose's up and then towards it, unless that would pass a pole.
glm::dvec3 swing(const CameraPose& pose, const glm::dvec3& arm, double right_turns,
                 double up_turns) {
    const glm::dvec3 up = unitOf(pose.up);
    const glm::dvec3 around = turned(arm, up, right_turns);
    const glm::dvec3 side = turned(frameOf(pose).right, up, right_turns);
    const glm::dvec3 tilted = turned(around, side, up_turns);
    const double height = glm::dot(unitOf(tilted), up);
    const double height_before = glm::dot(unitOf(around), up);
    const bool towards_pole =
        std::abs(height) > kPole && std::abs(height) >= std::abs(height_before);
    const bool over_pole = glm::dot(glm::cross(tilted, up), glm::cross(around, up)) < 0;
    return towards_pole || over_pole ? around : tilted;
}

double distanceOf(const CameraPose& pose) {
    const glm::dvec3 arm = pose.target - pose.eye;
    return std::sqrt(glm::dot(arm, arm));
}

/// The field of view whose half has this tangent, by bisection.
double fovOf(double slope) {
    double low = 0, high = 179;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (det::tanDegrees(middle / 2) < slope ? low : high) = middle;
    }
    return std::clamp(low, 0.1, 170.0);
}

}  // namespace

Rig::Rig(const CameraPose& pose, double near, double far) : pose_(pose), near_(near), far_(far) {
    parallel_near_ = -far;
    parallel_far_ = far;
    if (pose.orthographic) {
        parallel_near_ = near;
        far_ = std::max(std::abs(near), std::abs(far));
        near_ = far_ * 1e-4;
    }
    if (distanceOf(pose_) == 0) {  // as the view matrix takes it
        pose_.target = pose_.eye + glm::dvec3(0, 0, -1);
    }
    if (glm::dot(pose_.up, pose_.up) == 0) {
        pose_.up = {0, 1, 0};
    }
}

Rig::Rig(const CameraFileFrame& given, const glm::dvec3& middle) {
    const glm::dmat4 to_world = glm::inverse(given.view);
    const glm::dmat4& p = given.projection;
    const glm::dvec3 forward = -unitOf(glm::dvec3(to_world[2]));
    pose_.eye = glm::dvec3(to_world[3]);
    pose_.up = unitOf(glm::dvec3(to_world[1]));
    pose_.orthographic = p[2][3] == 0;
    const double distance = std::max(glm::dot(middle - pose_.eye, forward), 1e-3);
    pose_.target = pose_.eye + forward * distance;
    const double slope = 1 / std::abs(p[1][1]) / (pose_.orthographic ? distance : 1.0);
    pose_.fov_y_deg = fovOf(slope);
    if (!pose_.orthographic && p[2][2] != 1 && p[2][2] != -1) {
        near_ = std::max(p[3][2] / (p[2][2] - 1), 1e-6);
        far_ = std::max(p[3][2] / (p[2][2] + 1), near_ * 2);
    }
}

CameraFileFrame Rig::entry(double aspect) const {
    return pose_.orthographic ? cameraFrame(pose_, parallel_near_, parallel_far_, aspect)
                              : cameraFrame(pose_, near_, far_, aspect);
}

void Rig::orbit(double right_turns, double up_turns) {
    const glm::dvec3 arm = pose_.eye - pose_.target;
    pose_.eye = pose_.target + swing(pose_, arm, right_turns, -up_turns);
}

void Rig::look(double right_turns, double up_turns) {
    const glm::dvec3 arm = pose_.target - pose_.eye;
    pose_.target = pose_.eye + swing(pose_, arm, -right_turns, up_turns);
}

void Rig::pan(double right, double up) {
    const double height = 2 * det::tanDegrees(pose_.fov_y_deg / 2) * distanceOf(pose_);
    fly(right * height, up * height, 0);
}

void Rig::dolly(double factor) {
    dollyTo(pose_.target, factor);
}

void Rig::dollyTo(const glm::dvec3& point, double factor) {
    // Eye and target shrink towards the point alike, so the direction of view stays.
    const glm::dvec3 eye = point + (pose_.eye - point) * factor;
    const glm::dvec3 target = point + (pose_.target - point) * factor;
    if (distanceOf({.eye = eye, .target = target}) > 1e-9) {
        pose_.eye = eye;
        pose_.target = target;
    }
}

void Rig::fly(double right, double up, double forward) {
    const Frame frame = frameOf(pose_);
    const glm::dvec3 step = frame.right * right + frame.up * up + frame.forward * forward;
    pose_.eye += step;
    pose_.target += step;
}

void Rig::centre(const glm::dvec3& point) {
    const glm::dvec3 arm = point - pose_.eye;
    if (glm::dot(arm, arm) > 0) {
        pose_.target = point;
    }
}

void Rig::setOrthographic(bool on) {
    pose_.orthographic = on;
}

void Rig::fitPlanes(const Bounds& bounds) {
    const glm::dvec3 reach =
        glm::max(glm::abs(bounds.min - pose_.eye), glm::abs(bounds.max - pose_.eye));
    const double farthest = std::sqrt(glm::dot(reach, reach));
    if (!bounds.valid || !(farthest > 0)) {
        return;
    }
    // In steps of two, so that the planes rest while the camera flies.
    while (far_ < farthest) {
        far_ *= 2;
    }
    while (near_ > distanceOf(pose_) / 16 && near_ > far_ * 1e-6) {
        near_ /= 2;
    }
    while (parallel_far_ < farthest || parallel_near_ > -farthest) {
        parallel_far_ = std::max(2 * parallel_far_, farthest);
        parallel_near_ = -parallel_far_;
    }
}

}  // namespace still::inspect
