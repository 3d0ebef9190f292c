#pragma once
// All measures over the frames of one segment.

#include "demos/stillframe/cell.h"
#include "demos/stillframe/error_crop.h"
#include "postfx/metrics.h"

namespace still::command {

/// Root mean square of the errors of blocks of 8 × 8 pixels, each the mean of its pixels' signed
/// errors, in 8-bit codes: aliasing and noise cancel, light and colour of another time do not.
double coarseRms(ImageView<const Rgb8> picture, ImageView<const Rgb8> reference);

/// Takes the frames of one segment in order.
class SegmentMeter {
  public:
    /// `event_frame`: the case's.
    SegmentMeter(const AtlasSegment& segment, std::optional<int> event_frame)
        : segment_(segment), event_frame_(event_frame) {}

    void addTime(double ms) { times_ms_.push_back(ms); }
    /// `cut`: the frame is not expected to resemble the one before. `frame` must stay.
    void compare(const CaseFrame& frame, ImageView<const Rgb8> picture, bool cut);
    /// After at least one time and one comparison. `anew`: coarseRms() of the same method started
    /// at the case's event, of the compared frames from there on; empty when there is no event
    /// here.
    Outcome<SegmentMeasures> finish(const std::vector<double>& anew);

  private:
    void countGhosts(const CaseFrame& frame, ImageView<const Rgb8> picture);
    void measureResidual(const CaseFrame& frame, ImageView<const Rgb8> picture);

    const AtlasSegment& segment_;
    std::optional<int> event_frame_;
    ImageView<const Rgb8> before_event_{};  ///< reference
    SegmentMeasures sums_;
    PixelError error_;
    FlickerMeter flicker_;
    ErrorCrop crop_;
    double sharpness_sum_ = 0;
    int sharpness_count_ = 0;
    uint64_t ghosts_ = 0, revealed_ = 0, pixels_ = 0;
    std::vector<double> coarse_;  ///< of all frames
    std::vector<double> times_ms_;
};

}  // namespace still::command
