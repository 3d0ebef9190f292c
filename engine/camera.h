#pragma once
// Poses to matrices, and camera files out: for programs whose camera is moved by hand. They give
// each frame that they draw an entry of a CameraFile, which CameraChoice::file points to and which
// may grow between frames, so that what was seen can be rendered again, byte for byte.

#include <string>

#include "engine/scene.h"

namespace still {

/// World to camera space, looking along −z. A pose whose target is its eye looks along −z; an `up`
/// along the view is replaced by +y, or by +z where that lies along it, too.
glm::dmat4 viewMatrix(const CameraPose& pose);

/// OpenGL: z = −near is mapped to −w, z = −far to w. 0 < fov_y_deg < 180, aspect = width / height,
/// 0 < near < far.
glm::dmat4 perspectiveMatrix(double fov_y_deg, double aspect, double near, double far);

/// CameraPose::orthographic: z = −near is mapped to −1 and z = −far to 0, half way to 1. Reversed Z
/// is then 0.5 … 1 between them, one power of two, in which logDepth16 has even steps, as a depth
/// that is linear needs them. half_height > 0 is half of what the picture shows; near < far, of any
/// sign.
glm::dmat4 orthographicMatrix(double half_height, double aspect, double near, double far);

/// The pose after its eye has circled its target: by `azimuth_deg` about up, counter-clockwise as
/// up sees it, then by `elevation_deg` towards up, which tilts up along. Target ≠ eye.
CameraPose circled(const CameraPose& pose, double azimuth_deg, double elevation_deg);

/// View and projection, as the timeline would make them of the same pose.
CameraFileFrame cameraFrame(const CameraPose& pose, double near, double far, double aspect);

/// What loadCameraFile() reads back as the same numbers.
std::string cameraFileText(const CameraFile& cameras);

}  // namespace still
