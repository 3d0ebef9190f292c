// The spatial filter: known pictures, twins, and what it gains on the built-in scenes.

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "demos/scenes/builtin.h"
#include "engine/frame_loop.h"
#include "engine/jitter.h"
#include "engine/timeline.h"
#include "postfx/metrics.h"
#include "postfx/spatial.h"
#include "random_frames.h"

namespace {

using namespace still;

struct Picture {
    Image<uint16_t> red, green, blue;

    Picture(int width, int height)
        : red(width, height), green(width, height), blue(width, height) {}
    ColourTargets targets() { return {red.view(), green.view(), blue.view()}; }
    std::vector<uint16_t> values() const {
        std::vector<uint16_t> all;
        for (const Image<uint16_t>* plane : {&red, &green, &blue}) {
            for (int y = 0; y < plane->height(); ++y) {
                const uint16_t* row = plane->view().row(y);
                all.insert(all.end(), row, row + plane->width());
            }
        }
        return all;
    }
};

/// A G-buffer whose surface and grey value are functions of the sample's place in pixels.
GBuffer sampled(int width, int height, std::array<int, 2> jitter_fx8,
                const std::function<uint16_t(double x, double y)>& surface,
                const std::function<double(double x, double y)>& grey) {
    GBuffer out;
    out.resize(width, height, {});
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double sx = x + jitter_fx8[0] / 256.0, sy = y + jitter_fx8[1] / 256.0;
            const auto value = uint16_t(std::lround(grey(sx, sy)));
            out.red.at(x, y) = out.green.at(x, y) = out.blue.at(x, y) = value;
            out.id.at(x, y) = surface(sx, sy);
        }
    }
    return out;
}

Picture filtered(const SpatialInput& input, const SpatialSettings& settings, Workers& workers) {
    Picture out(input.colour.red.width, input.colour.red.height);
    SpatialFilter filter;
    filter.run(input, settings, out.targets(), workers);
    return out;
}

constexpr std::array<std::array<int, 2>, 4> kJitters{{{0, 0}, {54, -30}, {-128, 127}, {14, 98}}};
constexpr SpatialEdges kKinds[] = {SpatialEdges::colour, SpatialEdges::geometry};

/// Mean squared error against the exact coverage of the half plane y > a + b x in every pixel.
struct EdgeError {
    double raw = 0, filtered = 0;
};
EdgeError edgeError(double a, double b, std::array<int, 2> jitter_fx8, Workers& workers) {
    constexpr int kWidth = 96, kHeight = 48, kMargin = 8;
    const auto inside = [&](double x, double y) { return y > a + b * x; };
    const GBuffer gbuffer = sampled(
        kWidth, kHeight, jitter_fx8,
        [&](double x, double y) { return uint16_t(inside(x, y) ? 2 : 1); },
        [&](double x, double y) { return inside(x, y) ? 4096.0 : 0.0; });
    const Picture out = filtered(spatialInput(gbuffer, jitter_fx8[0], jitter_fx8[1]), {}, workers);
    EdgeError error;
    for (int y = kMargin; y < kHeight - kMargin; ++y) {
        for (int x = kMargin; x < kWidth - kMargin; ++x) {
            int hits = 0;
            for (int i = 0; i < 256; ++i) {
                hits += inside(x + (i % 16 - 7.5) / 16, y + (i / 16 - 7.5) / 16) ? 1 : 0;
            }
            const double wanted = hits / 256.0;
            const double bare = inside(x, y) ? 1 : 0;
            error.raw += (bare - wanted) * (bare - wanted);
            error.filtered += std::pow(out.red.at(x, y) / 4096.0 - wanted, 2);
        }
    }
    return error;
}

/// First frames of built-in scenes: errors of the bare sample and of the filtered one.
struct Gain {
    double raw_db = 0, filtered_db = 0;
};
Gain firstFrame(const std::string& name, SampleOffset offset, Workers& workers) {
    constexpr int kWidth = 320, kHeight = 180;
    const Scene scene = *builtinScene(name);
    const FrameState state = frameStateAt(scene, {}, 0, kWidth, kHeight);
    const DrawList list{.meshes = scene.meshes,
                        .materials = scene.materials,
                        .textures = scene.textures,
                        .alpha_textures = scene.alpha_textures,
                        .instances = state.instances,
                        .lighting = state.lighting,
                        .background = scene.background};
    FrameView view;
    view.width = kWidth;
    view.height = kHeight;
    view.view_projection = view.view_projection_before = state.camera.view_projection;
    view.eye = glm::vec3(state.camera.eye);
    view.jitter_x_fx8 = offset.x_fx8;
    view.jitter_y_fx8 = offset.y_fx8;
    Rasterizer rasterizer;
    GBuffer gbuffer;
    rasterizer.transformAndBin(list, view, {.planes = {.normal = true}}, workers);
    rasterizer.rasterize(gbuffer, workers);
    Picture out = filtered(spatialInput(gbuffer, offset.x_fx8, offset.y_fx8), {}, workers);

    FrameLoop reference(scene,
                        {.width = kWidth,
                         .height = kHeight,
                         .anti_aliasing = AntiAliasing::ssaa,
                         .ssaa_samples = 64},
                        workers);
    const FrameResult wanted = reference.render(0);
    const OutputTable table;
    const auto against = [&](const ColourPlanes& colour) {
        Image<Rgb8> encoded(kWidth, kHeight);
        encodeOutput(colour, table, encoded.view(), workers);
        return psnrDb(pixelError(std::as_const(encoded).view(), wanted.output));
    };
    const ColourTargets to = out.targets();
    return {against({gbuffer.red.view(), gbuffer.green.view(), gbuffer.blue.view()}),
            against({to.red, to.green, to.blue})};
}

}  // namespace

