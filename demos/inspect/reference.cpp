#include "demos/inspect/reference.h"

#include <algorithm>
#include <bit>

namespace still::inspect {
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

/// Rounded half up, as FrameLoop does it.
void averagePlane(ImageView<const uint32_t> sum, uint32_t count, Image<uint16_t>& mean,
                  Workers& workers) {
    mean.resize(sum.width, sum.height);
    const ImageView<uint16_t> out = mean.view();
    workers.parallelFor(sum.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            const uint32_t* from = sum.row(y);
            uint16_t* to = out.row(y);
            for (int x = 0; x < sum.width; ++x) {
                to[x] = uint16_t((from[x] + count / 2) / count);
            }
        }
    });
}

uint32_t reversed(uint32_t value, uint32_t bits) {
    uint32_t result = 0;
    for (uint32_t i = 0; i < bits; ++i) {
        result |= ((value >> i) & 1) << (bits - 1 - i);
    }
    return result;
}

}  // namespace

ReferenceOrder::ReferenceOrder(uint32_t count)
    : count_(count), bits_(uint32_t(std::bit_width(count - 1))) {}

uint32_t ReferenceOrder::next() {
    // The samples of ssaa:N go from left to right through the pixel: bits are reversed, and numbers
    // that this leads beyond the end left out.
    for (;;) {
        const uint32_t index = reversed(step_, bits_);
        step_ = (step_ + 1) & ((1u << bits_) - 1);
        if (index < count_) {
            return index;
        }
    }
}

void Reference::begin(int frame, int width, int height, int samples) {
    frame_ = frame;
    width_ = width;
    height_ = height;
    wanted_ = samples;
    done_ = 0;
    order_ = ReferenceOrder(uint32_t(samples));
    for (Image<uint32_t>* sum : {&red_, &green_, &blue_}) {
        sum->resize(width, height);
    }
}

void Reference::addSample(uint32_t index) {
    const GBuffer& gbuffer = probe_.draw(
        frame_, width_, height_, {.offset = ssaaSample(index, uint32_t(wanted_)), .sample = index});
    addPlane(gbuffer.red.view(), done_ == 0, red_.view(), workers_);
    addPlane(gbuffer.green.view(), done_ == 0, green_.view(), workers_);
    addPlane(gbuffer.blue.view(), done_ == 0, blue_.view(), workers_);
    ++done_;
}

void Reference::add(int count) {
    const int end = std::min(done_ + count, wanted_);
    while (done_ < end) {
        addSample(order_.next());
    }
}

ImageView<const Rgb8> Reference::encode(const OutputTable& table) {
    output_.resize(width_, height_);
    averagePlane(red_.view(), uint32_t(done_), mean_red_, workers_);
    averagePlane(green_.view(), uint32_t(done_), mean_green_, workers_);
    averagePlane(blue_.view(), uint32_t(done_), mean_blue_, workers_);
    encodeOutput({mean_red_.view(), mean_green_.view(), mean_blue_.view()}, table, output_.view(),
                 workers_);
    return output_.view();
}

}  // namespace still::inspect
