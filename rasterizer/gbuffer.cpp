#include "rasterizer/gbuffer.h"

#include <algorithm>
#include <cmath>

namespace still {

void GBuffer::resize(int width, int height, PlaneSet wanted) {
    if (width != this->width() || height != this->height() || wanted != planes) {
        motion_is_zero.clear();
    }
    planes = wanted;
    red.resize(width, height);
    green.resize(width, height);
    blue.resize(width, height);
    depth.resize(width, height);
    id.resize(width, height);
    normal.resize(wanted.normal ? width : 0, wanted.normal ? height : 0);
    for (Image<uint16_t>* plane : {&albedo_red, &albedo_green, &albedo_blue}) {
        plane->resize(wanted.albedo ? width : 0, wanted.albedo ? height : 0);
    }
    motion.resize(wanted.motion ? width : 0, wanted.motion ? height : 0);
    depth_before.resize(wanted.motion ? width : 0, wanted.motion ? height : 0);
    tiles_x = (width + kTileSize - 1) / kTileSize;
    tiles_y = (height + kTileSize - 1) / kTileSize;
    tiles.resize(size_t(tiles_x) * size_t(tiles_y));
    motion_is_zero.resize(tiles.size(), 0);
}

NormalVector decodeOctahedral(uint32_t packed) {
    const float u = float(int16_t(packed & 0xFFFF)) / 32767.0f;
    const float v = float(int16_t(packed >> 16)) / 32767.0f;
    NormalVector n{u, v, 1.0f - std::fabs(u) - std::fabs(v)};
    if (n.z < 0.0f) {
        n.x = (1.0f - std::fabs(v)) * (u < 0.0f ? -1.0f : 1.0f);
        n.y = (1.0f - std::fabs(u)) * (v < 0.0f ? -1.0f : 1.0f);
    }
    return n;
}

}  // namespace still
