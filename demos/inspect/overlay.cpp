#include "demos/inspect/overlay.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "demos/inspect/canvas.h"

namespace still::inspect {
namespace {

constexpr Rgb8 kGridColour{220, 220, 220};
constexpr Rgb8 kEdgeColour{0, 0, 0};
constexpr Rgb8 kTileColour{0, 220, 220};
constexpr Rgb8 kArrowColour{255, 220, 0};
constexpr Rgb8 kArrowShadow{0, 0, 0};
constexpr Rgb8 kNoHistoryMark{255, 0, 0};
constexpr uint8_t kGridOpacity = 140, kEdgeOpacity = 150;
constexpr int kTileOpacity = 150;

/// 1, 2 or 5 times a power of ten: at least `size`.
double roundSize(double size) {
    double power = 1;
    while (power > size) {
        power /= 10;
    }
    while (power * 10 <= size) {
        power *= 10;
    }
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (power * factor >= size) {
            return power * factor;
        }
    }
    return power * 10;
}

double largestExtent(const Bounds& bounds) {
    const glm::dvec3 size = bounds.max - bounds.min;
    return std::max({size.x, size.y, size.z});
}

}  // namespace

void Overlay::forgetScene() {
    bounds_ = {};
    edges_.clear();
    forgetFrames();
}

const GBuffer& Overlay::centreSamples(int width, int height) {
    const int last = film_.lastFrame();
    if (probed_frame_ != last) {
        // A film that stands shows the same as before, but for what moved until then.
        const bool same = probed_frame_ >= 0 && film_.stands(probed_frame_) && film_.stands(last) &&
                          film_.sameView(probed_frame_, last);
        if (!same) {
            probe_.draw(last, width, height, {.planes = {.normal = false, .motion = true}, .lit = false});
            depth_frame_ = -1;
        }
        probed_frame_ = last;
    }
    return probe_.gbuffer();
}

void Overlay::addLine(const Projection& projection, const glm::dvec3& from, const glm::dvec3& to,
                      Rgb8 colour, uint8_t opacity) {
    if (auto segment = projection.segment(projection.toClip(from), projection.toClip(to))) {
        segment->colour = colour;
        segment->opacity = opacity;
        segments_.push_back(*segment);
    }
}

/// On the ground: y = 0, or the nearest height of the scene. As large as what is looked at.
void Overlay::addGrid(const Projection& projection, const CameraFileFrame& camera) {
    constexpr int kCells = 20;
    if (!bounds_.valid || largestExtent(bounds_) <= 0) {
        return;
    }
    const double y = std::clamp(0.0, bounds_.min.y, bounds_.max.y);
    const glm::dmat4 to_world = glm::inverse(camera.view);
    const glm::dvec3 eye(to_world[3]), forward = -glm::dvec3(to_world[2]);
    // Where the view meets the ground, or as far ahead as the eye is above it.
    const double height = std::max(std::abs(eye.y - y), largestExtent(bounds_) / 1000);
    const double steepness = std::max(std::abs(forward.y), 0.1);
    const glm::dvec3 middle = eye + forward * (height / steepness);
    const double spacing =
        roundSize(std::min(height / steepness * 2, largestExtent(bounds_)) / kCells);
    const auto snapped = [&](double v) { return std::floor(v / spacing + 0.5) * spacing; };
    const double x = snapped(middle.x), z = snapped(middle.z), reach = kCells * spacing;
    for (int i = -kCells; i <= kCells; ++i) {
        const double at = i * spacing;
        addLine(projection, {x + at, y, z - reach}, {x + at, y, z + reach}, kGridColour,
                kGridOpacity);
        addLine(projection, {x - reach, y, z + at}, {x + reach, y, z + at}, kGridColour,
                kGridOpacity);
    }
}

void Overlay::addAxes(const Projection& projection) {
    const double length = bounds_.valid ? std::max(largestExtent(bounds_) / 2, 1e-6) : 1;
    addLine(projection, glm::dvec3(0), {length, 0, 0}, {255, 60, 60}, 255);
    addLine(projection, glm::dvec3(0), {0, length, 0}, {60, 220, 60}, 255);
    addLine(projection, glm::dvec3(0), {0, 0, length}, {80, 120, 255}, 255);
}

