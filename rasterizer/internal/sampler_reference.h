#pragma once
// The scalar truth of texture sampling: trilinear filtering (Williams 1983). Steps are the same, in
// the same order, as in sampler-inl.h.

#include "rasterizer/internal/surface_reference.h"

namespace still::internal {

struct TextureCoordinates {
    float u, v;
    float du_dx, du_dy, dv_dx, dv_dy;  ///< per pixel
};

/// The slopes are those of the mesh's own coordinates: an offset leaves the mip level as it is.
TextureCoordinates textureCoordinates(const PixelBarycentrics& p, const Surface& s);

/// Raw texel units: squared for colour, 0 … 1023 for normal maps.
template <bool kSquare>
Float3 sampleTexture(const Texture& texture, const TextureCoordinates& c, int bias_fx8);

/// In 0 … 1.
float sampleAlpha(const AlphaTexture& texture, const TextureCoordinates& c, int bias_fx8);

}  // namespace still::internal
