// What is left of the past in a picture: residues of light that has gone, trails of things.

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>

#include "postfx/metrics.h"

namespace still {
namespace {

std::array<int, 3> channelsOf(Rgb8 colour) {
    return {colour.r, colour.g, colour.b};
}

/// What a channel was when it differed most from `now`, minus that; 0 unless something passed it
/// and is gone.
int pastOf(std::span<const ImageView<const Rgb8>> references, int x, int y, size_t channel) {
    const auto codeAt = [&](size_t i) { return channelsOf(references[i].at(x, y))[channel]; };
    const size_t last = references.size() - 1;
    const int now = codeAt(last);
    if (std::abs(codeAt(last - 1) - now) > kTrailGone) {
        return 0;
    }
    int past = 0;
    for (size_t i = 0; i + 1 < last; ++i) {
        const int difference = codeAt(i) - now;
        past = std::abs(difference) > std::abs(past) ? difference : past;
    }
    return std::abs(past) >= kTrailPassed ? past : 0;
}

}  // namespace

double residualShare(ImageView<const Rgb8> picture, ImageView<const Rgb8> before,
                     ImageView<const Rgb8> after) {
    assert(picture.width == before.width && picture.height == before.height);
    assert(picture.width == after.width && picture.height == after.height);
    int64_t along = 0, whole = 0;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const auto p = channelsOf(picture.at(x, y)), b = channelsOf(before.at(x, y)),
                       a = channelsOf(after.at(x, y));
            for (size_t c = 0; c < 3; ++c) {
                along += int64_t{p[c] - a[c]} * (b[c] - a[c]);
                whole += int64_t{b[c] - a[c]} * (b[c] - a[c]);
            }
        }
    }
    return whole == 0 ? 0.0 : double(along) / double(whole);
}

void PictureMean::add(ImageView<const Rgb8> picture) {
    width_ = picture.width;
    sums_.resize(size_t(picture.width) * size_t(picture.height) * 3);
    size_t i = 0;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            for (int code : channelsOf(picture.at(x, y))) {
                sums_[i++] += uint32_t(code);
            }
        }
    }
    ++pictures_;
}

double PictureMean::at(int x, int y, int channel) const {
    const size_t i = (size_t(y) * size_t(width_) + size_t(x)) * 3 + size_t(channel);
    return double(sums_[i]) / pictures_;
}

double trailCodes(std::span<const ImageView<const Rgb8>> references, const PictureMean& mean) {
    double most = 0;
    if (references.size() < 3) {
        return most;
    }
    const ImageView<const Rgb8> now = references.back();
    for (int y = 0; y < now.height; ++y) {
        for (int x = 0; x < now.width; ++x) {
            for (size_t c = 0; c < 3; ++c) {
                const int past = pastOf(references, x, y, c);
                if (past != 0) {
                    const double error = mean.at(x, y, int(c)) - channelsOf(now.at(x, y))[c];
                    most = std::max(most, past > 0 ? error : -error);
                }
            }
        }
    }
    return most;
}

}  // namespace still
