#include "demos/viewer/dynamic_resolution.h"

#include <algorithm>
#include <cmath>

namespace still::viewer {
namespace {

constexpr int kStep_percent = 5;
/// A change throws history away, whose rebuilding costs time of its own: it needs a reason.
constexpr int kSettle_frames = 4, kPatience_frames = 24;
/// Too slow by this is a reason to go down; up needs room for the next step and this.
constexpr double kTooSlow = 1.08, kRoom = 1.10;

}  // namespace

int DynamicResolution::next(int scale_percent, double frame_ms, double fixed_ms,
                            double wanted_fps) {
    ++frames_;
    if (frames_ <= kSettle_frames) {  // the first ones allocate, and fill histories
        mean_ms_ = frame_ms;
        mean_fixed_ms_ = fixed_ms;
        return scale_percent;
    }
    constexpr double kNew = 0.2;
    mean_ms_ += (frame_ms - mean_ms_) * kNew;
    mean_fixed_ms_ += (fixed_ms - mean_fixed_ms_) * kNew;
    const double budget_ms = 1000 / wanted_fps;
    const bool slow = mean_ms_ > budget_ms * kTooSlow && frames_ > 2 * kSettle_frames;
    // Work goes with the number of pixels.
    const double pixels_ms = std::max(mean_ms_ - mean_fixed_ms_, 0.01);
    const auto costAt = [&](double scale) {
        return mean_fixed_ms_ + pixels_ms * (scale / scale_percent) * (scale / scale_percent);
    };
    const bool room =
        frames_ > kPatience_frames && costAt(scale_percent + kStep_percent) * kRoom < budget_ms;
    if (!slow && !room) {
        return scale_percent;
    }
    const double share = std::max(budget_ms - mean_fixed_ms_, 0.0) / (slow ? 1 : kRoom) / pixels_ms;
    const int fitting = int(scale_percent * std::sqrt(share)) / kStep_percent * kStep_percent;
    const int scale = std::clamp(fitting, kSmallest_percent, kLargest_percent);
    if (scale != scale_percent) {
        frames_ = 0;
    }
    return scale;
}

}  // namespace still::viewer
