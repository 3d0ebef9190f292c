#pragma once
// Flat worlds shown to the resolve frame by frame, and what its tests ask of the pictures.

#include <cstdint>
#include <functional>
#include <vector>

#include "postfx/taa.h"
#include "synthetic.h"

namespace taa_runs {

/// Stripes of noise and of hard squares.
synthetic::Colour texture(synthetic::Point p);

/// Surface 1, everywhere, resting unless it gets a pose.
synthetic::Layer backdrop();
/// Surface 2 in front of it: |x|, |y| < half_side.
synthetic::Layer square(double half_side, std::function<synthetic::Pose(int frame)> pose);

/// The whole picture moves by (x, y) a frame, as under a moving camera.
synthetic::World panning(double x, double y);
/// Nothing moves: texture and the edges of a turned square.
synthetic::World stillLife();

struct Player {
    still::Workers workers{1};
    still::Taa taa;
    still::TaaSettings settings;
    still::GBuffer gbuffer;
    bool with_normals = true;

    /// Frame 0 resets. `facts` says what else is known; its jitter is filled in.
    void show(const synthetic::World& world, int frame, still::TaaFrame facts = {});
    /// Frames first … last.
    void play(const synthetic::World& world, int first, int last);

    still::ImageView<const uint16_t> channel(int c) const;
    still::ImageView<const uint16_t> sample(int c) const;
    double error(const std::vector<synthetic::Colour>& wanted) const;
    double rawError(const std::vector<synthetic::Colour>& wanted) const;
};

std::vector<uint16_t> copyOf(still::ImageView<const uint16_t> plane);

/// All channels of the resolved picture and the sample counts.
std::vector<uint16_t> everything(const still::Taa& taa);

/// Pixels, of those that `counts` selects, in which two resolved pictures differ.
int differences(const Player& a, const Player& b, const std::function<bool(int x, int y)>& counts);

/// Integer sums of samples, the slow and obvious way.
class ExactSums {
  public:
    ExactSums(int width, int height) : width_(width), sums_(size_t(3 * width * height)) {}

    void add(const Player& player);
    int count() const { return count_; }
    /// Whether the pixel shows its samples' mean, rounded half up, in all channels.
    bool shown(const Player& player, int x, int y) const;
    int wrongPixels(const Player& player) const;

  private:
    int width_ = 0, count_ = 0;
    std::vector<uint64_t> sums_;
};

}  // namespace taa_runs
