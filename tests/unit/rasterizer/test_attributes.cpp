// Depth, normals, motion and texture coordinates of the pixels on which both rasterizers agree.

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "rasterizer/fixed.h"
#include "rasterizer/texture_layout.h"
#include "tests/support/oracle_rasterizer.h"
#include "tests/support/random_triangles.h"

using namespace still;
using namespace still::test;

namespace {

/// Vertices are snapped to 1/256 px, at most 1/512 px away in each axis; a clipped triangle's
/// corners twice.
constexpr double kSnapPx = 1.0 / 256;
/// Float vertices, relative to the nearest (largest) depth of the triangle; and a float plane
/// within a tile, as if the sample were this far off.
constexpr double kDepthBound = 3e-7;
constexpr double kDepthShiftPx = 1.0 / 65536;
/// Float interpolation, one normalization and snorm16.
constexpr double kNormalBound = 3e-4;
/// Rounding to 1/256 px, and the float arithmetic before it.
constexpr double kMotionBound_fx8 = 0.75;
/// 10-bit gamma-2 texels, 12-bit colour.
constexpr double kTexcoordBound = 2.5e-3;

struct Worst {
    double depth_bounds = 0, normal = 0, motion_fx8 = 0, texcoord = 0, depth_before = 0;
    int pixels = 0, unbounded = 0, steep = 0, no_history = 0;
    std::string first_error;

