#pragma once
// Draws what Dear ImGui has listed, on the CPU: triangles with colours at their corners and an
// atlas of glyphs, blended over a finished picture. Integers throughout, so the same list gives the
// same pixels everywhere.

#include <cstdint>

#include "rasterizer/image.h"

struct ImDrawData;

namespace still::viewer {

/// A window's pixel: 0x00RRGGBB, as SDL calls it XRGB8888.
using Xrgb8 = uint32_t;

/// Draws over `canvas`, whose pixel (0, 0) is the list's DisplayPos, one pixel a unit.
/// A pixel belongs to a triangle when its centre does, on edges by the top-left rule, so neighbours
/// neither overlap nor leave gaps; corners are rounded to 1/64 pixel and held within ±16384.
/// `atlas` is Dear ImGui's alpha texture, at most 4096 texels wide and high, read at the nearest
/// texel: glyphs are drawn texel by pixel. A command whose texture is not null has a pointer to an
/// ImageView<const Rgb8> there, of at most 4096 × 4096 pixels, which is read in the same way. User
/// callbacks are passed over.
void drawUi(const ImDrawData& data, ImageView<const uint8_t> atlas, ImageView<Xrgb8> canvas);

}  // namespace still::viewer
