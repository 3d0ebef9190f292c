// Automatic camera: the closest eye from which all vertices project inside the picture's margins.
// In the camera's basis (side, up, forward) a vertex (a, b, c) is inside the frustum of slopes
// ± t around an eye (ex, ey, ez) when |a − ex| ≤ t (c − ez). The tightest such planes are four
// maxima over the vertices, and the eye follows from them in closed form.

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/det_math.h"
#include "engine/internal/tracks.h"
#include "engine/load.h"

namespace still {
namespace {

constexpr double kMargin = 0.05;  // of the picture's width and height, on each side
constexpr double kDefaultFovDeg = 40;

struct Basis {
    glm::dvec3 side, up, forward;
    glm::dvec3 camera_up;  ///< what the camera is given, and an orbit turns around
    glm::dvec3 toWorld(const glm::dvec3& p) const { return side * p.x + up * p.y + forward * p.z; }
    glm::dvec3 toCamera(const glm::dvec3& p) const {
        return {glm::dot(side, p), glm::dot(up, p), glm::dot(forward, p)};
    }
};

Basis basisTowards(const glm::dvec3& direction, const glm::dvec3& world_up) {
    const glm::dvec3 forward = -unit(direction);
    const double steepness = glm::dot(forward, world_up);
    const bool vertical = steepness > 0.999 || steepness < -0.999;
    const bool along_z = world_up.z > 0.9 || world_up.z < -0.9;
    const glm::dvec3 ahead = along_z ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    const glm::dvec3 side = unit(glm::cross(forward, vertical ? ahead : world_up));
    const glm::dvec3 up = glm::cross(side, forward);
    return {side, up, forward, vertical ? up : world_up};
}

/// Calls visit(world position) for every vertex of frame 0.
template <class Visit>
void forEachVertex(const Scene& scene, Visit&& visit) {
    for (const SceneObject& object : scene.objects) {
        const glm::dmat4 world = worldTransform(object, 0);
        const Mesh& mesh = scene.meshes[object.mesh];
        for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
            visit(glm::dvec3(world * glm::dvec4(mesh.x[i], mesh.y[i], mesh.z[i], 1)));
        }
    }
}

/// The four planes that bound the vertices, and their box in the camera basis.
struct Silhouette {
    static constexpr double kFar = std::numeric_limits<double>::max();
    double right = -kFar, left = -kFar, top = -kFar, bottom = -kFar;
    glm::dvec3 min{kFar}, max{-kFar};

    void add(const glm::dvec3& p, double slope_x, double slope_y) {
        right = std::max(right, p.x - slope_x * p.z);
        left = std::max(left, -p.x - slope_x * p.z);
        top = std::max(top, p.y - slope_y * p.z);
        bottom = std::max(bottom, -p.y - slope_y * p.z);
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    bool empty() const { return min.x > max.x; }
};

}  // namespace

void frameScene(Scene& scene, glm::dvec3 direction, double aspect, glm::dvec3 up) {
    const Basis basis = basisTowards(direction, unit(up));
    const double fov_deg = valueAt(scene.camera.fov_y_deg, 0, kDefaultFovDeg);
    const double slope_y = det::tanDegrees(fov_deg / 2) * (1 - 2 * kMargin);
    const double slope_x = slope_y * aspect;
    Camera& camera = scene.camera;
    Silhouette outline;
    forEachVertex(scene,
                  [&](const glm::dvec3& p) { outline.add(basis.toCamera(p), slope_x, slope_y); });
    if (outline.empty()) {
        return;
    }
    // A scene thinner than this (a single point, a line towards the eye) gets a little distance.
    const double size = std::max(lengthOf(outline.max - outline.min), 1e-6);
    const glm::dvec3 middle = (outline.min + outline.max) * 0.5;
    glm::dvec3 eye{
        (outline.right - outline.left) / 2, (outline.top - outline.bottom) / 2,
        std::min({-(outline.right + outline.left) / (2 * slope_x),
                  -(outline.top + outline.bottom) / (2 * slope_y), outline.min.z - 0.002 * size})};
    if (camera.orthographic) {  // what the box fills at the target, wherever the eye then is
        const double half_width = (outline.max.x - outline.min.x) / 2;
        const double half_height = (outline.max.y - outline.min.y) / 2;
        const double distance =
            std::max({half_width / slope_x, half_height / slope_y, 0.002 * size});
        eye = {middle.x, middle.y, middle.z - distance};
    }
    const glm::dvec3 target{eye.x, eye.y, middle.z};
    // From the farthest vertex, seen from the target: an orbit around it stays inside.
    double radius = 0;
    forEachVertex(scene, [&](const glm::dvec3& p) {
        radius = std::max(radius, lengthOf(basis.toCamera(p) - target));
    });
    const double distance = target.z - eye.z;
    camera.eye = {{{0, basis.toWorld(eye)}}};
    camera.target = {{{0, basis.toWorld(target)}}};
    camera.up = {{{0, basis.camera_up}}};
    camera.fov_y_deg = {{{0, fov_deg}}};
    camera.far = (distance + radius) * 1.01;
    camera.near = std::max((distance - radius) * 0.9, camera.far * 1e-4);
    if (camera.orthographic) {
        camera.near = distance - radius * 1.01;
        camera.far = distance + radius * 1.01;
    }
}

void frameForAspect(Scene& scene, int width, int height) {
    const Camera& camera = scene.camera;
    // An empty scene has no camera keys.
    if (scene.automatic_camera && !camera.eye.keys.empty() && !camera.target.keys.empty()) {
        frameScene(scene, camera.eye.keys[0].value - camera.target.keys[0].value,
                   double(width) / height, valueAt(camera.up, 0, glm::dvec3(0, 1, 0)));
    }
}

}  // namespace still