    void error(const std::string& what, int x, int y) {
        if (first_error.empty()) {
            first_error = what + " at (" + std::to_string(x) + ", " + std::to_string(y) + ")";
        }
    }
};

/// How far v is outside of the range.
double excess(const oracle::Range& range, double v) {
    return std::max({0.0, range.min - v, v - range.max});
}

double largestDepth(const oracle::Triangle& triangle) {
    double largest = 0;
    for (const oracle::Corner& corner : triangle.polygon) {
        largest = std::max(largest, corner.depth);
    }
    return largest;
}

/// Across so small a step the normal turns so far that the range's corners do not bound it.
bool isSteep(const oracle::Attributes& a) {
    return std::any_of(a.normal.begin(), a.normal.end(),
                       [](const oracle::Range& r) { return r.max - r.min > 0.1; });
}

/// Shading turns a normal towards the eye, so either sign is right.
double normalExcess(const oracle::Attributes& a, uint32_t packed) {
    const NormalVector n = decodeOctahedral(packed);
    const glm::dvec3 fast = glm::normalize(glm::dvec3(n.x, n.y, n.z));
    double same = 0, turned = 0;
    for (int k = 0; k < 3; ++k) {
        same = std::max(same, excess(a.normal[size_t(k)], fast[k]));
        turned = std::max(turned, excess(a.normal[size_t(k)], -fast[k]));
    }
    return std::min(same, turned);
}

void compareMotion(const oracle::Attributes& a, const GBuffer& fast, int x, int y, Worst& worst) {
    constexpr double kLimit_fx8 = 127.99 * kSubpixelOne;
    const Motion motion = fast.motion.at(x, y);
    const auto largest = [](const oracle::Range& r) { return std::max(-r.min, r.max); };
    const auto smallest = [](const oracle::Range& r) {
        return r.min <= 0 && r.max >= 0 ? 0 : std::min(std::abs(r.min), std::abs(r.max));
    };
    const bool may_be_out = a.behind_before || largest(a.motion_x_fx8) > kLimit_fx8 - 1 ||
                            largest(a.motion_y_fx8) > kLimit_fx8 - 1;
    const bool must_be_out = !a.behind_before && (smallest(a.motion_x_fx8) > kLimit_fx8 + 2 ||
                                                  smallest(a.motion_y_fx8) > kLimit_fx8 + 2);
    if (motion.x_fx8 == kNoHistory) {
        ++worst.no_history;
        if (!may_be_out) {
            worst.error("history is denied", x, y);
        }
        return;
    }
    if (must_be_out) {
        worst.error("motion out of range is not marked", x, y);
    } else if (!a.behind_before) {
        worst.motion_fx8 = std::max({worst.motion_fx8, excess(a.motion_x_fx8, motion.x_fx8),
                                     excess(a.motion_y_fx8, motion.y_fx8)});
        const auto steps = [](double depth) {
            return double(logDepth16(std::bit_cast<uint32_t>(float(std::max(depth, 0.0)))));
        };
        worst.depth_before = std::max(worst.depth_before,
                                      excess({steps(a.depth_before.min), steps(a.depth_before.max)},
                                             fast.depth_before.at(x, y)));
    }
}

void comparePixel(const oracle::Frame& frame, const GBuffer& fast, int x, int y, bool textured,
                  Worst& worst) {
    const int seen = int(fast.id.at(x, y) & kSurfaceMask) - 1;
    const oracle::Pixel truth = frame.visible(x, y);
    if (seen < 0 || seen != truth.triangle) {
        return;  // test_coverage.cpp decides about these
    }
    const oracle::Triangle& triangle = frame.triangles()[size_t(seen)];
    if (triangle.clipped && frame.nearCreatedEdge(triangle, x, y, 1.0 / 128)) {
        return;
    }
    ++worst.pixels;
    const double depth = std::bit_cast<float>(fast.depth.at(x, y));
    if (!triangle.clipped) {  // a clipped triangle's plane depends on how it is clipped
        const double bound =
            kDepthBound * largestDepth(triangle) + kDepthShiftPx * frame.depthSlope(triangle);
        worst.depth_bounds = std::max(worst.depth_bounds, std::abs(depth - truth.depth) / bound);
    }
    const oracle::Attributes a = frame.attributes(triangle, x, y, kSnapPx);
    if (!a.bounded) {
        ++worst.unbounded;
        return;
    }
    if (isSteep(a)) {
        ++worst.steep;
    } else {
        worst.normal = std::max(worst.normal, normalExcess(a, fast.normal.at(x, y)));
    }
    compareMotion(a, fast, x, y, worst);
    if (textured) {
        worst.texcoord =
            std::max({worst.texcoord, excess(a.u, fast.red.at(x, y) / double(kColourOne)),
                      excess(a.v, fast.green.at(x, y) / double(kColourOne))});
    }
}

void compare(TestScene& scene, const FrameView& view, bool textured, Worst& worst) {
    const DrawList list = scene.list();
    const oracle::Frame frame(list, view);
    GBuffer fast;
    draw(list, view, fast);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            comparePixel(frame, fast, x, y, textured, worst);
        }
    }
}

void check(const Worst& worst) {
    CAPTURE(worst.pixels, worst.unbounded, worst.steep, worst.no_history);
    CHECK(worst.first_error == "");
    CHECK(worst.pixels > 400);
    CHECK(worst.unbounded < worst.pixels / 20);
    CHECK(worst.depth_bounds <= 1);
    CHECK(worst.normal <= kNormalBound);
    CHECK(worst.motion_fx8 <= kMotionBound_fx8);
    CHECK(worst.depth_before <= 1);
    CHECK(worst.texcoord <= kTexcoordBound);
}

/// Red = u, green = v in linear light; a single level, so that nothing is blurred.
Texture gradientTexture() {
    constexpr uint32_t kSize = 256;
    Texture t;
    t.wrap = Wrap::clamp;
    for (uint32_t size = kSize; size > 0; size /= 2) {
        t.levels.push_back({size, size, 0, 0});
        for (uint32_t y = 0; y < size; ++y) {
            for (uint32_t x = 0; x < size; ++x) {
                const auto encode = [&](uint32_t k) {
                    return uint32_t(std::sqrt((k + 0.5) / size) * 1023 + 0.5);
                };
                t.texels.push_back(encode(x) | encode(size - 1 - y) << 10);
            }
        }
    }
    layOut(t);
    return t;
}

