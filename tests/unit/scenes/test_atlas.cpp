#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "demos/scenes/atlas.h"
#include "demos/scenes/atlas_stage.h"
#include "demos/scenes/builtin.h"
#include "engine/timeline.h"

using namespace still;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

constexpr int kWidth = 320, kHeight = 180;

/// Every scene is built once for all tests.
const std::vector<Scene>& builtScenes() {
    static const std::vector<Scene> scenes = [] {
        std::vector<Scene> built;
        for (const AtlasCase& each : atlasCases()) {
            built.push_back(each.make());
        }
        return built;
    }();
    return scenes;
}

const Scene& sceneOf(const std::string& name) {
    const AtlasCase* found = findAtlasCase(name);
    REQUIRE(found != nullptr);
    return builtScenes()[size_t(found - atlasCases().data())];
}

FrameState stateAt(const Scene& scene, int frame) {
    return frameStateAt(scene, {}, frame, kWidth, kHeight);
}

dvec2 pixelOf(const CameraState& camera, const dvec3& world) {
    const dvec4 clip = camera.view_projection * dvec4(world, 1);
    REQUIRE(clip.w > 0);
    return {clip.x / clip.w * kWidth / 2, clip.y / clip.w * kHeight / 2};
}

dvec3 apply(const Affine& m, const dvec3& p) {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3],
            m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

/// Pixels that a point of an object moves from the frame before to this one.
double speedOf(const Scene& scene, const std::string& object, const dvec3& local, int frame) {
    const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                    [&](const SceneObject& each) { return each.name == object; });
    REQUIRE(found != scene.objects.end());
    const FrameState state = stateAt(scene, frame);
    const Instance& instance = state.instances[size_t(found - scene.objects.begin())];
    return glm::length(pixelOf(state.camera, apply(instance.transform, local)) -
                       pixelOf(state.camera_before, apply(instance.transform_before, local)));
}

/// The same for a point of the world that does not move itself.
double cameraSpeed(const Scene& scene, const dvec3& world, int frame) {
    const FrameState state = stateAt(scene, frame);
    return glm::length(pixelOf(state.camera, world) - pixelOf(state.camera_before, world));
}

/// Point on the plane z = 0 at the right border of the picture, halfway up, for cameras that look
/// at the origin from the front.
dvec3 rightBorder(const Scene& scene, int frame) {
    return {kWidth / 2 / pixelOf(stateAt(scene, frame).camera, {1, 0, 0}).x, 0, 0};
}

bool hasSegment(const AtlasCase& each, const std::string& name) {
    return std::any_of(each.segments.begin(), each.segments.end(),
                       [&](const AtlasSegment& segment) { return segment.name == name; });
}

int frameCount(const AtlasSegment& segment) {
    return (segment.last - segment.first) / segment.step + 1;
}

/// What a frame shows differs from the frame before.
bool changes(const Scene& scene, int frame) {
    const FrameState now = stateAt(scene, frame);
    const bool objects = std::any_of(now.instances.begin(), now.instances.end(),
                                     [](const Instance& instance) { return instance.moved; });
    return now.cut || objects || now.lighting_changed || !now.changed_surfaces.empty() ||
           now.camera.view_projection != now.camera_before.view_projection;
}

}  // namespace

TEST_CASE("atlas: every case is named once, says what fails and by which measure",
          "[scenes][unit]") {
    const std::set<std::string> measures{
        "psnr", "ssim", "flip", "flicker", "ghost_area", "recovery_frames", "sharpness"};
    std::set<std::string> names;
    for (const AtlasCase& each : atlasCases()) {
        INFO(each.name);
        CHECK(names.insert(each.name).second);
        CHECK(each.failure.size() > 30);
        CHECK(each.failure.back() == '.');
        CHECK(measures.count(each.measure) == 1);
        CHECK(findAtlasCase(each.name) == &each);
        CHECK(sceneOf(each.name).name == "atlas-" + each.name);
        CHECK((each.measure != "recovery_frames" || each.event_frame.has_value()));
    }
    CHECK(names.size() >= 45);
    CHECK(findAtlasCase("cathedral") == nullptr);
}

