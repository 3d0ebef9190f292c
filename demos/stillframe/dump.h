#pragma once
// G-buffer planes as pictures for people. Numbers for programs come from --hash.

#include "demos/stillframe/options.h"
#include "engine/frame_loop.h"

namespace still::command {

/// color       the last sample alone, encoded like the output
/// depth       logarithmic, near is bright; spread over what the picture holds; nothing is black
/// normal      x, y, z in −1 … 1 as red, green, blue; nothing is black
/// motion      red x, green y: 128 is rest, 8 steps a pixel, at most 16 pixels; no history is blue
/// id          a colour of its own for each surface; nothing is black
/// confidence  what TAA knows of the pixel (samples, or trust in history), white when that is all
Image<Rgb8> pictureOf(DumpPlane plane, const FrameResult& frame, const OutputTable& table);

}  // namespace still::command
