#pragma once
// Intermediates of a frame as pictures for people; the table of colours is in README.md. All of
// them write every pixel of `out`, which has the size of what they read.

#include <span>

#include "postfx/denoise.h"
#include "postfx/encode.h"
#include "postfx/story.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/workers.h"

namespace still::inspect {

void paintColour(const GBuffer& gbuffer, const OutputTable& table, ImageView<Rgb8> out,
                 Workers& workers);
void paintDepth(const GBuffer& gbuffer, ImageView<Rgb8> out, Workers& workers);
void paintNormal(const GBuffer& gbuffer, ImageView<Rgb8> out, Workers& workers);
void paintId(const GBuffer& gbuffer, ImageView<Rgb8> out, Workers& workers);
void paintMotion(const GBuffer& gbuffer, ImageView<Rgb8> out, Workers& workers);
/// Direct and indirect light together, as white surfaces show them; black where planes are empty.
/// They may be smaller than the picture.
void paintLight(const LightPlanes& light, const OutputTable& table, ImageView<Rgb8> out,
                Workers& workers);
/// Black is 0, or a plane that is empty; white is `full`. Counts by their square root, so that few
/// samples are told apart.
void paintCount(ImageView<const uint8_t> count, int full, ImageView<Rgb8> out, Workers& workers);
void paintConfidence(ImageView<const uint8_t> confidence, int full, ImageView<Rgb8> out,
                     Workers& workers);
/// The picture in grey, under verdictColour() the more the more was lost.
void paintRejection(ImageView<const Verdict> reason, ImageView<const uint8_t> lost,
                    ImageView<const Rgb8> picture, ImageView<Rgb8> out, Workers& workers);
/// The picture in grey under a colour for each tile's work.
void paintTiles(std::span<const TileWork> tiles, ImageView<const Rgb8> picture, ImageView<Rgb8> out,
                Workers& workers);
void paintOverdraw(ImageView<const uint16_t> triangles, ImageView<Rgb8> out, Workers& workers);
void paintError(ImageView<const Rgb8> picture, ImageView<const Rgb8> reference, ImageView<Rgb8> out,
                Workers& workers);

/// A colour of its own for each surface; 0 is black.
Rgb8 surfaceColour(uint32_t surface);
/// Direction as colour, speed as saturation and brightness: a wheel, full at kMotionFull_fx8.
Rgb8 motionColour(Motion motion);
constexpr int kMotionFull_fx8 = 16 * 256;
/// One for each reason of rejection.
Rgb8 verdictColour(Verdict verdict);
/// Not drawn: green. Drawn, but neither recorded nor resolved: yellow. Recorded: orange. Resolved:
/// red.
Rgb8 tileColour(const TileWork& work);
/// 0 … 255 as black, blue, magenta, orange, yellow, white.
Rgb8 heatColour(int value);

}  // namespace still::inspect