TEST_CASE("atlas: scenes are found among the built-in ones, whose list stays short",
          "[scenes][unit]") {
    const Result<Scene> found = builtinScene("atlas-wires-still");
    REQUIRE(found.has_value());
    CHECK(found->name == "atlas-wires-still");
    const Result<Scene> refused = builtinScene("atlas-cathedral");
    REQUIRE(!refused.has_value());
    CHECK(refused.error().message.find("atlas-zone-plate-half") != std::string::npos);
    CHECK(builtinScene("cathedral").error().message.find("zone-plate") == std::string::npos);
}

TEST_CASE("atlas: scenes are within bounds and small", "[scenes][unit]") {
    for (const Scene& scene : builtScenes()) {
        INFO(scene.name);
        const bool courtyard = scene.name.find("courtyard") != std::string::npos;
        const bool slivers = scene.name.find("slivers") != std::string::npos;
        CHECK(scene.triangleCount() < (courtyard ? 130000u : slivers ? 101000u : 10000u));
        CHECK(surfaceCount(scene) < kMaxSurfaces);
        for (const int frame : {0, 24, 63}) {
            const Bounds bounds = scene.bounds(frame);
            REQUIRE(bounds.valid);
            for (int axis = 0; axis < 3; ++axis) {
                CHECK(std::isfinite(bounds.min[axis]));
                CHECK(std::isfinite(bounds.max[axis]));
                CHECK(bounds.max[axis] - bounds.min[axis] < 3000);
            }
        }
    }
}

TEST_CASE("atlas: segments follow each other and lie inside the frames that the tracks cover",
          "[scenes][unit]") {
    int moving_references = 0;
    for (const AtlasCase& each : atlasCases()) {
        INFO(each.name);
        REQUIRE(!each.segments.empty());
        const bool still = hasSegment(each, "still");
        int next = 0;
        for (const AtlasSegment& segment : each.segments) {
            CHECK(segment.first >= next);
            CHECK(segment.last >= segment.first);
            CHECK(segment.step >= 1);
            CHECK((still || segment.last <= scenes::atlas::kFrames));
            CHECK(segment.ssaa_samples == (still ? 1024 : 256));
            next = segment.last + 1;
            moving_references += still ? 0 : frameCount(segment);
        }
        if (each.event_frame) {
            REQUIRE(hasSegment(each, "event"));
            CHECK(each.segments.front().first <= *each.event_frame);
            CHECK(each.segments.front().last >= *each.event_frame + 8);
        }
    }
    CHECK(moving_references < 1000);
}

TEST_CASE("atlas: still scenes are still, and in the others something changes in every frame",
          "[scenes][unit]") {
    for (const AtlasCase& each : atlasCases()) {
        INFO(each.name);
        const Scene& scene = sceneOf(each.name);
        CHECK(isStill(scene, {}) == hasSegment(each, "still"));
        for (const AtlasSegment& segment : each.segments) {
            if (segment.name == "moving" && each.name != "screen") {
                for (int frame = segment.first; frame <= segment.last; ++frame) {
                    INFO(frame);
                    CHECK(changes(scene, frame));
                }
            }
        }
        if (each.event_frame && !each.resize_frame) {
            CHECK(changes(scene, *each.event_frame));
        }
    }
    CHECK(changes(sceneOf("screen"), 24));
    CHECK(!changes(sceneOf("screen"), 25));
}

TEST_CASE("atlas: events happen at the event frame and at no other", "[scenes][unit]") {
    for (const char* name : {"light-on", "light-off", "material-swap"}) {
        INFO(name);
        for (int frame = 1; frame <= 40; ++frame) {
            CHECK(changes(sceneOf(name), frame) == (frame == findAtlasCase(name)->event_frame));
        }
    }
    CHECK(sceneOf("cut").cuts == std::vector<int>{*findAtlasCase("cut")->event_frame});
}

