#include "demos/stillframe/camera_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <string_view>
#include <vector>

#include "demos/stillframe/mode.h"
#include "engine/camera.h"
#include "engine/det_math.h"
#include "engine/load.h"

namespace still::command {
namespace {

constexpr double kMinAngleDeg = 0.001, kMaxAngleDeg = 170;

/// As in scene files: beyond it, squares of single precision overflow.
constexpr double kFarthest = 1e9;

/// Numbers between commas; nothing when a part is none, or too large.
std::optional<std::vector<double>> numbersIn(const std::string& text) {
    std::vector<double> numbers;
    for (const std::string& part : splitAtCommas(text)) {
        double value = 0;
        const char* end = part.data() + part.size();
        const auto [stop, error] = std::from_chars(part.data(), end, value);
        if (error != std::errc() || stop != end || !(std::abs(value) <= kFarthest)) {
            return std::nullopt;
        }
        numbers.push_back(value);
    }
    return text.ends_with(',') ? std::nullopt : std::optional(numbers);
}

std::optional<glm::dvec3> axisNamed(std::string_view text) {
    const double sign = text.starts_with('-') ? -1 : 1;
    if (text.starts_with('+') || text.starts_with('-')) {
        text.remove_prefix(1);
    }
    if (text.size() != 1) {
        return std::nullopt;
    }
    switch (text[0]) {
        case 'x':
        case 'X':
            return glm::dvec3(sign, 0, 0);
        case 'y':
        case 'Y':
            return glm::dvec3(0, sign, 0);
        case 'z':
        case 'Z':
            return glm::dvec3(0, 0, sign);
        default:
            return std::nullopt;
    }
}

std::optional<std::array<double, 3>> hexColour(const std::string& text) {
    if (text.size() != 7 || text[0] != '#') {
        return std::nullopt;
    }
    std::array<double, 3> colour{};
    for (size_t i = 0; i < 3; ++i) {
        int code = 0;
        const char* begin = text.data() + 1 + 2 * i;
        const auto [stop, error] = std::from_chars(begin, begin + 2, code, 16);
        if (error != std::errc() || stop != begin + 2 || code < 0) {
            return std::nullopt;
        }
        colour[i] = code / 255.0;
    }
    return colour;
}

template <class T>
bool moves(const Track<T>& track) {
    return std::any_of(track.keys.begin(), track.keys.end(),
                       [&](const auto& key) { return key.value != track.keys.front().value; });
}

template <class T>
void fix(Track<T>& track, const T& value) {
    track.keys = {{0, value}};
}

/// A track that says nothing gets the default as its only key.
template <class T>
void settle(Track<T>& track, const T& fallback) {
    if (track.keys.empty()) {
        fix(track, fallback);
    }
}

/// The angle under which things look `zoom` times as large, by halving: there is no arc tangent
/// that is the same everywhere.
double zoomedAngle(double angle_deg, double zoom) {
    const double wanted = det::tanDegrees(angle_deg / 2) / zoom;
    double low = kMinAngleDeg, high = kMaxAngleDeg;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (det::tanDegrees(middle / 2) < wanted ? low : high) = middle;
    }
    return (low + high) / 2;
}

/// Distance from `p` to the farthest corner.
double reach(const Bounds& box, const glm::dvec3& p) {
    const glm::dvec3 farthest = glm::max(glm::abs(box.min - p), glm::abs(box.max - p));
    return glm::length(farthest);
}

/// Everything of frame 0 lies between them, from wherever the camera circles its target; but what
/// is behind the eye does not if that is `within` the scene.
void chooseClipPlanes(bool within, Scene& scene) {
    Camera& camera = scene.camera;
    const Bounds box = scene.bounds(0);
    const glm::dvec3 target = camera.target.keys[0].value;
    double nearest = 1e300, farthest = 0;
    for (const auto& key : camera.eye.keys) {
        const double distance = glm::length(key.value - target);
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
    }
    const double radius = std::max(reach(box, target) * 1.01, 1e-6);
    if (camera.orthographic) {
        camera.near = within ? std::max(nearest - radius, 0.0) : nearest - radius;
        camera.far = farthest + radius;
        return;
    }
    camera.far = 2 * (farthest + radius);
    camera.near = std::max((nearest - radius) * 0.9, camera.far * 1e-4);
}

/// The camera that the options change: the view's, the scene's, or an automatic one.
void chooseBase(const CameraOptions& options, int view, int width, int height, Scene& scene) {
    Camera& camera = scene.camera;
    scene.camera_file.reset();
    if (view >= 0) {
        const CameraPose& pose = scene.views[size_t(view)].pose;
        fix(camera.eye, pose.eye);
        fix(camera.target, pose.target);
        fix(camera.up, pose.up);
        fix(camera.fov_y_deg, pose.fov_y_deg);
        camera.orthographic = pose.orthographic;
        scene.automatic_camera = false;
    }
    camera.orthographic |= options.orthographic;
    if (options.view_angle_deg) {
        fix(camera.fov_y_deg, *options.view_angle_deg);
    }
    frameForAspect(scene, width, height);
    settle(camera.eye, CameraPose{}.eye);
    settle(camera.target, CameraPose{}.target);
    settle(camera.up, CameraPose{}.up);
    settle(camera.fov_y_deg, CameraPose{}.fov_y_deg);
}

Outcome<void> circle(const CameraOptions& options, Camera& camera) {
    if (options.azimuth_deg == 0 && options.elevation_deg == 0) {
        return {};
    }
    if (moves(camera.target) || moves(camera.up)) {
        return usageError(
            "--camera-azimuth-angle, --camera-elevation-angle: the scene's camera looks elsewhere "
            "over time; expected --camera-focal-point and --camera-view-up, too");
    }
    CameraPose pose{.target = camera.target.keys[0].value, .up = camera.up.keys[0].value};
    for (auto& key : camera.eye.keys) {
        pose.eye = key.value;
        key.value = circled(pose, options.azimuth_deg, options.elevation_deg).eye;
    }
    if (camera.eye.keys.size() == 1) {  // else up stays: it would have to move along
        fix(camera.up, circled(pose, options.azimuth_deg, options.elevation_deg).up);
    }
    return {};
}

}  // namespace

