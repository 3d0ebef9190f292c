#pragma once
// Intermediates of a frame as pictures for people; the table of colours is in README.md. All of
// them write every pixel of `out`, which has the size of what they read.

#include "postfx/encode.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/workers.h"

namespace still::inspect {

void paintColour(const GBuffer& gbuffer, const OutputTable& table, ImageView<Rgb8> out,
                 Workers& workers);
void paintDepth(const GBuffer& gbuffer, ImageView<Rgb8> out, Workers& workers);
void paintNormal(const GBuffer& gbuffer, ImageView<Rgb8> out, Workers& workers);
void paintId(const GBuffer& gbuffer, ImageView<Rgb8> out, Workers& workers);
void paintMotion(const GBuffer& gbuffer, ImageView<Rgb8> out, Workers& workers);
/// Black is 0, or a plane that is empty; white is `full`.
void paintCount(ImageView<const uint8_t> count, int full, ImageView<Rgb8> out, Workers& workers);
void paintError(ImageView<const Rgb8> picture, ImageView<const Rgb8> reference, ImageView<Rgb8> out,
                Workers& workers);

/// A colour of its own for each surface; 0 is black.
Rgb8 surfaceColour(uint32_t surface);
/// Direction as colour, speed as saturation and brightness: a wheel, full at kMotionFull_fx8.
Rgb8 motionColour(Motion motion);
constexpr int kMotionFull_fx8 = 16 * 256;
/// 0 … 255 as black, blue, magenta, orange, yellow, white.
Rgb8 heatColour(int value);

}  // namespace still::inspect