TEST_CASE("atlas: cameras move by the pixels per frame that are stated", "[scenes][unit]") {
    struct Pan {
        const char* name;
        double speed, tolerance;
    };
    const Pan pans[] = {{"wires-pan", 1.7, 1e-6},         {"fence-pan", 2.3, 1e-6},
                        {"zone-plate-half", 0.5, 1e-6},   {"sparkle-pan", 0.7, 1e-6},
                        {"dither-pan", 0.7, 1e-6},        {"fast-pan", 60, 1e-6},
                        {"low-resolution", 0.6, 1e-6},    {"parallax-pan", 1.2369317, 1e-6},
                        {"screen-edges", 3.1064449, 1e-6}};
    for (const Pan& pan : pans) {
        for (const int frame : {1, 24, 32, 39}) {
            INFO(pan.name << " frame " << frame);
            CHECK(cameraSpeed(sceneOf(pan.name), {0.5, -0.25, 0}, frame) ==
                  Approx(pan.speed).epsilon(pan.tolerance));
        }
    }
    for (const int frame : {10, 20, 28, 38}) {
        CHECK(cameraSpeed(sceneOf("cut"), {0, 0, 0}, frame) == Approx(1).epsilon(1e-6));
    }
    CHECK(cameraSpeed(sceneOf("depth-pan"), {-0.011, -0.006, -0.02}, 30) ==
          Approx(1.1).epsilon(0.02));
    CHECK(cameraSpeed(sceneOf("depth-pan"), {0, 0, -900}, 30) < 1e-4);
}

TEST_CASE("atlas: slow pans speed up from a tenth to half a pixel per frame", "[scenes][unit]") {
    const auto middle = [](const Scene& scene, int frame) {
        const double x = scene.camera.target.keys[size_t(frame)].value.x;
        return dvec3{x, 0, scene.camera.target.keys[size_t(frame)].value.z};
    };
    for (int frame = 20; frame <= 45; ++frame) {
        INFO(frame);
        const double speed = frame <= 24 ? 0.1 : frame >= 39 ? 0.5 : 0.1 + (frame - 24) * 0.4 / 15;
        const Scene& plate = sceneOf("zone-plate-slow");
        CHECK(cameraSpeed(plate, {1, 0, 0}, frame) == Approx(speed).epsilon(1e-6));
        const Scene& checker = sceneOf("checker-slow");
        CHECK(cameraSpeed(checker, middle(checker, frame), frame) == Approx(speed).epsilon(1e-4));
        const Scene& half = sceneOf("checker-half");
        CHECK(cameraSpeed(half, middle(half, frame), frame) == Approx(0.5).epsilon(1e-4));
    }
}

TEST_CASE("atlas: objects move by the pixels per frame that are stated", "[scenes][unit]") {
    struct Mover {
        const char *name, *object;
        dvec3 point;
        double speed, tolerance;  ///< greatest one of frames 1 … 40 and of mirrored points
    };
    const Mover movers[] = {{"disocclusion", "fast box", {0, 0, 0}, 12, 1e-5},
                            {"disocclusion", "post", {0, 0, 0}, 8, 1e-5},
                            {"wires-sway", "hanging wire 0", {0.25, -8, 0}, 1.5, 0.02},
                            {"wires-sway", "spanned wire 2", {0, 0, 0}, 1, 0.02},
                            {"leaves-turn", "crown 1", {0, 0, 2.15}, 1.85, 0.05},
                            {"hdr-move", "bright bars", {0, 0, 0}, 1.3601471, 1e-5},
                            {"slivers-turn", "slivers", {2.5, 2.5, 0}, 0.617, 0.01},
                            {"rotate", "cube", {1.25, 1.25, -1.25}, 2.94, 0.02},
                            {"glass-move", "pane 0", {0, 0, 0}, 1.5, 1e-5},
                            {"glass-move", "pane 1", {0, 0, 0}, 1.5, 1e-5}};
    for (const Mover& mover : movers) {
        INFO(mover.name << ": " << mover.object);
        double fastest = 0;
        for (int k = 0; k < 8 * 40; ++k) {
            const dvec3 sign{k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1};
            const double speed =
                speedOf(sceneOf(mover.name), mover.object, mover.point * sign, 1 + k / 8);
            fastest = std::max(fastest, speed);
        }
        CHECK(fastest == Approx(mover.speed).epsilon(mover.tolerance));
    }
}

