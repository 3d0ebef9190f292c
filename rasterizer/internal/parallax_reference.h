#pragma once
// The scalar truth of height maps. Steps are the same, in the same order, as in parallax-inl.h.

#include "rasterizer/internal/sampler_reference.h"

namespace still::internal {

/// Where the view ray through a surface point meets the height field below the surface; `c` itself
/// for surfaces without one. Slopes, and so mip levels, stay those of the surface.
TextureCoordinates displacedCoordinates(const FrameTables& frame, const PixelBarycentrics& p,
                                        const Surface& s, const TextureCoordinates& c);

}  // namespace still::internal
