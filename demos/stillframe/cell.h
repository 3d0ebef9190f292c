#pragma once
// One cell of the atlas: one way of anti-aliasing, measured over the segments of one case.

#include <optional>
#include <string>
#include <vector>

#include "demos/scenes/atlas.h"
#include "demos/stillframe/mode.h"
#include "demos/stillframe/options.h"
#include "demos/stillframe/reference_cache.h"

namespace still::command {

/// PSNR of pictures that are equal or nearly so, so that it can be averaged and compared.
constexpr double kBestPsnrDb = 100;

/// An event has had so many frames when its residual is measured …
constexpr int kResidualFrames = 3;
/// … and a case is run so many times with other random numbers for its trails.
constexpr int kTrailRuns = 16;

/// How far one frame is from its reference.
struct FrameError {
    int frame = 0;
    double rms = 0;   ///< of the 8-bit channels, 0 … 255
    double ssim = 0;
    double flip = 0;  ///< mean over the picture, 0 … 1
};

/// What was measured over a segment; nothing where a measure does not apply.
struct SegmentMeasures {
    double psnr = 0;                ///< of all frames' squared errors, dB, at most kBestPsnrDb
    double ssim = 0;                ///< mean over the frames
    double flip = 0;                ///< mean over the frames
    std::optional<double> flicker;  ///< see FlickerMeter; needs consecutive frames
    /// Ghost pixels as a share of all pixels of the segment; needs revealed places.
    std::optional<double> ghost_area;
    /// Frames after the case's event in which the past still shows: in which coarse errors (see
    /// coarseRms()) are visible, one code or more, and more than a tenth above those of the same
    /// method, with the same samples, started anew at the event.
    std::optional<double> recovery_frames;
    std::optional<double> sharpness;  ///< mean over the frames; needs references that are not flat
    /// Of what was seen before the case's event, kResidualFrames after it; see residualShare().
    std::optional<double> residual;
    /// The most that any frame has, codes; the mean of kTrailRuns runs is looked at. See
    /// trailCodes().
    std::optional<double> trail;
    /// Median processor time of a frame, one thread, while other cells run beside it. The chart
    /// measures time properly.
    double ms = 0;
    std::vector<FrameError> frames;
    int crop_frame = 0, crop_x = 0, crop_y = 0;
    std::string crop_png;  ///< see ErrorCrop::strip()
};

/// What a frame of a case is compared with.
struct CaseFrame {
    int frame = 0;
    Reference reference;
    Image<uint8_t> revealed;  ///< see RevealMask
};

/// A case that is ready to be measured.
struct PreparedCase {
    const AtlasCase* atlas = nullptr;
    Scene scene;
    FrameSettings view;                            ///< size
    std::vector<std::vector<CaseFrame>> segments;  ///< the compared frames of each
};

/// Frames of a segment that are compared.
std::vector<int> comparedFrames(const AtlasSegment& segment);

/// Size of a frame: half of `full` before the case's resize_frame, at least 1.
Size sizeAt(const AtlasCase& atlas, Size full, int frame);

/// Fills in where surfaces have been revealed. The compared frames must have been listed.
void findRevealed(PreparedCase& prepared);

/// Renders and measures, on the calling thread. One result per segment.
Outcome<std::vector<SegmentMeasures>> measureCell(const PreparedCase& prepared, const Mode& mode);

}  // namespace still::command
