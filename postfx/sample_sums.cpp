#include "postfx/sample_sums.h"

namespace still {
namespace {

constexpr int kRowGrain = 16;

void addPlane(ImageView<const uint16_t> sample, bool first, ImageView<uint32_t> sum,
              Workers& workers) {
    workers.parallelFor(sum.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const uint16_t* from = sample.row(y);
            uint32_t* to = sum.row(y);
            for (int x = 0; x < sum.width; ++x) {
                to[x] = (first ? 0 : to[x]) + from[x];
            }
        }
    });
}

/// Rounded half up: count / 2 cannot carry past 32 bits.
void averagePlane(ImageView<const uint32_t> sum, uint32_t count, ImageView<uint16_t> mean,
                  Workers& workers) {
    workers.parallelFor(sum.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const uint32_t* from = sum.row(y);
            uint16_t* to = mean.row(y);
            for (int x = 0; x < sum.width; ++x) {
                to[x] = uint16_t((from[x] + count / 2) / count);
            }
        }
    });
}

}  // namespace

void ColourSums::resize(int width, int height) {
    for (Image<uint32_t>* plane : {&red_, &green_, &blue_}) {
        plane->resize(width, height);
    }
}

void ColourSums::add(const ColourPlanes& sample, bool first, Workers& workers) {
    addPlane(sample.red, first, red_.view(), workers);
    addPlane(sample.green, first, green_.view(), workers);
    addPlane(sample.blue, first, blue_.view(), workers);
}

void ColourSums::average(uint32_t count, const ColourTargets& out, Workers& workers) const {
    averagePlane(red_.view(), count, out.red, workers);
    averagePlane(green_.view(), count, out.green, workers);
    averagePlane(blue_.view(), count, out.blue, workers);
}

}  // namespace still
