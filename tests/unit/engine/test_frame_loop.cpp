#include <catch2/catch.hpp>
#include <map>

#include "engine/frame_loop.h"
#include "engine/hash.h"
#include "engine/jitter.h"
#include "engine/shapes.h"

using namespace still;

namespace {

/// A floor and a ring; with `moving` the ring turns, the camera glides, a light dims, and frame 5
/// is a cut.
Scene smallScene(bool moving) {
    Scene scene;
    scene.meshes = {shapes::plane(4, 4, 4, 4, 1), shapes::torus(0.35f, 24, 10)};
    scene.mesh_names = {"floor", "ring"};
    scene.materials.resize(2);
    scene.materials[1].diffuse = {0.9f, 0.2f, 0.1f};
    scene.materials[1].specular = {0.5f, 0.5f, 0.5f};
    scene.meshes[1].parts[0].material = 1;
    scene.objects.resize(2);
    scene.objects[1].mesh = 1;
    scene.objects[1].tracks.translation.keys = {{0, {0, 1, 0}}};
    scene.objects[1].tracks.rotation_axis = {1, 0, 0};
    scene.camera.eye.keys = {{0, {1, 2, 5}}};
    scene.camera.target.keys = {{0, {0, 0.5, 0}}};
    scene.lights.sun = {{0.0f, -0.6f, -0.8f}, {0.7f, 0.7f, 0.7f}};
    scene.background = {0.1f, 0.2f, 0.4f};
    if (moving) {
        scene.objects[1].tracks.rotation_deg.keys = {{0, 0}, {30, 360}};
        scene.camera.eye.keys.push_back({30, {2, 3, 6}});
        scene.lights.sun_intensity.keys = {{3, 1}, {4, 0.5}};
        scene.cuts = {5};
    }
    return scene;
}

FrameSettings smallSettings(AntiAliasing anti_aliasing) {
    FrameSettings settings;
    settings.width = 97;
    settings.height = 70;
    settings.anti_aliasing = anti_aliasing;
    settings.fresh_gbuffer = true;
    return settings;
}

struct Bytes {
    uint64_t output = 0, red = 0, depth = 0, id = 0;
    friend bool operator==(const Bytes&, const Bytes&) = default;
};
std::ostream& operator<<(std::ostream& stream, const Bytes& bytes) {
    return stream << hex(bytes.output) << ' ' << hex(bytes.red) << ' ' << hex(bytes.depth);
}

Bytes bytesOf(const FrameResult& result) {
    return {hashPlane(result.output), hashPlane(result.linear.red),
            hashPlane(std::as_const(result.gbuffer->depth).view()),
            hashPlane(std::as_const(result.gbuffer->id).view())};
}

std::map<int, Bytes> renderAll(const Scene& scene, const FrameSettings& settings,
                               const std::vector<int>& order,
                               Schedule schedule = Schedule::serial) {
    Workers workers(1, schedule, 7);
    FrameLoop loop(scene, settings, workers);
    std::map<int, Bytes> frames;
    for (const int frame : order) {
        frames[frame] = bytesOf(loop.render(frame));
    }
    return frames;
}

/// Sums of `count` samples by the rasterizer alone, for comparison.
Image<uint32_t> redSum(const Scene& scene, const FrameSettings& settings, uint32_t count,
                       SampleOffset (*offset)(uint32_t index, uint32_t count)) {
    const FrameState state = frameStateAt(scene, {}, 0, settings.width, settings.height);
    const DrawList list{.meshes = scene.meshes,
                        .materials = scene.materials,
                        .textures = scene.textures,
                        .alpha_textures = scene.alpha_textures,
                        .instances = state.instances,
                        .lighting = state.lighting,
                        .background = scene.background};
    Workers workers(1, Schedule::serial);
    Rasterizer rasterizer;
    GBuffer gbuffer;
    Image<uint32_t> sum(settings.width, settings.height);
    for (uint32_t i = 0; i < count; ++i) {
        const SampleOffset jitter = offset(i, count);
        const FrameView view{settings.width,
                             settings.height,
                             state.camera.view_projection,
                             state.camera.view_projection,
                             glm::vec3(state.camera.eye),
                             jitter.x_fx8,
                             jitter.y_fx8,
                             i};
        rasterizer.transformAndBin(list, view, {}, workers);
        rasterizer.rasterize(gbuffer, workers);
        for (int y = 0; y < settings.height; ++y) {
            for (int x = 0; x < settings.width; ++x) {
                sum.at(x, y) += gbuffer.red.at(x, y);
            }
        }
    }
    return sum;
}

/// Largest |mean − sum / count| in units of the plane, times count.
uint32_t largestMiss(ImageView<const uint16_t> mean, const Image<uint32_t>& sum, uint32_t count) {
    uint32_t largest = 0;
    for (int y = 0; y < mean.height; ++y) {
        for (int x = 0; x < mean.width; ++x) {
            const int64_t miss = int64_t(mean.at(x, y)) * count - sum.at(x, y);
            largest = std::max(largest, uint32_t(miss < 0 ? -miss : miss));
        }
    }
    return largest;
}

}  // namespace

