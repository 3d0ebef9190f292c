#include "demos/inspect/reference.h"

#include <algorithm>
#include <bit>

namespace still::inspect {
namespace {

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
    sums_.resize(width, height);
}

void Reference::addSample(uint32_t index) {
    const GBuffer& gbuffer = probe_.draw(
        frame_, width_, height_, {.offset = ssaaSample(index, uint32_t(wanted_)), .sample = index});
    sums_.add({gbuffer.red.view(), gbuffer.green.view(), gbuffer.blue.view()}, done_ == 0,
              workers_);
    ++done_;
}

void Reference::add(int count) {
    const int end = std::min(done_ + count, wanted_);
    while (done_ < end) {
        addSample(order_.next());
    }
}

ImageView<const Rgb8> Reference::encode(const OutputTable& table) {
    for (Image<uint16_t>* plane : {&red_, &green_, &blue_}) {
        plane->resize(width_, height_);
    }
    sums_.average(uint32_t(done_), {red_.view(), green_.view(), blue_.view()}, workers_);
    output_.resize(width_, height_);
    encodeOutput({red_.view(), green_.view(), blue_.view()}, table, output_.view(), workers_);
    return output_.view();
}

}  // namespace still::inspect
