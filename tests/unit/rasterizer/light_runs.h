#pragma once
// Floors and walls under sampled light, for its tests.

#include <string>
#include <vector>

#include "rasterizer/light_sampler.h"
#include "tests/support/test_scene.h"

namespace still::test {

constexpr double kOne = 4096.0;  // of fx12

TestVertex cornerAt(double x, double y, double z, double nx, double ny, double nz);

/// A quad y = `height` around (x, z), its normal up.
void addFloor(TestScene& scene, double x, double z, double half, double height);

/// A floor of 40 × 40 in y = 0, no light.
TestScene floorScene();

/// From (0, 2, 4) down to the origin.
FrameView viewOfFloor(int width, int height);

/// Renders frames one after the other.
struct Sampling {
    explicit Sampling(SimdTarget target = SimdTarget::scalar) : simd(target) {}

    SimdTarget simd;
    Workers workers{1, Schedule::serial};
    LightSampler sampler;
    GBuffer gbuffer;
    LightImages light;
    LightChangeImages change;
    bool changed = false;

    void frame(TestScene& scene, const FrameView& view);
};

struct Light {
    double direct = 0, indirect = 0;
};

/// Mean of the green light at the pixel in the middle, over `samples` samples.
Light meanLight(TestScene& scene, FrameView view, int samples);

/// All of two frames of a busy scene, whose instances move between them, under its lighting.
std::vector<uint16_t> busyBytes(TestScene& scene, const FrameView& view, Workers& workers,
                                SimdTarget target);
/// Empty, or the target or scheduler whose bytes differ from those of the scalar kernels in order.
std::string differingBytes(TestScene& scene, const FrameView& view);

}  // namespace still::test
