#include "demos/inspect/lines.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace still::inspect {
namespace {

constexpr int kBandRows = 64;

/// Keeps of [from, to] what fulfils start + slope · t ≥ 0. False when nothing is left.
bool keep(double start, double slope, double& from, double& to) {
    if (slope == 0) {
        return start >= 0;
    }
    const double at = -start / slope;
    if (slope > 0) {
        from = std::max(from, at);
    } else {
        to = std::min(to, at);
    }
    return from < to;
}

/// A band of rows of the picture, which one task draws.
struct Band {
    ImageView<Rgb8> out;
    const LineDepth* depth;
    int begin, end;

    bool shows(int x, int y, float line_depth) const {
        return depth == nullptr || depth->shows(x * depth->width() / out.width,
                                                y * depth->height() / out.height, line_depth);
    }
    void plot(int x, int y, float line_depth, const Segment& s, float coverage) const {
        const int opacity = int(float(s.opacity) * coverage + 0.5f);
        if (x < 0 || x >= out.width || y < begin || y >= end || opacity <= 0 ||
            !shows(x, y, line_depth)) {
            return;
        }
        Rgb8& pixel = out.row(y)[x];
        pixel = blend(pixel, s.colour, opacity);
    }
    /// Steps along the longer axis; each step shares the line among two neighbours (X. Wu, "An
    /// efficient antialiasing technique", 1991).
    void draw(const Segment& s) const {
        const float dx = s.x1 - s.x0, dy = s.y1 - s.y0;
        const bool steep = std::abs(dy) > std::abs(dx);
        const float length = std::max(std::abs(dx), std::abs(dy));
        const int steps = std::max(1, int(std::ceil(length)));
        for (int i = 0; i < steps; ++i) {
            const float t = (float(i) + 0.5f) / float(steps);
            const float x = s.x0 + dx * t, y = s.y0 + dy * t;
            const float line_depth = s.depth0 + (s.depth1 - s.depth0) * t;
            const float along = steep ? y : x, across = (steep ? x : y) - 0.5f;
            const int near_pixel = int(std::floor(across)), at = int(std::floor(along));
            const float share = across - float(near_pixel);
            const int x0 = steep ? near_pixel : at, y0 = steep ? at : near_pixel;
            plot(x0, y0, line_depth, s, 1 - share);
            plot(x0 + (steep ? 1 : 0), y0 + (steep ? 0 : 1), line_depth, s, share);
        }
    }
};

}  // namespace

Rgb8 blend(Rgb8 under, Rgb8 over, int opacity) {
    const auto mix = [&](int a, int b) {
        return uint8_t((a * (255 - opacity) + b * opacity + 127) / 255);
    };
    return {mix(under.r, over.r), mix(under.g, over.g), mix(under.b, over.b)};
}

std::optional<Segment> Projection::segment(const glm::dvec4& clip0, const glm::dvec4& clip1) const {
    const glm::dvec4 step = clip1 - clip0;
    double from = 0, to = 1;
    // z ≥ −w is the near plane; the four sides are one pixel farther out than the picture.
    const double side_x = 1 + 2.0 / width_, side_y = 1 + 2.0 / height_;
    const bool left = keep(clip0.z + clip0.w, step.z + step.w, from, to) &&
                      keep(clip0.w - 1e-9, step.w, from, to) &&
                      keep(side_x * clip0.w - clip0.x, side_x * step.w - step.x, from, to) &&
                      keep(side_x * clip0.w + clip0.x, side_x * step.w + step.x, from, to) &&
                      keep(side_y * clip0.w - clip0.y, side_y * step.w - step.y, from, to) &&
                      keep(side_y * clip0.w + clip0.y, side_y * step.w + step.y, from, to);
    if (!left) {
        return std::nullopt;
    }
    const auto toPixel = [&](double t, float& x, float& y, float& depth) {
        const glm::dvec4 p = clip0 + step * t;
        x = float((p.x / p.w * 0.5 + 0.5) * width_);
        y = float((0.5 - p.y / p.w * 0.5) * height_);
        depth = float((p.w - p.z) * 0.5 / p.w);
    };
    Segment segment;
    toPixel(from, segment.x0, segment.y0, segment.depth0);
    toPixel(to, segment.x1, segment.y1, segment.depth1);
    return segment;
}

void LineDepth::take(ImageView<const uint32_t> depth, Workers& workers) {
    farthest_.resize(depth.width, depth.height);
    workers.parallelFor(depth.height, 16, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const uint32_t* rows[3] = {depth.row(std::max(y - 1, 0)), depth.row(y),
                                       depth.row(std::min(y + 1, depth.height - 1))};
            for (int x = 0; x < depth.width; ++x) {
                uint32_t farthest = rows[1][x];  // bits of floats ≥ 0 sort like the floats
                for (const uint32_t* row : rows) {
                    farthest = std::min({farthest, row[std::max(x - 1, 0)], row[x],
                                         row[std::min(x + 1, depth.width - 1)]});
                }
                farthest_.at(x, y) = std::bit_cast<float>(farthest);
            }
        }
    });
}

void drawSegments(std::span<const Segment> segments, const LineDepth* depth, ImageView<Rgb8> out,
                  Workers& workers) {
    workers.parallelFor(out.height, kBandRows, [&](int begin, int end, int) {
        const Band band{out, depth, begin, end};
        for (const Segment& s : segments) {
            if (std::max(s.y0, s.y1) + 1 >= float(begin) &&
                std::min(s.y0, s.y1) - 1 <= float(end)) {
                band.draw(s);
            }
        }
    });
}

}  // namespace still::inspect
