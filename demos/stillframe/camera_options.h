#pragma once
// The camera as the command line sees it: f3d's names, put over the scene's own camera or view.

#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "demos/stillframe/outcome.h"
#include "engine/scene.h"

namespace still::command {

struct CameraOptions {
    std::optional<glm::dvec3> up;  ///< of the world
    std::optional<glm::dvec3> position, focal_point, view_up;
    std::optional<double> view_angle_deg;  ///< vertical
    double azimuth_deg = 0, elevation_deg = 0;
    double zoom = 1;  ///< so many times as large at the focal point
    bool orthographic = false;

    /// Whether something but `up` is asked for.
    bool any() const {
        return position || focal_point || view_up || view_angle_deg || azimuth_deg != 0 ||
               elevation_deg != 0 || zoom != 1 || orthographic;
    }
};

/// "X,Y,Z", each within ±1e9.
Outcome<glm::dvec3> parsePoint(const std::string& text);
/// The same, not 0,0,0; or +X, -X, x … for an axis.
Outcome<glm::dvec3> parseDirection(const std::string& text);
/// "R,G,B" with 0 … 1, or "#rrggbb": sRGB, as f3d has it. The value is linear light.
Outcome<std::array<float, 3>> parseColour(const std::string& text);

/// Puts the options over view number `view` of the scene, or its camera if that is −1: afterwards
/// the scene's camera is the wanted one. Near and far are chosen anew. A camera file of the scene
/// gives way to an automatic camera. `aspect` = width / height.
Outcome<void> applyCamera(const CameraOptions& options, int view, int width, int height,
                          Scene& scene);

}  // namespace still::command