void texture(TestScene& scene) {
    scene.textures = {gradientTexture()};
    scene.materials[0].diffuse = {1, 1, 1};
    scene.materials[0].colour_texture = 0;
}

}  // namespace

TEST_CASE("attributes: triangles in the plane agree with the oracle", "[attributes]") {
    const FlatKind kind =
        GENERATE(FlatKind::ordinary, FlatKind::sliver, FlatKind::sub_pixel, FlatKind::on_samples);
    Random random(500 + uint64_t(kind));
    Worst worst;
    for (int round = 0; round < 25; ++round) {
        const FrameView view = flatView(128, 70, random);
        TestScene scene;
        const int count = kind == FlatKind::sub_pixel ? 400 : 20;
        for (int k = 0; k < count; ++k) {
            addFlat(scene, view, kind, random);
        }
        compare(scene, view, false, worst);
    }
    CAPTURE(int(kind));
    check(worst);
}

TEST_CASE("attributes: triangles in perspective agree with the oracle", "[attributes]") {
    const DeepKind kind =
        GENERATE(DeepKind::in_front, DeepKind::near, DeepKind::across, DeepKind::vast);
    Random random(600 + uint64_t(kind));
    Worst worst;
    for (int round = 0; round < 25; ++round) {
        const FrameView view = deepView(128, 70, random);
        TestScene scene;
        for (int k = 0; k < 10; ++k) {
            addDeep(scene, kind, random);
        }
        compare(scene, view, false, worst);
    }
    CAPTURE(int(kind));
    check(worst);
}

TEST_CASE("attributes: texture coordinates are perspective-correct", "[attributes]") {
    Random random(700);
    Worst worst;
    for (int round = 0; round < 25; ++round) {
        const FrameView view = deepView(256, 256, random);
        TestScene scene;
        texture(scene);
        // Large on the screen, so the finest level is taken and the gradient is not blurred.
        std::array<TestVertex, 3> v;
        for (size_t k = 0; k < 3; ++k) {
            const double depth = random.real(1, 4);
            const double x = (k == 1 ? 0.9 : -0.9) + random.real(-0.3, 0.3);
            const double y = (k == 2 ? 0.9 : -0.9) + random.real(-0.3, 0.3);
            v[k] = {float(x * depth / 1.5),
                    float(y * depth / 1.5),
                    float(-depth),
                    {0, 0, 1, float(random.real(0.2, 0.8)), float(random.real(0.2, 0.8))}};
        }
        scene.addTriangle(v[0], v[1], v[2]);
        compare(scene, view, true, worst);
    }
    check(worst);
}

TEST_CASE("attributes: motion of moving objects and cameras agrees with the oracle",
          "[attributes]") {
    const bool camera_moves = GENERATE(false, true);
    const bool object_moves = GENERATE(false, true);
    Random random(800);
    Worst worst;
    for (int round = 0; round < 25; ++round) {
        FrameView view = deepView(128, 70, random);
        if (camera_moves) {
            view.view_projection_before =
                view.view_projection * rigid(random.real(-0.01, 0.01), random.real(-0.1, 0.1),
                                             random.real(-0.1, 0.1), random.real(-0.3, 0.3));
        }
        TestScene scene;
        for (int object = 0; object < 3; ++object) {
            Instance& instance = scene.addMesh();
            const glm::dmat4 now = rigid(random.real(0, 1), random.real(-1, 1), 0, -4);
            instance.transform = toAffine(now);
            instance.transform_before = instance.transform;
            if (object_moves && object != 1) {
                instance.transform_before = toAffine(
                    rigid(random.real(-0.02, 0.02), random.real(-0.1, 0.1), 0.02, 0) * now);
            }
            for (int k = 0; k < 4; ++k) {
                addDeep(scene, DeepKind::across, random);
            }
        }
        compare(scene, view, false, worst);
    }
    CAPTURE(camera_moves, object_moves);
    check(worst);
}
