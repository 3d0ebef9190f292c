#pragma once
// Texels as people count them, without the borders of rasterizer/texture_layout.h.

#include <vector>

#include "rasterizer/draw_list.h"

namespace still::test {

template <class AnyTexture>
auto texelAt(const AnyTexture& texture, size_t level, uint32_t x, uint32_t y) {
    const TextureLevel& l = texture.levels.at(level);
    return texture.texels.at(size_t{l.offset} + size_t{y} * l.stride + x);
}

/// All texels of a level, row by row.
template <class AnyTexture>
auto texelsOf(const AnyTexture& texture, size_t level) {
    decltype(texture.texels) out;
    for (uint32_t y = 0; y < texture.levels[level].height; ++y) {
        for (uint32_t x = 0; x < texture.levels[level].width; ++x) {
            out.push_back(texelAt(texture, level, x, y));
        }
    }
    return out;
}

}  // namespace still::test