/// Each edge once, however many triangles share it.
const std::vector<Overlay::Edge>& Overlay::edgesOf(uint32_t mesh_index) {
    edges_.resize(film_.scene.meshes.size());
    std::vector<Edge>& edges = edges_[mesh_index];
    const Mesh& mesh = film_.scene.meshes[mesh_index];
    if (!edges.empty() || mesh.indices.empty()) {
        return edges;
    }
    std::vector<uint64_t> pairs;
    pairs.reserve(mesh.indices.size());
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        for (size_t corner = 0; corner < 3; ++corner) {
            const uint64_t a = mesh.indices[i + corner], b = mesh.indices[i + (corner + 1) % 3];
            pairs.push_back(std::min(a, b) << 32 | std::max(a, b));
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    edges.reserve(pairs.size());
    for (const uint64_t pair : pairs) {
        edges.push_back({uint32_t(pair >> 32), uint32_t(pair)});
    }
    return edges;
}

/// Edges of a few pixels fade, so that fine meshes do not become black.
void Overlay::addEdges(const Projection& projection, const FrameState& state) {
    constexpr float kFullLength = 6;
    for (const Instance& instance : state.instances) {
        const Mesh& mesh = film_.scene.meshes[instance.mesh];
        const Affine& m = instance.transform;
        clip_.resize(mesh.vertexCount());
        workers_.parallelFor(int(clip_.size()), 4096, [&](int begin, int end, int) {
            for (size_t i = size_t(begin); i < size_t(end); ++i) {
                const float x = mesh.x[i], y = mesh.y[i], z = mesh.z[i];
                clip_[i] = projection.toClip({m[0] * x + m[1] * y + m[2] * z + m[3],
                                              m[4] * x + m[5] * y + m[6] * z + m[7],
                                              m[8] * x + m[9] * y + m[10] * z + m[11]});
            }
        });
        for (const Edge& edge : edgesOf(instance.mesh)) {
            if (auto s = projection.segment(clip_[edge.a], clip_[edge.b])) {
                const float length =
                    std::max(std::abs(s->x1 - s->x0), std::abs(s->y1 - s->y0)) / kFullLength;
                s->colour = kEdgeColour;
                s->opacity = uint8_t(float(kEdgeOpacity) * std::min(length, 1.0f));
                segments_.push_back(*s);
            }
        }
    }
}

void Overlay::drawTiles(int width, int height, ImageView<Rgb8> out) {
    const auto dot = [&](int x, int y) {
        Rgb8& pixel = out.row(y)[x];
        pixel = blend(pixel, kTileColour, kTileOpacity);
    };
    for (int column = kTileSize; column < width; column += kTileSize) {
        for (int y = 0; y < out.height; ++y) {
            dot(column * out.width / width, y);
        }
    }
    for (int row = kTileSize; row < height; row += kTileSize) {
        for (int x = 0; x < out.width; ++x) {
            dot(x, row * out.height / height);
        }
    }
}

/// From a point to where it was a frame ago, eight times as long as that is far.
void Overlay::drawArrows(const GBuffer& gbuffer, ImageView<Rgb8> out) {
    constexpr int kStep = 24;
    constexpr float kStretch = 8, kLongest = kStep - 3;
    std::vector<Segment> arrows;
    for (int y = kStep / 2; y < out.height; y += kStep) {
        for (int x = kStep / 2; x < out.width; x += kStep) {
            const Motion motion = gbuffer.motion.at(x * gbuffer.width() / out.width,
                                                    y * gbuffer.height() / out.height);
            if (motion.x_fx8 == kNoHistory) {
                fillRectangle(out, x - 1, y - 1, 3, 3, kNoHistoryMark);
                continue;
            }
            float dx = float(motion.x_fx8) / 256 * kStretch * float(out.width) / gbuffer.width();
            float dy = float(motion.y_fx8) / 256 * kStretch * float(out.height) / gbuffer.height();
            const float length = std::sqrt(dx * dx + dy * dy);
            if (length < 1) {
                continue;
            }
            const float shorten = std::min(1.0f, kLongest / length);
            const float px = float(x) + 0.5f, py = float(y) + 0.5f;
            const Segment line{.x0 = px,
                               .y0 = py,
                               .x1 = px + dx * shorten,
                               .y1 = py + dy * shorten,
                               .colour = kArrowColour};
            Segment shadow = line;
            shadow.x0 += 1, shadow.x1 += 1, shadow.y0 += 1, shadow.y1 += 1;
            shadow.colour = kArrowShadow;
            arrows.push_back(shadow);
            arrows.push_back(line);
            fillRectangle(out, x - 1, y - 1, 3, 3, kArrowColour);
        }
    }
    drawSegments(arrows, nullptr, out, workers_);
}

void Overlay::draw(const Overlays& wanted, int width, int height, ImageView<Rgb8> out) {
    const int last = film_.lastFrame();
    segments_.clear();
    if (wanted.grid || wanted.axes || wanted.edges) {
        const FrameState state = frameStateAt(film_.scene, film_.camera(), last, width, height);
        const Projection projection(state.camera.view_projection, out.width, out.height);
        if (!bounds_.valid) {
            bounds_ = film_.scene.bounds(0);
        }
        const GBuffer& centre = centreSamples(width, height);
        if (depth_frame_ < 0) {
            depth_.take(centre.depth.view(), workers_);
            depth_frame_ = last;
        }
        if (wanted.edges) {
            addEdges(projection, state);
        }
        if (wanted.grid) {
            addGrid(projection, film_.recording.frames[size_t(last)]);
        }
        if (wanted.axes) {
            addAxes(projection);
        }
        drawSegments(segments_, &depth_, out, workers_);
    }
    if (wanted.tiles) {
        drawTiles(width, height, out);
    }
    if (wanted.arrows) {
        drawArrows(centreSamples(width, height), out);
    }
}

}  // namespace still::inspect
