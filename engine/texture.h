#pragma once
// Pixels in, mip-mapped textures in the rasterizer's formats out. Used by the loaders and by the
// built-in scenes. Mip levels are box-filtered in linear light with exact area weights for odd
// sizes.

#include "rasterizer/draw_list.h"
#include "rasterizer/image.h"

namespace still {

/// One decoded pixel as it stands in an image file.
struct Rgba8 {
    uint8_t r = 0, g = 0, b = 0, a = 255;
    friend bool operator==(const Rgba8&, const Rgba8&) = default;
};

/// Of the encoded values: Rec. 709 weights in 1/256, exact for greys.
uint8_t luminance(const Rgba8& pixel);

/// sRGB-encoded pixels → colour texture. Alpha is ignored.
Texture makeColourTexture(ImageView<const Rgba8> image, Wrap wrap);

/// Tangent-space normals (component = c · 2/255 − 1, +y up in the image) → normal map. Mips average
/// the vectors.
Texture makeNormalTexture(ImageView<const Rgba8> image, Wrap wrap);

/// Grey height image → normal map by central differences; `bump_scale` as MTL's -bm.
Texture makeNormalTextureFromHeight(ImageView<const Rgba8> image, Wrap wrap, float bump_scale);

/// Luminance → height map (Material::height_texture): white is the surface, black the deepest.
AlphaTexture makeHeightTexture(ImageView<const Rgba8> image, Wrap wrap);

/// The alpha channel → alpha texture. `preserve_coverage`, for AlphaMode::test, scales each mip so
/// that the share of texels ≥ 0.5 stays that of level 0 (Castaño 2010), and ends the chain where
/// even so the covered area would change: fine wires are then undersampled, which accumulation
/// cures, and not lost.
AlphaTexture makeAlphaTexture(ImageView<const Rgba8> image, Wrap wrap, bool preserve_coverage);

}  // namespace still
