// Measures that need more than one frame: flicker, ghosts, recovery.

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "postfx/metrics.h"
#include "rasterizer/fixed.h"

namespace still {
namespace {

std::array<int, 3> difference(Rgb8 a, Rgb8 b) {
    return {a.r - b.r, a.g - b.g, a.b - b.b};
}

uint16_t surfaceAt(ImageView<const uint16_t> id, int x, int y) {
    return uint16_t(id.at(x, y) & kSurfaceMask);
}

bool onSilhouette(ImageView<const uint16_t> id, int x, int y) {
    const uint16_t own = surfaceAt(id, x, y);
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, id.height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, id.width - 1); ++i) {
            if (surfaceAt(id, i, j) != own) {
                return true;
            }
        }
    }
    return false;
}

/// Frames that the mark at (x, y) lives from now on.
uint8_t lifeAt(const GBuffer& now, ImageView<const uint16_t> id_before,
               ImageView<const uint8_t> life_before, int x, int y) {
    const Motion motion = now.motion.at(x, y);
    if (motion.x_fx8 == kNoHistory) {
        return 0;
    }
    const int bx = x + roundShift(int(motion.x_fx8), kSubpixelBits);
    const int by = y + roundShift(int(motion.y_fx8), kSubpixelBits);
    if (bx < 0 || bx >= id_before.width || by < 0 || by >= id_before.height) {
        return 0;
    }
    if (surfaceAt(now.id.view(), x, y) != surfaceAt(id_before, bx, by)) {
        return kRevealFrames;
    }
    const uint8_t life = life_before.at(bx, by);
    return life > 0 ? uint8_t(life - 1) : uint8_t(0);
}

}  // namespace

void FlickerMeter::add(ImageView<const Rgb8> reference, ImageView<const Rgb8> output) {
    assert(reference.width == output.width && reference.height == output.height);
    const size_t channels = size_t(reference.width) * size_t(reference.height) * 3;
    const bool compare = !before_.empty();
    assert(!compare || before_.size() == channels);
    before_.resize(channels);
    size_t i = 0;
    for (int y = 0; y < reference.height; ++y) {
        for (int x = 0; x < reference.width; ++x) {
            for (int error : difference(output.at(x, y), reference.at(x, y))) {
                const int change = compare ? error - before_[i] : 0;
                squared_sum_ += uint64_t(change * change);
                before_[i++] = int16_t(error);
            }
        }
    }
    channels_ += compare ? channels : 0;
}

double FlickerMeter::rms() const {
    return channels_ == 0 ? 0.0 : std::sqrt(double(squared_sum_) / double(channels_)) / 255.0;
}

ImageView<const uint8_t> RevealMask::next(const GBuffer& gbuffer, bool cut) {
    assert(gbuffer.planes.motion);
    const int width = gbuffer.width(), height = gbuffer.height();
    const bool known = !cut && id_before_.width() == width && id_before_.height() == height;
    for (Image<uint8_t>* plane : {&left_, &left_before_, &mask_}) {
        plane->resize(width, height);
    }
    id_before_.resize(width, height);
    std::swap(left_, left_before_);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const uint8_t life = known ? lifeAt(gbuffer, std::as_const(id_before_).view(),
                                                std::as_const(left_before_).view(), x, y)
                                       : uint8_t(0);
            left_.at(x, y) = life;
            mask_.at(x, y) = life > 0 && !onSilhouette(gbuffer.id.view(), x, y) ? 1 : 0;
        }
    }
    for (int y = 0; y < height; ++y) {
        std::copy_n(gbuffer.id.view().row(y), width, id_before_.view().row(y));
    }
    return std::as_const(mask_).view();
}

uint64_t ghostPixels(ImageView<const Rgb8> output, ImageView<const Rgb8> reference,
                     ImageView<const uint8_t> mask) {
    assert(output.width == reference.width && output.height == reference.height);
    assert(output.width == mask.width && output.height == mask.height);
    uint64_t ghosts = 0;
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            const auto error = difference(output.at(x, y), reference.at(x, y));
            const bool far = std::any_of(error.begin(), error.end(),
                                         [](int e) { return std::abs(e) > kGhostError; });
            ghosts += mask.at(x, y) != 0 && far ? 1 : 0;
        }
    }
    return ghosts;
}

int recoveryFrames(std::span<const double> rmse_after, double settled_rmse) {
    constexpr double kMargin = 1.1, kInvisible = 0.25;
    const double limit = std::max(settled_rmse * kMargin, kInvisible);
    size_t disturbed = rmse_after.size();
    while (disturbed > 0 && rmse_after[disturbed - 1] <= limit) {
        --disturbed;
    }
    return int(disturbed);
}

}  // namespace still
