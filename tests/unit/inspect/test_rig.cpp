// The camera that people steer.

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "demos/inspect/rig.h"
#include "engine/camera.h"

using namespace still;
using namespace still::inspect;

namespace {

CameraPose somePose() {
    return {.eye = {3, 2, 5}, .target = {0.5, 0.25, -1}, .fov_y_deg = 50};
}

double distanceOf(const CameraPose& pose) {
    return glm::length(pose.target - pose.eye);
}

/// In heights of the picture from its middle, y up.
glm::dvec2 seenAt(const Rig& rig, const glm::dvec3& point) {
    const CameraFileFrame entry = rig.entry(1);
    const glm::dvec4 clip = entry.projection * entry.view * glm::dvec4(point, 1);
    return {clip.x / clip.w / 2, clip.y / clip.w / 2};
}

bool near(double a, double b) {
    return std::abs(a - b) < 1e-9 * (1 + std::abs(b));
}

}  // namespace

TEST_CASE("rig: an orbit keeps its distance and comes back after a whole turn", "[unit][rig]") {
    Rig rig(somePose(), 0.1, 100);
    const CameraPose before = rig.pose();
    for (int i = 0; i < 16; ++i) {
        rig.orbit(1.0 / 16, i % 2 == 0 ? 0.03 : -0.03);
        CHECK(near(distanceOf(rig.pose()), distanceOf(before)));
        CHECK(rig.pose().target == before.target);
    }
    CHECK(glm::length(rig.pose().eye - before.eye) < 1e-9);
    rig.orbit(0.01, 0);
    CHECK(seenAt(Rig(before, 0.1, 100), rig.pose().eye).x > 0);  // to the right
    rig.orbit(0, 0.01);
    CHECK(rig.pose().eye.y > before.eye.y);
}

TEST_CASE("rig: neither orbit nor look goes over a pole", "[unit][rig]") {
    for (const double step : {0.01, 0.2, -0.01, -0.24}) {
        Rig orbiting(somePose(), 0.1, 100), looking(somePose(), 0.1, 100);
        for (int i = 0; i < 200; ++i) {
            orbiting.orbit(0.013, step);
            looking.look(0.013, step);
            for (const Rig* rig : {&orbiting, &looking}) {
                const glm::dmat4 view = rig->entry(1).view;
                CHECK(view[1][1] > 0);  // the camera's up still points up
            }
        }
        CHECK(looking.pose().eye == somePose().eye);
    }
}

TEST_CASE("rig: a pan moves what lies at the target by as much as it says", "[unit][rig]") {
    for (const bool orthographic : {false, true}) {
        CameraPose pose = somePose();
        pose.orthographic = orthographic;
        Rig rig(pose, 0.1, 100);
        const glm::dvec3 target = pose.target;
        rig.pan(0.25, -0.125);
        CHECK(near(seenAt(rig, target).x, -0.25));
        CHECK(near(seenAt(rig, target).y, 0.125));
    }
}

TEST_CASE("rig: a dolly towards a point keeps its place in the picture", "[unit][rig]") {
    for (const bool orthographic : {false, true}) {
        CameraPose pose = somePose();
        pose.orthographic = orthographic;
        Rig rig(pose, 0.1, 100);
        const glm::dvec3 point{1, 1, -2};
        const glm::dvec2 before = seenAt(rig, point);
        const double distance = distanceOf(pose);
        rig.dollyTo(point, 0.5);
        CHECK(near(seenAt(rig, point).x, before.x));
        CHECK(near(seenAt(rig, point).y, before.y));
        CHECK(near(distanceOf(rig.pose()), distance / 2));
    }
}

TEST_CASE("rig: what is seen at the target has the same size in parallel projection",
          "[unit][rig]") {
    Rig rig(somePose(), 0.1, 100);
    const glm::dmat4 view = rig.entry(1).view;
    const glm::dvec3 right{view[0][0], view[1][0], view[2][0]};
    const glm::dvec3 beside = rig.pose().target + right * 0.3;
    const glm::dvec2 before = seenAt(rig, beside);
    rig.setOrthographic(true);
    CHECK(near(seenAt(rig, beside).x, before.x));
    CHECK(near(seenAt(rig, beside).y, before.y));
}

TEST_CASE("rig: planes move apart until all of the scene is between them", "[unit][rig]") {
    const Bounds bounds{.min = {-20, -1, -30}, .max = {15, 8, 9}, .valid = true};
    for (const bool orthographic : {false, true}) {
        CameraPose pose = somePose();
        pose.orthographic = orthographic;
        Rig rig(pose, 0.1, 10);
        rig.dolly(7);
        rig.fitPlanes(bounds);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec4 p((corner & 1) != 0 ? bounds.max.x : bounds.min.x,
                               (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                               (corner & 4) != 0 ? bounds.max.z : bounds.min.z, 1);
            const CameraFileFrame entry = rig.entry(1.5);
            const glm::dvec4 seen = entry.view * p;
            const glm::dvec4 clip = entry.projection * seen;
            if (orthographic || seen.z < 0) {
                CHECK(clip.z <= clip.w);
            }
        }
    }
    Rig rig(somePose(), 0.1, 100);
    rig.dolly(1e-3);  // nearer to the target than the near plane was
    rig.fitPlanes(bounds);
    const CameraFileFrame entry = rig.entry(1.5);
    const glm::dvec4 clip = entry.projection * entry.view * glm::dvec4(rig.pose().target, 1);
    CHECK(clip.z >= -clip.w);
}

TEST_CASE("rig: matrices from elsewhere become the same matrices again", "[unit][rig]") {
    for (const bool orthographic : {false, true}) {
        CameraPose pose = somePose();
        pose.orthographic = orthographic;
        const CameraFileFrame given = cameraFrame(pose, 0.2, 70, 1.25);
        const Rig rig(given, {0, 0, 0});
        const CameraFileFrame again = rig.entry(1.25);
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row) {
                CHECK(again.view[column][row] == Approx(given.view[column][row]).margin(1e-9));
                if (row != 2 || !orthographic) {  // planes of a parallel projection are its own
                    CHECK(again.projection[column][row] ==
                          Approx(given.projection[column][row]).margin(1e-9));
                }
            }
        }
    }
}

TEST_CASE("rig: degenerate poses still can be steered", "[unit][rig]") {
    Rig same({.eye = {1, 1, 1}, .target = {1, 1, 1}}, 0.1, 100);
    Rig no_up({.eye = {1, 1, 1}, .target = {0, 0, 0}, .up = {0, 0, 0}}, 0.1, 100);
    Rig along({.eye = {0, 5, 0}, .target = {0, 0, 0}}, 0.1, 100);
    for (Rig* rig : {&same, &no_up, &along}) {
        rig->orbit(0.1, -0.1);
        rig->look(0.1, 0.1);
        rig->pan(0.1, 0.1);
        rig->dolly(0.5);
        rig->centre(rig->pose().eye);
        rig->fitPlanes({});
        const glm::dmat4 view = rig->entry(1).view;
        for (int i = 0; i < 16; ++i) {
            CHECK(std::isfinite(view[i / 4][i % 4]));
        }
        CHECK(std::abs(glm::determinant(view)) > 0.5);
    }
}
