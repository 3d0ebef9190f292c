#include "rasterizer/texture_layout.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace still {

namespace {

/// A kernel loads 4 texels at once where it needs the last 2.
constexpr size_t kSpareTexels = 2;

size_t end(const TextureLevel& level) {
    return level.offset + size_t{level.stride} * (size_t{level.height} + 1) - 1;
}

/// Spreads the rows of all levels from the end, so that none is overwritten before it has moved.
template <class T>
void spread(std::vector<TextureLevel>& levels, Wrap wrap, std::vector<T>& texels) {
    size_t from = 0;
    std::vector<TextureLevel> laid_out;
    for (const TextureLevel& level : levels) {
        from += size_t{level.width} * level.height;
        addLevel(laid_out, level.width, level.height);
    }
    assert(texels.size() >= from);
    levels = std::move(laid_out);
    texels.resize(texelCount(levels));
    for (size_t k = levels.size(); k-- > 0;) {
        const TextureLevel& level = levels[k];
        const bool repeat = wrap == Wrap::repeat;
        const auto row = [&](size_t y) { return texels.data() + level.offset + y * level.stride; };
        for (size_t y = level.height; y-- > 0;) {
            from -= level.width;
            std::memmove(row(y), texels.data() + from, level.width * sizeof(T));
        }
        for (size_t y = level.height; y-- > 0;) {
            row(y)[-1] = row(y)[repeat ? level.width - 1 : 0];
            row(y)[level.width] = row(y)[repeat ? 0 : level.width - 1];
        }
        const T* const last = row(level.height - 1) - 1;
        std::copy_n(repeat ? last : row(0) - 1, level.stride, row(0) - 1 - level.stride);
        std::copy_n(repeat ? row(0) - 1 : last, level.stride, row(level.height) - 1);
    }
}

}  // namespace

void addLevel(std::vector<TextureLevel>& levels, uint32_t width, uint32_t height) {
    const uint32_t stride = width + 2;
    const size_t begin = levels.empty() ? 0 : end(levels.back());
    levels.push_back({width, height, uint32_t(begin + stride + 1), stride});
}

size_t texelCount(const std::vector<TextureLevel>& levels) {
    return end(levels.back()) + kSpareTexels;
}

void layOut(Texture& texture) {
    spread(texture.levels, texture.wrap, texture.texels);
}

void layOut(AlphaTexture& texture) {
    spread(texture.levels, texture.wrap, texture.texels);
}

}  // namespace still
