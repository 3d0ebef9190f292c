#pragma once
// G-buffers full of noise for comparing kernels: surfaces in patches, motions of all kinds, depths
// that nearly agree. And random films, in which things move, stop, hide each other and change.

#include <array>
#include <cstdint>
#include <vector>

#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"

namespace random_frames {

/// Small, seeded, the same everywhere.
class Random {
  public:
    explicit Random(uint64_t seed) : state_(seed * 2654435769u + 88172645463325252u) {}
    /// 0 … bound − 1
    int below(int bound);
    bool chance(int percent) { return below(100) < percent; }

  private:
    uint64_t state_;
};

struct Options {
    int width = 64, height = 64;
    bool with_normals = true;
    bool camera_moved = true;
    int patch = 9;  ///< side of a patch of equal surface and motion
};

void fill(const Options& options, Random& random, still::GBuffer& out);

/// Frames that belong together: boxes from lines thinner than a pixel to walls, which the camera
/// and they themselves move; with every now and then a wrong or missing motion, a depth, a surface
/// or a normal from nowhere, a reset and a change of shading. Tile facts are as the rasterizer
/// gives them. Integer but for the depths, the same everywhere.
class Film {
  public:
    Film(int width, int height, bool with_normals, uint64_t seed);

    /// The next frame and what is known about it, valid until the next call.
    still::TaaFrame next(still::GBuffer& out);

  private:
    struct Box {
        uint16_t surface = 0;
        int x_fx8 = 0, y_fx8 = 0;            ///< centre
        int half_x_fx8 = 0, half_y_fx8 = 0;  ///< extent
        int own_x_fx8 = 0, own_y_fx8 = 0;    ///< own motion per frame
        int parallax_fx8 = 256;              ///< part of the camera's motion it shows
        int step_x_fx8 = 0, step_y_fx8 = 0;  ///< last frame's whole motion
        float depth = 0, slope_x = 0, slope_y = 0;
        int depth_step = 0;  ///< stored depth before minus now, while anything moves
        uint32_t normal = 0;
        int colour = 0, grain = 0;
    };

    void direct();
    void step(Box& box);
    void draw(int x, int y, const still::TaaFrame& frame, still::GBuffer& out);
    void disturb(int x, int y, still::GBuffer& out);
    void fillFacts(still::GBuffer& out);

    int width_, height_;
    bool with_normals_;
    Random random_;
    std::vector<Box> boxes_;  ///< [0] covers everything
    int camera_x_fx8_ = 0, camera_y_fx8_ = 0, zoom_ = 0;
    int noise_percent_ = 0;
    std::vector<uint8_t> moved_before_;
    std::array<uint64_t, (size_t(still::kSurfaceMask) + 1) / 64> changed_{};
};

}  // namespace random_frames