TEST_CASE("frame_loop: frames in any order have the same bytes", "[unit][frame_loop]") {
    const Scene scene = smallScene(true);
    for (const AntiAliasing mode : {AntiAliasing::none, AntiAliasing::taa}) {
        const FrameSettings settings = smallSettings(mode);
        const auto in_order = renderAll(scene, settings, {0, 1, 2, 3, 4, 5, 6, 7});
        const auto any = renderAll(scene, settings, {7, 3, 4, 6, 5, 1, 2, 0});
        const auto again = renderAll(scene, settings, {4, 4, 6, 6});
        for (const auto& [frame, bytes] : in_order) {
            INFO("frame " << frame);
            CHECK(any.at(frame) == bytes);
            CHECK(bytes.output != in_order.at((frame + 1) % 8).output);
        }
        CHECK(again.at(4) == in_order.at(4));
        CHECK(again.at(6) == in_order.at(6));
    }
}

TEST_CASE("frame_loop: starting late equals the full run", "[unit][frame_loop]") {
    const Scene scene = smallScene(true);
    const FrameSettings settings = smallSettings(AntiAliasing::taa);
    const auto full = renderAll(scene, settings, {0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(renderAll(scene, settings, {3}).at(3) == full.at(3));
    CHECK(renderAll(scene, settings, {5}).at(5) == full.at(5));
    CHECK(renderAll(scene, settings, {7}).at(7) == full.at(7));
}

TEST_CASE("frame_loop: the scheduler does not show in the bytes", "[unit][frame_loop]") {
    const Scene scene = smallScene(true);
    for (const AntiAliasing mode : {AntiAliasing::taa, AntiAliasing::ssaa}) {
        FrameSettings settings = smallSettings(mode);
        settings.ssaa_samples = 4;
        const std::vector<int> order{2, 3};
        const auto serial = renderAll(scene, settings, order);
        CHECK(renderAll(scene, settings, order, Schedule::shuffled) == serial);
    }
}

TEST_CASE("frame_loop: ssaa of one sample is no anti-aliasing", "[unit][frame_loop]") {
    const Scene scene = smallScene(false);
    FrameSettings one = smallSettings(AntiAliasing::ssaa);
    one.ssaa_samples = 1;
    CHECK(renderAll(scene, one, {0}) == renderAll(scene, smallSettings(AntiAliasing::none), {0}));
}

TEST_CASE("frame_loop: ssaa is the rounded mean of its samples", "[unit][frame_loop]") {
    const Scene scene = smallScene(false);
    for (const int count : {2, 5, 16}) {
        FrameSettings settings = smallSettings(AntiAliasing::ssaa);
        settings.ssaa_samples = count;
        Workers workers(1, Schedule::serial);
        FrameLoop loop(scene, settings, workers);
        const FrameResult result = loop.render(0);
        const auto sum = redSum(scene, settings, uint32_t(count), ssaaSample);
        CHECK(2 * largestMiss(result.linear.red, sum, uint32_t(count)) <= uint32_t(count));
    }
}

TEST_CASE("frame_loop: sub-frames converge to the mean of a jitter period", "[unit][frame_loop]") {
    const Scene scene = smallScene(false);
    FrameSettings settings = smallSettings(AntiAliasing::taa);
    settings.subframes = int(kTaaPeriod);
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settings, workers);
    const FrameResult result = loop.render(0);
    const auto sum =
        redSum(scene, settings, kTaaPeriod, [](uint32_t i, uint32_t) { return taaSample(i); });
    CHECK(2 * largestMiss(result.linear.red, sum, kTaaPeriod) <= kTaaPeriod);
    CHECK(result.sample_count.at(50, 40) == kTaaPeriod);
    // As many single frames end in the same picture.
    settings.subframes = 1;
    FrameLoop single(scene, settings, workers);
    CHECK(hashPlane(single.render(63).output) == hashPlane(loop.render(0).output));
}

TEST_CASE("frame_loop: a resized loop begins anew at its next frame", "[unit][frame_loop]") {
    const Scene scene = smallScene(true);
    FrameSettings settings = smallSettings(AntiAliasing::taa);
    settings.policy.method = GENERATE(Method::gather, Method::recursive);
    int stages = 0;
    settings.clock_ms = [&stages] { return double(++stages); };
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settings, workers);
    loop.render(2);
    loop.resize(130, 40);
    stages = 0;
    std::map<int, Bytes> resized;
    resized[3] = bytesOf(loop.render(3));
    CHECK(stages == 8);  // begin and end of four stages: nothing was replayed
    resized[4] = bytesOf(loop.render(4));
    resized[6] = bytesOf(loop.render(6));

    // What was drawn before the resize, and the order after it, do not show.
    FrameLoop other(scene, settings, workers);
    other.resize(130, 40);
    CHECK(bytesOf(other.render(3)) == resized[3]);
    CHECK(bytesOf(other.render(6)) == resized[6]);
    CHECK(bytesOf(other.render(4)) == resized[4]);

    // Frames before it, and those after the next cut, are those of a loop that had the size.
    settings.width = 130;
    settings.height = 40;
    auto fresh = renderAll(scene, settings, {2, 3, 4, 6});
    CHECK(bytesOf(other.render(2)) == fresh[2]);
    CHECK(fresh[6] == resized[6]);
    CHECK_FALSE(fresh[4] == resized[4]);

    // It is a cut.
    Scene cut = scene;
    cut.cuts = {3, 5};
    fresh = renderAll(cut, settings, {3, 4});
    CHECK(fresh[3].output == resized[3].output);
    CHECK(fresh[4].output == resized[4].output);
}

