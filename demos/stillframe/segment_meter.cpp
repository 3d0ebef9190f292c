#include "demos/stillframe/segment_meter.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "postfx/flip.h"

namespace still::command {
namespace {

/// The upper one of the middle two. Not of nothing.
double median(std::vector<double> values) {
    const auto middle = values.begin() + ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

uint64_t marked(ImageView<const uint8_t> mask) {
    uint64_t count = 0;
    for (int y = 0; y < mask.height; ++y) {
        count += uint64_t(
            std::count_if(mask.row(y), mask.row(y) + mask.width, [](uint8_t m) { return m != 0; }));
    }
    return count;
}

/// Both errors in units of the newly started method's, of which a quarter of a code is never less.
double recoveryOf(const std::vector<FrameError>& frames, const std::vector<FrameError>& anew) {
    constexpr double kLeastRms = 0.25;
    std::vector<double> ratios;
    const size_t before = frames.size() - anew.size();
    for (size_t i = 0; i < anew.size(); ++i) {
        ratios.push_back(frames[before + i].rms / std::max(kLeastRms, anew[i].rms));
    }
    return recoveryFrames(ratios, 1.0);
}

}  // namespace

void SegmentMeter::compare(const CaseFrame& frame, ImageView<const Rgb8> picture, bool cut) {
    const ImageView<const Rgb8> reference = frame.reference.picture.view();
    Workers alone(1, Schedule::serial);
    const PixelError error = pixelError(picture, reference);
    const double flip = meanFlip(reference, picture, {}, alone);
    error_ += error;
    sums_.ssim += ssim(picture, reference);
    sums_.flip += flip;
    sums_.frames.push_back({frame.frame, rmse(error), flip});
    if (const double ratio = sharpnessRatio(reference, picture); std::isfinite(ratio)) {
        sharpness_sum_ += ratio;
        ++sharpness_count_;
    }
    if (cut) {
        flicker_.cut();
    }
    flicker_.add(reference, picture);
    crop_.look(frame.frame, picture, reference);
    countGhosts(frame, picture);
}

void SegmentMeter::countGhosts(const CaseFrame& frame, ImageView<const Rgb8> picture) {
    pixels_ += uint64_t(picture.width) * uint64_t(picture.height);
    if (!frame.revealed.empty()) {
        revealed_ += marked(frame.revealed.view());
        ghosts_ += ghostPixels(picture, frame.reference.picture.view(), frame.revealed.view());
    }
}

Outcome<SegmentMeasures> SegmentMeter::finish(const std::vector<FrameError>& anew) {
    assert(!sums_.frames.empty() && !times_ms_.empty());
    SegmentMeasures measures = std::move(sums_);
    const double count = double(measures.frames.size());
    measures.psnr = std::min(kBestPsnrDb, psnrDb(error_));
    measures.ssim /= count;
    measures.flip /= count;
    if (measures.frames.size() > 1 && segment_.step == 1) {
        measures.flicker = flicker_.rms();
    }
    if (revealed_ > 0) {
        measures.ghost_area = double(ghosts_) / double(pixels_);
    }
    if (!anew.empty()) {
        measures.recovery_frames = recoveryOf(measures.frames, anew);
    }
    if (sharpness_count_ > 0) {
        measures.sharpness = sharpness_sum_ / sharpness_count_;
    }
    measures.ms = median(times_ms_);
    measures.crop_frame = crop_.frame();
    measures.crop_x = crop_.x();
    measures.crop_y = crop_.y();
    return pngBytes(crop_.strip()).map([&](std::string png) {
        measures.crop_png = std::move(png);
        return std::move(measures);
    });
}

}  // namespace still::command
