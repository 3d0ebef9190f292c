#include "demos/stillframe/y4m.h"

#include "demos/stillframe/formatted.h"

namespace still::command {
namespace {

/// A row of the matrix (ITU-R BT.601-7, 2.5.1 to 2.5.3) in 1/65536, and what is added.
struct Weights {
    int r, g, b, offset;
    char of(Rgb8 c) const { return char(((r * c.r + g * c.g + b * c.b + 32768) >> 16) + offset); }
};
constexpr Weights kLuma{16829, 33039, 6416, 16};
constexpr Weights kBlue{-9714, -19070, 28784, 128};
constexpr Weights kRed{28784, -24103, -4681, 128};

}  // namespace

Y4mWriter::Y4mWriter(std::FILE* stream, int width, int height, int fps) : stream_(stream) {
    const std::string header =
        formatted("YUV4MPEG2 W%d H%d F%d:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n", width, height, fps);
    std::fwrite(header.data(), 1, header.size(), stream_);
}

void Y4mWriter::add(ImageView<const Rgb8> image) {
    planes_ = "FRAME\n";
    for (const Weights& weights : {kLuma, kBlue, kRed}) {
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                planes_ += weights.of(image.at(x, y));
            }
        }
    }
    std::fwrite(planes_.data(), 1, planes_.size(), stream_);
}

}  // namespace still::command