TEST_CASE("spatial: every SIMD target equals the scalar twin on random frames", "[postfx][unit]") {
    Workers workers(1);
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 9}, {67, 40}, {130, 3}, {16, 70}}) {
        for (uint64_t seed = 1; seed <= 8; ++seed) {
            random_frames::Random random(seed);
            GBuffer gbuffer;
            random_frames::fill({.width = width,
                                 .height = height,
                                 .with_normals = seed % 2 == 0,
                                 .patch = 1 + random.below(20)},
                                random, gbuffer);
            const std::array<int, 2> jitter = kJitters[seed % 4];
            const SpatialInput input = spatialInput(gbuffer, jitter[0], jitter[1]);
            for (SpatialEdges edges : kKinds) {
                const auto wanted =
                    filtered(input, {.edges = edges, .simd = SimdTarget::scalar}, workers).values();
                for (SimdTarget target : availableSimdTargets()) {
                    INFO(name(target) << " " << width << "x" << height << " seed " << seed);
                    CHECK(filtered(input, {.edges = edges, .simd = target}, workers).values() ==
                          wanted);
                }
            }
        }
    }
}

TEST_CASE("spatial: single pixels equal those of the whole frame", "[postfx][unit]") {
    Workers workers(1);
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        random_frames::Random random(seed);
        GBuffer gbuffer;
        random_frames::fill({.width = 70, .height = 41, .patch = 6}, random, gbuffer);
        const SpatialInput input = spatialInput(gbuffer, 54, -30);
        const Picture wanted = filtered(input, {}, workers);
        int different = 0;
        for (int y = 0; y < 41; ++y) {
            for (int x = 0; x < 70; ++x) {
                int rgb[3];
                spatialPixel(input, x, y, rgb);
                different += rgb[0] != wanted.red.at(x, y) || rgb[1] != wanted.green.at(x, y) ||
                             rgb[2] != wanted.blue.at(x, y);
            }
        }
        CHECK(different == 0);
    }
}

TEST_CASE("spatial: threads and schedules do not change a bit", "[postfx][determinism]") {
    random_frames::Random random(5);
    GBuffer gbuffer;
    random_frames::fill({.width = 200, .height = 150, .patch = 7}, random, gbuffer);
    const SpatialInput input = spatialInput(gbuffer, 14, 98);
    for (SpatialEdges edges : kKinds) {
        Workers one(1);
        const auto wanted = filtered(input, {.edges = edges}, one).values();
        for (const auto& [threads, schedule] :
             {std::pair{3, Schedule::pooled}, {1, Schedule::serial}, {1, Schedule::shuffled}}) {
            Workers workers(threads, schedule, 9);
            CHECK(filtered(input, {.edges = edges}, workers).values() == wanted);
        }
    }
}

TEST_CASE("spatial: one colour stays one colour, whatever the surfaces", "[postfx][unit]") {
    Workers workers(1);
    for (const auto& jitter : kJitters) {
        const GBuffer gbuffer = sampled(
            90, 50, jitter,
            [](double x, double y) { return uint16_t(1 + (int(x * y) % 7 == 0) + (x > y)); },
            [](double, double) { return 2500.0; });
        for (SpatialEdges edges : kKinds) {
            const Picture out =
                filtered(spatialInput(gbuffer, jitter[0], jitter[1]), {.edges = edges}, workers);
            const auto values = out.values();
            CHECK(std::all_of(values.begin(), values.end(), [](int v) { return v == 2500; }));
        }
    }
}

TEST_CASE("spatial: a ramp within a surface comes out as at the pixels' centres",
          "[postfx][unit]") {
    Workers workers(1);
    const auto ramp = [](double x, double y) { return 500 + 24 * x + 40 * y; };
    for (const auto& jitter : kJitters) {
        const GBuffer gbuffer = sampled(
            60, 40, jitter, [](double, double) { return uint16_t(3); }, ramp);
        const Picture out = filtered(spatialInput(gbuffer, jitter[0], jitter[1]), {}, workers);
        double worst = 0;
        for (int y = 1; y < 39; ++y) {
            for (int x = 1; x < 59; ++x) {
                worst = std::max(worst, std::abs(out.red.at(x, y) - ramp(x, y)));
            }
        }
        CHECK(worst <= 1.5);
    }
}

