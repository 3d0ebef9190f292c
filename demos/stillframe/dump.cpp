#include "demos/stillframe/dump.h"

#include <algorithm>
#include <cmath>

#include "rasterizer/fixed.h"

namespace still::command {
namespace {

constexpr Rgb8 kNothing{0, 0, 0};
constexpr Rgb8 kNoHistoryColour{0, 0, 255};

/// Calls paint(x, y) for each pixel of a new picture.
template <class Paint>
Image<Rgb8> paintEach(int width, int height, Paint&& paint) {
    Image<Rgb8> picture(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            picture.at(x, y) = paint(x, y);
        }
    }
    return picture;
}

uint8_t toByte(float value) {
    return uint8_t(std::clamp(roundToInt(value), 0, 255));
}

Image<Rgb8> colourPicture(const GBuffer& g, const OutputTable& table) {
    return paintEach(g.width(), g.height(), [&](int x, int y) {
        return Rgb8{table[g.red.at(x, y)], table[g.green.at(x, y)], table[g.blue.at(x, y)]};
    });
}

Image<Rgb8> depthPicture(const GBuffer& g) {
    int nearest = 0;
    int farthest = 65535;
    for (int y = 0; y < g.height(); ++y) {
        for (int x = 0; x < g.width(); ++x) {
            if (g.depth.at(x, y) != 0) {
                nearest = std::max<int>(nearest, logDepth16(g.depth.at(x, y)));
                farthest = std::min<int>(farthest, logDepth16(g.depth.at(x, y)));
            }
        }
    }
    constexpr int kDarkest = 24;  // the farthest surface still differs from nothing
    const int range = std::max(1, nearest - farthest);
    return paintEach(g.width(), g.height(), [&](int x, int y) {
        const uint32_t depth = g.depth.at(x, y);
        if (depth == 0) {
            return kNothing;
        }
        const int above = logDepth16(depth) - farthest;
        const uint8_t grey = uint8_t(kDarkest + above * (255 - kDarkest) / range);
        return Rgb8{grey, grey, grey};
    });
}

Image<Rgb8> normalPicture(const GBuffer& g) {
    return paintEach(g.width(), g.height(), [&](int x, int y) {
        if ((g.id.at(x, y) & kSurfaceMask) == 0) {
            return kNothing;
        }
        const NormalVector n = decodeOctahedral(g.normal.at(x, y));
        const float scale = 127.5f / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        return Rgb8{toByte(127.5f + n.x * scale), toByte(127.5f + n.y * scale),
                    toByte(127.5f + n.z * scale)};
    });
}

Image<Rgb8> motionPicture(const GBuffer& g) {
    constexpr int kStepShift = 5;  // 256 units a pixel → 8 steps a pixel
    return paintEach(g.width(), g.height(), [&](int x, int y) {
        const Motion motion = g.motion.at(x, y);
        if (motion.x_fx8 == kNoHistory) {
            return kNoHistoryColour;
        }
        const auto shade = [](int fx8) {
            return uint8_t(std::clamp(128 + roundShift(fx8, kStepShift), 0, 255));
        };
        return Rgb8{shade(motion.x_fx8), shade(motion.y_fx8), 128};
    });
}

Image<Rgb8> idPicture(const GBuffer& g) {
    return paintEach(g.width(), g.height(), [&](int x, int y) {
        const uint32_t surface = g.id.at(x, y) & kSurfaceMask;
        if (surface == 0) {
            return kNothing;
        }
        const uint32_t hash = surface * 0x9E3779B1u;  // neighbours in number fall far apart
        const auto bright = [&](int shift) { return uint8_t(64 + (hash >> shift) % 192); };
        return Rgb8{bright(24), bright(16), bright(8)};
    });
}

Image<Rgb8> confidencePicture(ImageView<const uint8_t> confidence, int full) {
    return paintEach(confidence.width, confidence.height, [&](int x, int y) {
        const uint8_t grey = uint8_t(confidence.at(x, y) * 255 / full);
        return Rgb8{grey, grey, grey};
    });
}

}  // namespace

Image<Rgb8> pictureOf(DumpPlane plane, const FrameResult& frame, const OutputTable& table) {
    const GBuffer& gbuffer = *frame.gbuffer;
    switch (plane) {
        case DumpPlane::color:
            return colourPicture(gbuffer, table);
        case DumpPlane::depth:
            return depthPicture(gbuffer);
        case DumpPlane::normal:
            return normalPicture(gbuffer);
        case DumpPlane::motion:
            return motionPicture(gbuffer);
        case DumpPlane::id:
            return idPicture(gbuffer);
        case DumpPlane::confidence:
            return confidencePicture(frame.confidence, frame.confidence_full);
    }
    return {};
}

}  // namespace still::command
