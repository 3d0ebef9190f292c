#include "engine/camera.h"

#include <glm/geometric.hpp>

#include "engine/det_math.h"
#include "engine/internal/tracks.h"

namespace still {

glm::dmat4 viewMatrix(const CameraPose& pose) {
    glm::dvec3 forward = pose.target - pose.eye;
    forward = lengthOf(forward) > 0 ? unit(forward) : glm::dvec3(0, 0, -1);
    glm::dvec3 side = glm::cross(forward, pose.up);
    if (!(lengthOf(side) > 1e-9 * lengthOf(pose.up))) {
        const bool along_z = forward.z > 0.9 || forward.z < -0.9;
        side = glm::cross(forward, along_z ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1));
    }
    side = unit(side);
    const glm::dvec3 up = glm::cross(side, forward);
    return {glm::dvec4(side.x, up.x, -forward.x, 0), glm::dvec4(side.y, up.y, -forward.y, 0),
            glm::dvec4(side.z, up.z, -forward.z, 0),
            glm::dvec4(-glm::dot(side, pose.eye), -glm::dot(up, pose.eye),
                       glm::dot(forward, pose.eye), 1)};
}

glm::dmat4 perspectiveMatrix(double fov_y_deg, double aspect, double near, double far) {
    const double zoom = 1 / det::tanDegrees(fov_y_deg / 2);
    glm::dmat4 projection(0.0);
    projection[0][0] = zoom / aspect;
    projection[1][1] = zoom;
    projection[2][2] = (far + near) / (near - far);
    projection[2][3] = -1;
    projection[3][2] = 2 * far * near / (near - far);
    return projection;
}

glm::dmat4 orthographicMatrix(double half_height, double aspect, double near, double far) {
    glm::dmat4 projection(1.0);
    projection[0][0] = 1 / (half_height * aspect);
    projection[1][1] = 1 / half_height;
    projection[2][2] = 1 / (near - far);
    projection[3][2] = far / (near - far);
    return projection;
}

CameraPose circled(const CameraPose& pose, double azimuth_deg, double elevation_deg) {
    const glm::dvec3 up = unit(pose.up);
    const glm::dmat3 around = rotationAbout(up, azimuth_deg / 360);
    const glm::dvec3 back = around * (pose.eye - pose.target);
    CameraPose result = pose;
    result.eye = pose.target + back;
    if (elevation_deg == 0) {
        return result;
    }
    const glm::dmat4 view = viewMatrix(result);
    const glm::dvec3 side(view[0][0], view[1][0], view[2][0]);
    const glm::dmat3 upwards = rotationAbout(side, -elevation_deg / 360);
    result.eye = pose.target + upwards * back;
    result.up = upwards * glm::dvec3(view[0][1], view[1][1], view[2][1]);
    return result;
}

CameraFileFrame cameraFrame(const CameraPose& pose, double near, double far, double aspect) {
    CameraFileFrame frame;
    frame.view = viewMatrix(pose);
    if (!pose.orthographic) {
        frame.projection = perspectiveMatrix(pose.fov_y_deg, aspect, near, far);
        return frame;
    }
    const double distance = lengthOf(pose.target - pose.eye);
    const double slope = det::tanDegrees(pose.fov_y_deg / 2);
    frame.projection =
        orthographicMatrix((distance > 0 ? distance : 1.0) * slope, aspect, near, far);
    return frame;
}

}  // namespace still