TEST_CASE("spatial: the colour filter leaves faint contrasts alone", "[postfx][unit]") {
    Workers workers(1);
    const GBuffer gbuffer = sampled(
        40, 40, {0, 0}, [](double x, double) { return uint16_t(x > 20 ? 2 : 1); },
        [](double x, double) { return x > 20 ? 2000.0 : 1950.0; });
    const Picture out =
        filtered(spatialInput(gbuffer, 0, 0), {.edges = SpatialEdges::colour}, workers);
    for (int x = 0; x < 40; ++x) {
        CHECK(out.red.at(x, 20) == gbuffer.red.at(x, 20));
    }
}

TEST_CASE("spatial: a long edge through pixel borders stays sharp", "[postfx][unit]") {
    Workers workers(1);
    const GBuffer gbuffer = sampled(
        40, 40, {0, 0}, [](double, double y) { return uint16_t(y > 19.5 ? 2 : 1); },
        [](double, double y) { return y > 19.5 ? 4096.0 : 0.0; });
    const Picture out = filtered(spatialInput(gbuffer, 0, 0), {}, workers);
    for (int x = 0; x < 40; ++x) {
        CHECK(out.red.at(x, 19) == 0);
        CHECK(out.red.at(x, 20) == 4096);
    }
}

TEST_CASE("spatial: straight edges of all slopes lose most of their error", "[postfx][unit]") {
    Workers workers(1);
    for (const auto& jitter : {kJitters[0], kJitters[1], kJitters[3]}) {
        for (double slope : {0.05, -0.1, 0.21, 0.33, -0.47, 0.7, 1.0}) {
            EdgeError sum;
            for (int i = 0; i < 8; ++i) {
                const EdgeError one =
                    edgeError(24.13 + i / 8.0 - 48 * slope, slope, jitter, workers);
                sum.raw += one.raw;
                sum.filtered += one.filtered;
            }
            INFO("slope " << slope << " jitter " << jitter[0] << " " << jitter[1]);
            // Runs of one or two pixels say little: at 45° no filter can do better than 0.44.
            CHECK(sum.filtered < (std::abs(slope) < 0.4 ? 0.5 : 0.75) * sum.raw);
        }
    }
}

TEST_CASE("spatial: creases are edges, bumps are not", "[postfx][unit]") {
    Workers workers(1);
    const auto lower = [](double x, double y) { return y > 12.2 + 0.15 * x; };
    GBuffer gbuffer = sampled(
        64, 40, {0, 0}, [](double, double) { return uint16_t(1); },
        [&](double x, double y) { return lower(x, y) ? 3000.0 : 1000.0; });
    const Picture blind = filtered(spatialInput(gbuffer, 0, 0), {}, workers);
    gbuffer.resize(64, 40, {.normal = true});
    random_frames::Random random(4);
    const auto changed = [&](const auto& normal) {
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 64; ++x) {
                gbuffer.normal.at(x, y) = normal(x, y);
            }
        }
        const Picture out = filtered(spatialInput(gbuffer, 0, 0), {}, workers);
        int pixels = 0;
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 64; ++x) {
                pixels += out.red.at(x, y) != blind.red.at(x, y) ? 1 : 0;
            }
        }
        return pixels;
    };
    CHECK(changed([&](int x, int y) { return lower(x, y) ? 0x7fffu : 0x7fff0000u; }) > 64);
    const int bumpy = changed([&](int, int) {
        return uint32_t(random.below(20000)) << 16 | uint32_t(random.below(20000));
    });
    CHECK(bumpy < 200);  // by chance one step in twenty is much larger than its neighbours
}

TEST_CASE("spatial: corners of upright boxes lose an eighth of a pixel at most", "[postfx][unit]") {
    Workers workers(1);
    const auto inside = [](double x, double y) {
        return x > 9.5 && x < 40.5 && y > 9.5 && y < 24.5;
    };
    const GBuffer gbuffer = sampled(
        50, 36, {0, 0}, [&](double x, double y) { return uint16_t(inside(x, y) ? 2 : 1); },
        [&](double x, double y) { return inside(x, y) ? 4096.0 : 0.0; });
    const Picture out = filtered(spatialInput(gbuffer, 0, 0), {}, workers);
    for (int x = 12; x < 38; ++x) {
        CHECK(out.red.at(x, 10) >= 4096 - 512);
        CHECK(out.red.at(x, 9) == 0);
    }
}

TEST_CASE("spatial: a first frame gains 3 dB on every scene it was made for",
          "[postfx][stability]") {
    Workers workers(2);
    for (const char* name : {"courtyard", "wires", "fence", "checker", "cubes"}) {
        for (const SampleOffset offset : {SampleOffset{}, taaSample(0)}) {
            const Gain gain = firstFrame(name, offset, workers);
            INFO(name << ": " << gain.raw_db << " -> " << gain.filtered_db);
            CHECK(gain.filtered_db >= gain.raw_db + 3.0);
        }
    }
}