TEST_CASE("atlas: roll and zoom move the borders as stated", "[scenes][unit]") {
    const Scene &roll = sceneOf("roll"), &zoom = sceneOf("zoom");
    for (const int frame : {1, 24, 39}) {
        INFO(frame);
        CHECK(cameraSpeed(roll, {8, 0, 0}, frame) == Approx(2.79).epsilon(0.01));
        CHECK(cameraSpeed(roll, {0, 0, 0}, frame) < 1e-6);
        CHECK(cameraSpeed(zoom, {0, 0, 0}, frame) < 1e-6);
    }
    CHECK(cameraSpeed(zoom, rightBorder(zoom, 32), 32) == Approx(2.2).epsilon(0.05));
}

TEST_CASE("atlas: the courtyard pans by 4 pixels per frame at 960 × 540 and orbits evenly",
          "[scenes][unit]") {
    const Scene& pan = sceneOf("courtyard-pan");
    for (const int frame : {24, 32, 39}) {
        const dvec3 middle = pan.camera.target.keys[size_t(frame)].value;
        CHECK(cameraSpeed(pan, middle, frame) == Approx(4.0 / 3).epsilon(0.005));
    }
    const Scene& orbit = sceneOf("courtyard-orbit");
    const auto& eyes = orbit.camera.eye.keys;
    const dvec3 target = orbit.camera.target.keys.front().value;
    for (size_t frame = 1; frame < eyes.size(); ++frame) {
        const dvec2 a{eyes[frame].value.x - target.x, eyes[frame].value.z - target.z};
        const dvec2 b{eyes[frame - 1].value.x - target.x, eyes[frame - 1].value.z - target.z};
        const double cross = std::abs(a.x * b.y - a.y * b.x) / (glm::length(a) * glm::length(b));
        CHECK(std::asin(cross) * 57.29577951308232 == Approx(0.4).epsilon(1e-4));
    }
}

TEST_CASE("atlas: textures run over still surfaces at the stated pixels per frame",
          "[scenes][unit]") {
    struct Run {
        const char* name;
        size_t track;
        dvec2 speed;
        double units;  ///< that one repeat of the texture covers
    };
    const Run runs[] = {{"texture-scroll", 0, {1.5, 0}, 3.2},
                        {"texture-scroll", 1, {0.4, 0.7}, 3.2},
                        {"moving-shadow", 0, {1.2, 0.3}, 16},
                        {"moving-shadow", 2, {1.2, 0.3}, 16}};
    for (const Run& run : runs) {
        INFO(run.name << " " << run.track);
        const auto& keys = sceneOf(run.name).material_tracks[run.track].offset.keys;
        REQUIRE(keys.size() == 2);
        const dvec2 per_frame = (keys[0].value - keys[1].value) / (keys[1].frame - keys[0].frame);
        const dvec2 pixels = per_frame * (run.units / scenes::atlas::kPixel);
        CHECK(pixels.x == Approx(run.speed.x));
        CHECK(pixels.y == Approx(run.speed.y));
        CHECK(std::abs(keys[0].value.x) <= 1);  // texture coordinates keep their precision
    }
}

TEST_CASE("atlas: building a scene twice gives equal textures and tracks",
          "[scenes][determinism]") {
    for (const char* name : {"zone-plate-slow", "sparkle-pan", "screen", "noise", "slivers-turn"}) {
        INFO(name);
        const Scene again = findAtlasCase(name)->make();
        const Scene& before = sceneOf(name);
        REQUIRE(again.textures.size() == before.textures.size());
        for (size_t i = 0; i < again.textures.size(); ++i) {
            CHECK(again.textures[i].texels == before.textures[i].texels);
        }
        for (const int frame : {1, 33}) {
            const FrameState a = stateAt(again, frame), b = stateAt(before, frame);
            CHECK(a.camera.view_projection == b.camera.view_projection);
        }
        CHECK(again.meshes[0].x == before.meshes[0].x);
    }
}