TEST_CASE("frame_loop: a camera file's jitter is used and others are not", "[unit][frame_loop]") {
    const Scene scene = smallScene(false);
    const FrameState own = frameStateAt(scene, {}, 0, 97, 70);
    CameraFile file{.width = 97, .height = 70, .frames = {}, .warnings = {}};
    file.frames.resize(1);
    file.frames[0].projection = own.camera.view_projection;
    FrameSettings settings = smallSettings(AntiAliasing::taa);
    settings.camera.file = &file;
    const Bytes ours = renderAll(scene, settings, {0}).at(0);
    const SampleOffset first = taaSample(0);
    file.frames[0].jitter_fx8 = {first.x_fx8, first.y_fx8};
    CHECK(renderAll(scene, settings, {0}).at(0) == ours);
    file.frames[0].jitter_fx8 = {-first.x_fx8, first.y_fx8};
    CHECK_FALSE(renderAll(scene, settings, {0}).at(0) == ours);
}

TEST_CASE("frame_loop: requested planes exist and times are taken by the given clock",
          "[unit][frame_loop]") {
    const Scene scene = smallScene(false);
    FrameSettings settings = smallSettings(AntiAliasing::none);
    settings.planes = {.normal = true, .motion = false};
    double now_ms = 0;
    settings.clock_ms = [&now_ms] { return now_ms += 1; };
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settings, workers);
    const FrameResult result = loop.render(0);
    CHECK(result.gbuffer->planes == PlaneSet{.normal = true, .motion = false});
    CHECK(result.times.transform_bin_ms == 1);
    CHECK(result.times.raster_ms == 1);
    CHECK(result.times.taa_ms == 0);
    CHECK(result.times.output_ms == 1);
    CHECK(result.sample_count.empty());
    CHECK(loop.counters().triangles == scene.triangleCount());
}

TEST_CASE("frame_loop: ticks split the rasterizer's times by stages", "[unit][frame_loop]") {
    const Scene scene = smallScene(false);
    FrameSettings settings = smallSettings(AntiAliasing::none);
    settings.clock_ms = [now_ms = 0.0]() mutable { return now_ms += 1; };
    Workers workers(1, Schedule::serial);
    const StageTimes whole = FrameLoop(scene, settings, workers).render(0).times;
    CHECK(whole.transform_ms + whole.bin_ms + whole.visibility_ms + whole.shade_ms == 0);
    static uint64_t ticks;
    ticks = 0;
    settings.ticks = [] { return ticks += 3; };
    FrameLoop loop(scene, settings, workers);
    const StageTimes split = loop.render(0).times;
    CHECK(split.transform_ms > 0);
    CHECK(split.bin_ms > 0);
    CHECK(split.transform_ms + split.bin_ms == Approx(split.transform_bin_ms));
    CHECK(split.visibility_ms == Approx(split.raster_ms / 2));  // one tick each, in every tile
    CHECK(split.shade_ms == Approx(split.raster_ms / 2));
    const size_t tiles = loop.render(1).gbuffer->tiles.size();
    CHECK(loop.counters().ticks.visibility == 3 * tiles);
}
