#include "demos/stillframe/segment_meter.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "demos/stillframe/png.h"
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

/// Pixels left … right − 1, top … bottom − 1.
struct Box {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// Signed errors of the channels, summed.
struct ErrorSum {
    int r = 0, g = 0, b = 0;
};

ErrorSum errorOf(ImageView<const Rgb8> picture, ImageView<const Rgb8> reference, const Box& block) {
    ErrorSum sum;
    for (int y = block.top; y < block.bottom; ++y) {
        for (int x = block.left; x < block.right; ++x) {
            const Rgb8 p = picture.at(x, y);
            const Rgb8 q = reference.at(x, y);
            sum.r += p.r - q.r;
            sum.g += p.g - q.g;
            sum.b += p.b - q.b;
        }
    }
    return sum;
}

/// Errors in units of the newly started method's; less than one code cannot be seen.
double recoveryOf(const std::vector<double>& errors, const std::vector<double>& anew) {
    constexpr double kInvisible = 1.0;
    std::vector<double> ratios;
    const size_t before = errors.size() - anew.size();
    for (size_t i = 0; i < anew.size(); ++i) {
        ratios.push_back(errors[before + i] / std::max(kInvisible, anew[i]));
    }
    return recoveryFrames(ratios, 1.0);
}

}  // namespace

double coarseRms(ImageView<const Rgb8> picture, ImageView<const Rgb8> reference) {
    constexpr int kBlock = 8;
    double sum = 0;
    for (int top = 0; top < picture.height; top += kBlock) {
        for (int left = 0; left < picture.width; left += kBlock) {
            const Box block{left, top, std::min(left + kBlock, picture.width),
                            std::min(top + kBlock, picture.height)};
            const ErrorSum e = errorOf(picture, reference, block);
            const double squares = double(e.r) * e.r + double(e.g) * e.g + double(e.b) * e.b;
            sum += squares / ((block.right - left) * (block.bottom - top));  // weight × mean²
        }
    }
    return std::sqrt(sum / (3.0 * picture.width * picture.height));
}

void SegmentMeter::compare(const CaseFrame& frame, ImageView<const Rgb8> picture, bool cut) {
    const ImageView<const Rgb8> reference = frame.reference.picture.view();
    Workers alone(1, Schedule::serial);
    const PixelError error = pixelError(picture, reference);
    const double flip = meanFlip(reference, picture, {}, alone);
    error_ += error;
    const double similarity = ssim(picture, reference);
    sums_.ssim += similarity;
    sums_.flip += flip;
    sums_.frames.push_back({frame.frame, rmse(error), similarity, flip});
    coarse_.push_back(coarseRms(picture, reference));
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
    measureResidual(frame, picture);
}

void SegmentMeter::measureResidual(const CaseFrame& frame, ImageView<const Rgb8> picture) {
    if (!event_frame_) {
        return;
    }
    const ImageView<const Rgb8> reference = frame.reference.picture.view();
    if (frame.frame == *event_frame_ - 1) {
        before_event_ = reference;
    }
    if (frame.frame == *event_frame_ + kResidualFrames && !before_event_.empty()) {
        sums_.residual = residualShare(picture, before_event_, reference);
    }
}

void SegmentMeter::countGhosts(const CaseFrame& frame, ImageView<const Rgb8> picture) {
    pixels_ += uint64_t(picture.width) * uint64_t(picture.height);
    if (!frame.revealed.empty()) {
        revealed_ += marked(frame.revealed.view());
        ghosts_ += ghostPixels(picture, frame.reference.picture.view(), frame.revealed.view());
    }
}

Outcome<SegmentMeasures> SegmentMeter::finish(const std::vector<double>& anew) {
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
        measures.recovery_frames = recoveryOf(coarse_, anew);
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