Outcome<glm::dvec3> parsePoint(const std::string& text) {
    const auto numbers = numbersIn(text);
    if (!numbers || numbers->size() != 3) {
        return usageError(text + ": expected three numbers within 1e9, X,Y,Z");
    }
    return glm::dvec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

Outcome<glm::dvec3> parseDirection(const std::string& text) {
    if (const auto axis = axisNamed(text)) {
        return *axis;
    }
    const auto point = parsePoint(text);
    if (!point || !(glm::length(*point) > 1e-100)) {
        return usageError(text + ": expected an axis as +Z, or three numbers X,Y,Z that are not 0");
    }
    return *point;
}

Outcome<std::array<float, 3>> parseColour(const std::string& text) {
    std::optional<std::array<double, 3>> srgb = hexColour(text);
    const auto numbers = numbersIn(text);
    const auto fits = [](double c) { return c >= 0 && c <= 1; };
    if (numbers && numbers->size() == 3 && std::all_of(numbers->begin(), numbers->end(), fits)) {
        srgb = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
    }
    if (!srgb) {
        return usageError(text + ": expected R,G,B from 0 to 1, or #rrggbb");
    }
    return std::array{float(det::linearFromSrgb((*srgb)[0])),
                      float(det::linearFromSrgb((*srgb)[1])),
                      float(det::linearFromSrgb((*srgb)[2]))};
}

Outcome<void> applyCamera(const CameraOptions& options, int view, int width, int height,
                          Scene& scene) {
    chooseBase(options, view, width, height, scene);
    Camera& camera = scene.camera;
    if (options.position) {
        fix(camera.eye, *options.position);
    }
    if (options.focal_point) {
        fix(camera.target, *options.focal_point);
    }
    if (options.view_up) {
        fix(camera.up, *options.view_up);
    }
    const bool nowhere =
        std::any_of(camera.eye.keys.begin(), camera.eye.keys.end(),
                    [&](const auto& key) { return key.value == camera.target.keys[0].value; });
    if (nowhere) {
        return usageError("--camera-position: expected another point than the focal point");
    }
    for (auto& key : camera.fov_y_deg.keys) {
        key.value = options.zoom == 1 ? key.value : zoomedAngle(key.value, options.zoom);
    }
    const bool within = !scene.automatic_camera || options.position;
    scene.automatic_camera = false;
    return circle(options, camera).map([&] { chooseClipPlanes(within, scene); });
}

}  // namespace still::command
