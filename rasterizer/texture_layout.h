#pragma once
// How the texels of a texture lie in memory. Filtering reads two neighbours of a row and the two
// below them, from texel −1 to texel `size` of each axis. A border of one texel around every level
// spares it the question whether a neighbour is on the other side:
//
//                   Wrap::repeat     Wrap::clamp
//      a b c        f|d e f|d        a|a b c|c
//      d e f        ─┼─────┼─        ─┼─────┼─
//                   c|a b c|a        a|a b c|c
//                   f|d e f|d        d|d e f|f
//                   ─┼─────┼─        ─┼─────┼─
//                   c|a b c|a        d|d e f|f

#include "rasterizer/draw_list.h"

namespace still {

/// Appends a level behind those that stand there; `offset` is that of its texel (0, 0).
void addLevel(std::vector<TextureLevel>& levels, uint32_t width, uint32_t height);

/// Texels of all levels with their borders, and a few spare ones behind, so that a kernel may load
/// more than it uses.
size_t texelCount(const std::vector<TextureLevel>& levels);

/// Takes a texture whose levels (widths, heights) follow one another in `texels`, row by row and
/// without gaps; sets offsets and strides, makes room for the borders and fills them.
void layOut(Texture& texture);
void layOut(AlphaTexture& texture);

/// Only the first level is left: the texture is point-sampled however far away it is, which is what
/// real content does where its mips are missing or biased.
template <class AnyTexture>
AnyTexture withoutMips(AnyTexture texture) {
    texture.levels.resize(1);
    texture.texels.resize(texelCount(texture.levels));
    return texture;
}

}  // namespace still
