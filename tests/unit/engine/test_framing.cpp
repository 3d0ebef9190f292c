#include <catch2/catch.hpp>
#include <cmath>

#include "engine/load.h"
#include "engine/shapes.h"
#include "engine/timeline.h"

using namespace still;

namespace {

Scene sceneOf(Mesh mesh) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.resize(1);
    scene.objects.resize(1);
    return scene;
}

struct Extent {
    double left = 9, right = -9, bottom = 9, top = -9;
    bool inside_depth = true;
};

/// Where frame 0's vertices land, −1 … 1 across the picture.
Extent projectedExtent(const Scene& scene, const CameraChoice& choice, int frame, int width,
                       int height) {
    const FrameState state = frameStateAt(scene, choice, frame, width, height);
    const Mesh& mesh = scene.meshes[0];
    Extent extent;
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
        const glm::dvec4 clip =
            state.camera.view_projection * glm::dvec4(mesh.x[i], mesh.y[i], mesh.z[i], 1);
        extent.left = std::min(extent.left, clip.x / clip.w);
        extent.right = std::max(extent.right, clip.x / clip.w);
        extent.bottom = std::min(extent.bottom, clip.y / clip.w);
        extent.top = std::max(extent.top, clip.y / clip.w);
        extent.inside_depth = extent.inside_depth && std::abs(clip.z) <= clip.w;
    }
    return extent;
}

}  // namespace

TEST_CASE("framing: the projected bounds fill the picture up to the margin", "[unit][framing]") {
    const glm::dvec3 directions[] = {{0.5, 0.35, 1}, {0, 0, 1}, {-3, 1, -2}, {0, 1, 0}, {0, -2, 0}};
    const Mesh shapes[] = {shapes::box(3, 0.2f, 1), shapes::torus(0.3f, 24, 8),
                           shapes::box(0.1f, 50, 0.1f)};
    for (const Mesh& shape : shapes) {
        for (const glm::dvec3& direction : directions) {
            for (const auto& [width, height] : {std::pair(640, 360), std::pair(200, 500)}) {
                Scene scene = sceneOf(shape);
                frameScene(scene, direction, double(width) / height);
                const Extent e = projectedExtent(scene, {}, 0, width, height);
                CHECK(e.inside_depth);
                CHECK(std::max(e.right, e.top) == Approx(0.9).epsilon(1e-5));
                CHECK(e.left >= -0.90001);
                CHECK(e.bottom >= -0.90001);
                const bool fills_x = e.right - e.left > 1.7999;
                const bool fills_y = e.top - e.bottom > 1.7999;
                CHECK((fills_x || fills_y));
            }
        }
    }
}

TEST_CASE("framing: an orbit keeps the object inside near and far", "[unit][framing]") {
    Scene scene = sceneOf(shapes::box(5, 1, 0.1f));
    frameScene(scene, {0, 0.1, 1}, 1.0);
    const CameraChoice orbit{.orbit_deg = 360, .orbit_frames = 16};
    for (int frame = 0; frame < 16; ++frame) {
        CHECK(projectedExtent(scene, orbit, frame, 100, 100).inside_depth);
    }
}

TEST_CASE("framing: a point and an empty scene do not break it", "[unit][framing]") {
    Mesh point;
    point.x = point.y = point.z = {4.0f};
    Scene scene = sceneOf(point);
    frameScene(scene, {0.5, 0.35, 1}, 1.5);
    const Extent e = projectedExtent(scene, {}, 0, 150, 100);
    CHECK(std::abs(e.left) < 1e-6);
    CHECK(scene.camera.near > 0);
    CHECK(scene.camera.near < scene.camera.far);
    Scene empty;
    frameScene(empty, {0, 0, 1}, 1.0);
    CHECK(empty.camera.eye.keys.empty());
}

TEST_CASE("framing: the scene's own field of view is kept", "[unit][framing]") {
    Scene scene = sceneOf(shapes::box(1, 1, 1));
    scene.camera.fov_y_deg.keys = {{0, 20}};
    frameScene(scene, {0, 0, 1}, 1.0);
    CHECK(scene.camera.fov_y_deg.keys[0].value == 20);
    CHECK(projectedExtent(scene, {}, 0, 64, 64).top == Approx(0.9));
}
