#pragma once
// Flat worlds with known answers: textured layers that slide, turn and grow in the picture plane,
// sampled once per pixel into a G-buffer with exact motion, ids and depth, or many times per pixel
// as a reference.

#include <array>
#include <functional>
#include <vector>

#include "rasterizer/gbuffer.h"

namespace synthetic {

using Colour = std::array<double, 3>;  ///< linear light

struct Point {
    double x = 0, y = 0;
};

/// screen = scale · R(angle) · local + offset; pixel (0, 0) has its centre at (0, 0).
struct Pose {
    Point offset;
    double angle = 0;  ///< radian
    double scale = 1;

    Point toScreen(Point local) const;
    Point toLocal(Point screen) const;
};

struct Layer {
    uint16_t surface = 0;
    double depth = 0.1;   ///< reversed Z at the local origin, larger is nearer
    Point depth_slope;    ///< relative change of depth per local unit
    uint32_t normal = 0;  ///< packed
    std::function<Pose(int frame)> pose = [](int) { return Pose{}; };
    std::function<bool(Point local)> covers = [](Point) { return true; };
    std::function<Colour(Point local)> colour = [](Point) { return Colour{0.5, 0.5, 0.5}; };
    bool moves = false;  ///< an object of its own; else it moves with the camera or not at all
};

struct World {
    int width = 0, height = 0;
    bool camera_moves = false;
    std::vector<Layer> layers;  ///< [0] covers everything
};

/// Sample offsets of frame `frame` in 1/256 pixel: a centred (0,2)-net of 64.
std::array<int, 2> jitter(int frame);

/// One jittered sample per pixel. `frame` 0 has no history. Facts are filled as the rasterizer
/// does.
void render(const World& world, int frame, still::GBuffer& out, bool with_normals = true);
/// The same with the sample positions of another frame: time and jitter apart.
void render(const World& world, int frame, std::array<int, 2> jitter_fx8, still::GBuffer& out,
            bool with_normals);

/// Mean of grid × grid samples per pixel, linear light.
std::vector<Colour> reference(const World& world, int frame, int grid);

/// Peak signal-to-noise ratio in dB of sRGB-encoded values, over pixels at least `margin` from the
/// border.
double psnr(still::ImageView<const uint16_t> red, still::ImageView<const uint16_t> green,
            still::ImageView<const uint16_t> blue, const std::vector<Colour>& wanted, int margin);

/// Textures: smooth noise of wavelength about `size`; hard squares of side `size`.
Colour noise(Point p, double size);
Colour checker(Point p, double size);

}  // namespace synthetic
