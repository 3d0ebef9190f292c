// Steep parallax mapping (McGuire and McGuire 2005): the ray is followed in equal steps of depth
// until it is below the ground; the crossing is interpolated between the last two steps, as in
// parallax occlusion mapping (Tatarchuk 2006).
//
//   eye  ╲                       depth 0: the surface, height 255
//  ───────●───────────────────
//          ╲  1     ▁▂▃▄▅▆▇      depth d: texture coordinates uv + d · slope
//       ▂▃▄▅╲▄▃▂▁▁▂▃
//  ──────────●────────────────   depth 1: height_scale below, height 0

#include "rasterizer/internal/parallax_reference.h"

namespace still::internal {

namespace {

/// Change of the texture coordinates along the ray from depth 0 to depth 1.
struct RaySlope {
    float u, v;
};

RaySlope raySlope(const FrameTables& frame, const PixelBarycentrics& p, const Surface& s) {
    const InstanceSetup& instance = frame.instances[s.instance];
    const Float3 n = worldNormal(p, s, instance);
    const Float3 t = worldTangent(p, s, instance);
    const Float3 b = worldBitangent(p, s, instance, n, t);
    const Float3 to_eye = towardsEye(*frame.view, worldPosition(p, s, instance));
    const float cosine = larger(dot(n, to_eye) * p.triangle->flip, kParallaxMinCosine);
    const float scale = s.material->height_scale / cosine;
    return {dot(t, to_eye) * -scale, dot(b, to_eye) * -scale};
}

}  // namespace

TextureCoordinates displacedCoordinates(const FrameTables& frame, const PixelBarycentrics& p,
                                        const Surface& s, const TextureCoordinates& c) {
    if (s.height == nullptr) {
        return c;
    }
    const RaySlope slope = raySlope(frame, p, s);
    TextureCoordinates at = c;
    float gap_before = 0.0f, depth = 0.0f;
    for (int i = 0; i <= kParallaxSteps; ++i) {
        depth = float(i) * kParallaxStep;
        at.u = c.u + slope.u * depth;
        at.v = c.v + slope.v * depth;
        // Of the ray above the ground; never positive in the last step.
        const float gap = (1.0f - sampleAlpha(*s.height, at, s.mip_bias_fx8)) - depth;
        if (gap <= 0.0f) {
            const float back = gap / smaller(gap - gap_before, -kTiny);  // in steps, 0 … 1
            depth = i == 0 ? 0.0f : depth - back * kParallaxStep;
            break;
        }
        gap_before = gap;
    }
    at.u = c.u + slope.u * depth;
    at.v = c.v + slope.v * depth;
    return at;
}

}  // namespace still::internal
