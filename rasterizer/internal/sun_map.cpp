#include "rasterizer/internal/sun_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "rasterizer/internal/geometry.h"
#include "rasterizer/internal/shading_constants.h"

namespace still::internal {

namespace {

constexpr int kSmallest = 512, kLargest = 4096;
/// What is in a ray's way is looked for in pieces, each twice as long as the one before: the first
/// one goes over so many texels, or is such a part of the way up.
constexpr float kFirstTexels = 0.5f, kFirstPart = 1.0f / 128.0f;
/// Where it begins lies so many texels off the surface, so that this does not shadow itself.
constexpr float kOffTexels = 1.5f;

double along(const Float3& axis, const double p[3]) {
    return (double(axis.x) * p[0] + double(axis.y) * p[1]) + double(axis.z) * p[2];
}

/// The smallest of 1, 1 1/8, 1 2/8 … 2, 2 2/8 … that is not below `size`: a scene that grows a
/// little keeps its texels.
double roundedUp(double size) {
    int exponent = 0;
    std::frexp(size, &exponent);
    const double step = std::ldexp(1.0, exponent - 4);
    return std::ceil(size / step) * step;
}

/// The same surfaces, of no more than shape and holes.
std::vector<Material> shapesOf(std::span<const Material> materials) {
    std::vector<Material> shapes(materials.begin(), materials.end());
    for (Material& material : shapes) {
        material.colour_texture = material.normal_texture = material.height_texture = kNoTexture;
        material.specular = {0, 0, 0};
    }
    return shapes;
}

}  // namespace

bool SunMap::isOf(const DrawList& list, int size) const {
    return meshes_ == list.meshes.data() && view_.width == size &&
           sun_.direction == list.lighting.sun.direction &&
           std::equal(transforms_.begin(), transforms_.end(), list.instances.begin(),
                      list.instances.end(),
                      [](const Affine& a, const Instance& b) { return a == b.transform; }) &&
           std::equal(materials_.begin(), materials_.end(), list.materials.begin(),
                      list.materials.end());
}

void SunMap::remember(const DrawList& list) {
    meshes_ = list.meshes.data();
    sun_ = list.lighting.sun;
    transforms_.clear();
    for (const Instance& instance : list.instances) {
        transforms_.push_back(instance.transform);
    }
    materials_.assign(list.materials.begin(), list.materials.end());
}

SunMap::Box SunMap::boundsOf(const DrawList& list, SimdTarget simd) {
    Box box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (const Instance& instance : list.instances) {
        const Mesh& mesh = list.meshes[instance.mesh];
        if (mesh.vertexCount() == 0) {
            continue;
        }
        const PositionBox of_mesh = geometryFor(simd).boundVertices(mesh.x.data(), mesh.y.data(),
                                                                    mesh.z.data(), mesh.x.size());
        for (int corner = 0; corner < 8; ++corner) {
            double q[3], p[3];
            for (int axis = 0; axis < 3; ++axis) {
                const bool high = (corner >> axis & 1) != 0;
                q[axis] = double(high ? of_mesh.high[axis] : of_mesh.low[axis]);
            }
            for (size_t r = 0; r < 3; ++r) {
                const float* m = instance.transform.data() + 4 * r;
                p[r] = (double(m[0]) * q[0] + double(m[1]) * q[1]) +
                       (double(m[2]) * q[2] + double(m[3]));
            }
            const Float3* axes[3] = {&across_u_, &across_v_, &up_};
            for (int axis = 0; axis < 3; ++axis) {
                const double at = along(*axes[axis], p);
                box.low[axis] = std::min(box.low[axis], at);
                box.high[axis] = std::max(box.high[axis], at);
            }
        }
    }
    return box;
}

/// The map's corner lies on a grid of texels, so that it does not crawl when something leaves the
/// scene's bounds.
void SunMap::place(const Box& box, int size) {
    const double width = box.high[0] - box.low[0], depth = box.high[1] - box.low[1];
    const double extent = roundedUp(std::max({width, depth, 1e-6}) * 1.01);
    const double texel = extent / size;
    const double range = roundedUp(std::max(box.high[2] - box.low[2], 1e-6) * 1.02) + texel;
    const double low[3] = {std::floor(box.low[0] / texel) * texel,
                           std::floor(box.low[1] / texel) * texel,
                           std::floor((box.low[2] - 0.005 * range) / texel) * texel};
    origin_u_ = float(low[0]);
    origin_v_ = float(low[1]);
    base_ = float(low[2]);
    range_ = float(range);
    texel_ = float(texel);
    view_.width = view_.height = size;
    const Float3* axes[3] = {&across_u_, &across_v_, &up_};
    const double scale[3] = {2 / extent, 2 / extent, -2 / range};
    for (int row = 0; row < 3; ++row) {
        const double axis[3] = {double(axes[row]->x), double(axes[row]->y), double(axes[row]->z)};
        for (int column = 0; column < 3; ++column) {
            view_.view_projection[column][row] = axis[column] * scale[row];
        }
        const double corner = row == 2 ? 1.0 : -1.0;
        view_.view_projection[3][row] = corner - low[row] * scale[row];
    }
    view_.view_projection_before = view_.view_projection;
}

void SunMap::update(const DrawList& list, int pixels, SimdTarget simd, Workers& workers) {
    const int size = std::clamp(int(std::bit_ceil(unsigned(pixels))), kSmallest, kLargest);
    if (isOf(list, size)) {
        return;
    }
    const std::array<float, 3>& d = list.lighting.sun.direction;
    up_ = {-d[0], -d[1], -d[2]};
    acrossOf(up_, across_u_, across_v_);
    remember(list);
    const Box box = boundsOf(list, simd);
    if (!(box.low[0] <= box.high[0])) {
        drawn_ = {};
        return;
    }
    place(box, size);
    const std::vector<Material> shapes = shapesOf(list.materials);
    DrawList seen = list;
    seen.materials = shapes;
    seen.lighting = {};
    rasterizer_.transformAndBin(seen, view_, {.simd = simd, .planes = {}}, workers);
    rasterizer_.rasterize(drawn_, workers);
}

bool SunMap::blocks(const LitPoint& point, const Ray& ray, const RandomPair& random) const {
    if (drawn_.depth.empty()) {
        return false;
    }
    const Float3 direction{ray.direction[0], ray.direction[1], ray.direction[2]};
    const float rise = dot(direction, up_);
    if (!(rise > 0.0f)) {
        return true;
    }
    const float off = kOffTexels * texel_;
    const Float3 start{point.origin.x + point.normal.x * off, point.origin.y + point.normal.y * off,
                       point.origin.z + point.normal.z * off};
    // In texels, anywhere in one, and texels for each unit of height.
    const float per_length = 1.0f / texel_, per_height = per_length / rise;
    const float u = (dot(across_u_, start) - origin_u_) * per_length + toUnit(random.x) - 0.5f;
    const float v = (dot(across_v_, start) - origin_v_) * per_length + toUnit(random.y) - 0.5f;
    const float u_slope = dot(direction, across_u_) * per_height;
    const float v_slope = dot(direction, across_v_) * per_height;
    const float height = dot(up_, start) - base_;
    const float ahead = toUnit((random.x ^ random.y >> 3) * kHashX);
    const float size = float(view_.width), top = range_ - height;
    const float sideways = std::max({std::fabs(u_slope), std::fabs(v_slope), kTiny});
    float begin = 0.0f, end = std::max(kFirstTexels / sideways, top * kFirstPart);
    while (begin < top) {
        const float at = begin + (std::min(end, top) - begin) * ahead;
        const float x = u + u_slope * at, y = v + v_slope * at;
        if (x >= 0.0f && x < size && y >= 0.0f && y < size) {
            const uint32_t depth = drawn_.depth.at(int(x), view_.width - 1 - int(y));
            const float seen = std::bit_cast<float>(depth) * range_ - height;
            if (seen > begin && seen <= end) {
                return true;
            }
        }
        begin = end;
        end = end * 2.0f;
    }
    return false;
}

}  // namespace still::internal
