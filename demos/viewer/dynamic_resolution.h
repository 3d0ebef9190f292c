#pragma once
// Chooses the render scale that keeps a frame rate.

namespace still::viewer {

/// A pure function of the times it is told: no clock of its own.
class DynamicResolution {
  public:
    static constexpr int kSmallest_percent = 25, kLargest_percent = 100;

    /// One frame was drawn at `scale_percent` in `frame_ms`, of which `fixed_ms` do not depend on
    /// the scale (panels, the window). Returns the scale for the next frames: the same for several
    /// frames, so that what has been accumulated is not thrown away at every frame.
    int next(int scale_percent, double frame_ms, double fixed_ms, double wanted_fps);

  private:
    double mean_ms_ = 0, mean_fixed_ms_ = 0;
    int frames_ = 0;  ///< at this scale
};

}  // namespace still::viewer
