#pragma once
// All measures over the frames of one segment.

#include "demos/stillframe/cell.h"
#include "demos/stillframe/error_crop.h"
#include "postfx/metrics.h"

namespace still::command {

/// Takes the frames of one segment in order.
class SegmentMeter {
  public:
    explicit SegmentMeter(const AtlasSegment& segment) : segment_(segment) {}

    void addTime(double ms) { times_ms_.push_back(ms); }
    /// `cut`: the frame is not expected to resemble the one before.
    void compare(const CaseFrame& frame, ImageView<const Rgb8> picture, bool cut);
    /// After at least one time and one comparison. `anew`: errors of the same method started at the
    /// case's event, of the compared frames from there on; empty when there is no event here.
    Outcome<SegmentMeasures> finish(const std::vector<FrameError>& anew);

  private:
    void countGhosts(const CaseFrame& frame, ImageView<const Rgb8> picture);

    const AtlasSegment& segment_;
    SegmentMeasures sums_;
    PixelError error_;
    FlickerMeter flicker_;
    ErrorCrop crop_;
    double sharpness_sum_ = 0;
    int sharpness_count_ = 0;
    uint64_t ghosts_ = 0, revealed_ = 0, pixels_ = 0;
    std::vector<double> times_ms_;
};

}  // namespace still::command
