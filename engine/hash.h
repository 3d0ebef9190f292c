#pragma once
// 64-bit content hashes (XXH3, libxxhash) of images and planes: size and pixels as
// little-endian numbers, on every machine; not the padding.

#include <cstdint>
#include <string>
#include <string_view>

#include "postfx/taa.h"
#include "rasterizer/gbuffer.h"

namespace still {

/// Hash of every pixel, row by row, and of the size. T is uint8_t, uint16_t, uint32_t, Motion or
/// Rgb8.
template <class T>
uint64_t hashPlane(ImageView<const T> plane);

struct FrameHashes {
    uint64_t output = 0, color = 0, depth = 0, normal = 0, motion = 0, id = 0;
};

/// Planes that do not exist hash to 0. `color` covers red, green and blue of the G-buffer, `motion`
/// the motion and the previous depth.
FrameHashes hashFrame(ImageView<const Rgb8> output, const GBuffer& gbuffer);

/// Hash of bytes that follow others whose hash is `before`. Depends on where the cuts are.
uint64_t hashBytes(std::string_view bytes, uint64_t before = 0);

/// 16 hexadecimal digits.
std::string hex(uint64_t hash);

}  // namespace still
