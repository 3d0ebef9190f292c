#pragma once
// Anti-aliased lines over a picture, hidden where something lies in front of them.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>

#include "rasterizer/gbuffer.h"
#include "rasterizer/image.h"
#include "rasterizer/workers.h"

namespace still::inspect {

/// Ends in pixels of the picture, (0, 0) is its top left corner; depth as in the G-buffer.
struct Segment {
    float x0 = 0, y0 = 0, depth0 = 0;
    float x1 = 0, y1 = 0, depth1 = 0;
    Rgb8 colour{};
    uint8_t opacity = 255;
};

/// World to the pixels of a picture.
class Projection {
  public:
    Projection(const glm::dmat4& view_projection, int width, int height)
        : clip_(view_projection), width_(width), height_(height) {}

    glm::dvec4 toClip(const glm::dvec3& world) const { return clip_ * glm::dvec4(world, 1.0); }
    /// The part before the near plane and inside the picture, if any.
    std::optional<Segment> segment(const glm::dvec4& clip0, const glm::dvec4& clip1) const;

  private:
    glm::dmat4 clip_;
    int width_, height_;
};

/// What hides lines: of each pixel the farthest depth of the 3 × 3 around it, so that lines on a
/// surface are seen at any slant.
class LineDepth {
  public:
    void take(ImageView<const uint32_t> depth, Workers& workers);
    int width() const { return farthest_.width(); }
    int height() const { return farthest_.height(); }
    /// Whether a point of a line lies before what is seen in a pixel, or on it.
    bool shows(int x, int y, float depth) const {
        constexpr float kOnSurface = 1.0f - 1.0f / 256;
        return depth >= farthest_.at(x, y) * kOnSurface;
    }

  private:
    Image<float> farthest_;
};

/// Draws in order. `depth` may be of another size than `out`; null: nothing hides.
void drawSegments(std::span<const Segment> segments, const LineDepth* depth, ImageView<Rgb8> out,
                  Workers& workers);

/// `under` with `opacity` / 255 of `over`.
Rgb8 blend(Rgb8 under, Rgb8 over, int opacity);

}  // namespace still::inspect
