#pragma once
// A supersampled picture that gets better with every call: the mean of some samples of ssaa:N, and
// in the end the very bytes of ssaa:N.

#include <cstdint>

#include "demos/inspect/probe.h"
#include "postfx/encode.h"
#include "postfx/sample_sums.h"
#include "rasterizer/image.h"

namespace still::inspect {

/// Sample that is taken at place `step` of 0 … count − 1: far apart from those before, so that any
/// number of them lies evenly in the pixel.
class ReferenceOrder {
  public:
    explicit ReferenceOrder(uint32_t count);
    uint32_t next();  ///< each of 0 … count − 1 once, then again

  private:
    uint32_t count_, bits_ = 0, step_ = 0;
};

class Reference {
  public:
    Reference(const Film& film, SimdTarget simd, Workers& workers)
        : probe_(film, simd, workers), workers_(workers) {}

    /// The film has another scene.
    void forgetScene() { probe_.forgetScene(); }
    /// The next picture is of this frame and size, and has no samples yet.
    void begin(int frame, int width, int height, int samples);
    /// Adds up to `count` samples; does nothing when the picture is complete.
    void add(int count);
    int samples() const { return done_; }
    bool complete() const { return done_ == wanted_; }
    /// Encodes the mean so far. Precondition: samples() > 0.
    ImageView<const Rgb8> encode(const OutputTable& table);
    ImageView<const Rgb8> picture() const { return output_.view(); }  ///< encoded last
    /// Of the last sample.
    const RasterCounters& counters() const { return probe_.counters(); }

  private:
    void addSample(uint32_t index);

    Probe probe_;
    Workers& workers_;
    ReferenceOrder order_{1};
    int frame_ = 0, width_ = 0, height_ = 0;
    int wanted_ = 0, done_ = 0;
    ColourSums sums_;
    Image<uint16_t> red_, green_, blue_;  ///< their mean
    Image<Rgb8> output_;
};

}  // namespace still::inspect
