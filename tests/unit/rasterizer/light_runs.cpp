#include "tests/unit/rasterizer/light_runs.h"

#include <cmath>

using namespace still;

namespace still::test {

TestVertex cornerAt(double x, double y, double z, double nx, double ny, double nz) {
    return {float(x), float(y), float(z), {float(nx), float(ny), float(nz), 0, 0}};
}

void addFloor(TestScene& scene, double x, double z, double half, double height) {
    scene.addQuad({cornerAt(x - half, height, z + half, 0, 1, 0),
                   cornerAt(x + half, height, z + half, 0, 1, 0),
                   cornerAt(x + half, height, z - half, 0, 1, 0),
                   cornerAt(x - half, height, z - half, 0, 1, 0)});
}

TestScene floorScene() {
    TestScene scene;
    scene.lighting = {};
    scene.addMesh();
    addFloor(scene, 0, 0, 20, 0);
    return scene;
}

FrameView viewOfFloor(int width, int height) {
    FrameView view;
    view.width = width;
    view.height = height;
    const double s = 1 / std::sqrt(5.0);  // right, up, back of the camera in rows
    glm::dmat4 camera(1.0);
    camera[1] = {0, 2 * s, s, 0};
    camera[2] = {0, -s, 2 * s, 0};
    camera[3] = {0, 0, -2 / s, 1};
    view.view_projection = perspective(4.0, double(width) / height, 0.1, 100) * camera;
    view.view_projection_before = view.view_projection;
    view.eye = glm::vec3(0, 2, 4);
    return view;
}

void Sampling::frame(TestScene& scene, const FrameView& view) {
    const DrawList list = scene.list();
    draw(list, view, gbuffer, {.simd = simd, .planes = kAllPlanes});
    sampler.setUp(list, view, simd, workers);
    changed = sampler.changes(change, workers);
    sampler.sample(gbuffer, light, true, workers);
}

Light meanLight(TestScene& scene, FrameView view, int samples) {
    Sampling run;
    Light mean;
    for (int i = 0; i < samples; ++i) {
        view.sample = uint32_t(i);
        run.frame(scene, view);
        const int x = view.width / 2, y = view.height / 2;
        mean.direct += run.light.direct_green.at(x, y) / kOne / samples;
        mean.indirect += run.light.indirect_green.at(x, y) / kOne / samples;
    }
    return mean;
}

std::vector<uint16_t> busyBytes(TestScene& scene, const FrameView& view, Workers& workers,
                                SimdTarget target) {
    const DrawList list = scene.list();
    GBuffer gbuffer;
    draw(list, view, gbuffer);
    LightSampler sampler;
    LightImages light;
    LightChangeImages change;
    std::vector<uint16_t> all;
    for (int i = 0; i < 2; ++i) {
        sampler.setUp(list, view, target, workers);
        sampler.changes(change, workers);
        sampler.sample(gbuffer, light, true, workers);
        for (const auto* plane : {&light.direct_red, &light.direct_blue, &light.indirect_red,
                                  &light.indirect_blue, &change.direct_before, &change.direct_now,
                                  &change.indirect_before, &change.indirect_now, &gbuffer.red}) {
            for (int y = 0; y < plane->height(); ++y) {
                const uint16_t* row = plane->view().row(y);
                all.insert(all.end(), row, row + plane->width());
            }
        }
    }
    return all;
}

std::string differingBytes(TestScene& scene, const FrameView& view) {
    Workers serial(1, Schedule::serial), three(3), shuffled(1, Schedule::shuffled, 1);
    const std::vector<uint16_t> expected = busyBytes(scene, view, serial, SimdTarget::scalar);
    for (SimdTarget target : availableSimdTargets()) {
        if (busyBytes(scene, view, serial, target) != expected) {
            return std::string(name(target));
        }
    }
    if (busyBytes(scene, view, three, bestSimdTarget()) != expected) {
        return "three threads";
    }
    return busyBytes(scene, view, shuffled, bestSimdTarget()) != expected ? "shuffled" : "";
}

}  // namespace still::test
