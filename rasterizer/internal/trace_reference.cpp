// The scalar truth of the tests of boxes and triangles, and of holes.

#include <bit>

#include "rasterizer/internal/trace.h"

namespace still::internal {

namespace {

/// Bit i: the ray meets the box of child i before `end`; where it enters it.
template <bool kWithNear>
uint32_t boxMask(const BvhNode& node, const TraceRay& ray, float end, float* near_t) {
    const float* bounds = node.bounds[0][0];
    uint32_t mask = 0;
    for (int i = 0; i < kTreeWidth; ++i) {
        float entry = 0.0f, exit = end;
        for (int k = 0; k < 3; ++k) {
            entry = std::max(entry, (bounds[ray.near_at[k] + i] - ray.origin[k]) * ray.inverse[k]);
            exit = std::min(exit, (bounds[ray.far_at[k] + i] - ray.origin[k]) * ray.inverse[k]);
        }
        mask |= entry <= exit * kFarSlack ? 1u << i : 0u;
        if constexpr (kWithNear) {
            near_t[i] = entry;
        }
    }
    return mask;
}

/// Puts the children `mask` onto the stack; returns its new size.
int pushChildren(const BvhNode& node, uint32_t mask, uint32_t* stack, int size) {
    for (; mask != 0; mask &= mask - 1) {
        stack[size++] = node.child[std::countr_zero(mask)];
    }
    return size;
}

/// The same, with where the ray enters them; the nearest, or the first of several, comes last.
int pushNearestLast(const BvhNode& node, uint32_t mask, const float* near_t, uint32_t* stack,
                    float* stack_t, int size) {
    int nearest = -1;
    for (int i = 0; i < kTreeWidth; ++i) {
        const bool hit = (mask >> i & 1u) != 0;
        nearest = hit && (nearest < 0 || near_t[i] < near_t[nearest]) ? i : nearest;
    }
    for (int i = 0; i < kTreeWidth; ++i) {
        if ((mask >> i & 1u) != 0 && i != nearest) {
            stack_t[size] = near_t[i];
            stack[size++] = node.child[i];
        }
    }
    if (nearest >= 0) {
        stack_t[size] = near_t[nearest];
        stack[size++] = node.child[nearest];
    }
    return size;
}

/// Bit i: the ray hits triangle i at 0 < t ≤ end. `hits` is only written where there is one.
uint32_t blockMask(const TriangleBlock& block, const TraceRay& ray, float end, BlockHits& hits) {
    uint32_t mask = 0;
    for (int i = 0; i < kTreeWidth; ++i) {
        float x[3], y[3], z[3];
        for (int c = 0; c < 3; ++c) {
            const auto& p = block.corner[c];
            const float depth = p[ray.kz][i] - ray.origin[ray.kz];
            x[c] = (p[ray.kx][i] - ray.origin[ray.kx]) - ray.sx * depth;
            y[c] = (p[ray.ky][i] - ray.origin[ray.ky]) - ray.sy * depth;
            z[c] = ray.sz * depth;
        }
        const float u = x[2] * y[1] - y[2] * x[1];
        const float v = x[0] * y[2] - y[0] * x[2];
        const float w = x[1] * y[0] - y[1] * x[0];
        const float least = std::min(std::min(u, v), w), most = std::max(std::max(u, v), w);
        const float det = (u + v) + w;
        const float t = (u * z[0] + v * z[1]) + w * z[2];
        const float size = std::fabs(det);
        const float ahead = det < 0.0f ? -t : t;
        if ((least >= 0.0f || most <= 0.0f) && ahead > 0.0f && ahead <= end * size) {
            mask |= 1u << i;
            hits.t[i] = t / det;
            hits.b1[i] = v / det;
            hits.b2[i] = w / det;
        }
    }
    return mask;
}

#include "rasterizer/internal/trace_walk-inl.h"

uint32_t texelAt(const std::vector<TextureLevel>& levels, Wrap wrap, float u, float v) {
    const TextureLevel& level = levels[0];
    const auto along = [&](float c, uint32_t size) {
        const float wrapped =
            wrap == Wrap::repeat ? c - std::floor(c) : std::min(std::max(c, 0.0f), 1.0f);
        const int i = int(wrapped * float(int32_t(size)));
        return uint32_t(std::min(i, int(size) - 1));
    };
    return level.offset + along(1.0f - v, level.height) * level.stride + along(u, level.width);
}

}  // namespace

bool holeAt(const SceneTree& scene, uint32_t instance, uint32_t triangle, float b1, float b2,
            uint32_t random) {
    const Mesh& mesh = *scene.instances[instance].mesh;
    const auto part = std::upper_bound(
        mesh.parts.begin(), mesh.parts.end(), triangle,
        [](uint32_t t, const MeshPart& p) { return t < p.first_triangle + p.triangle_count; });
    const Material& m = scene.list->materials[part->material];
    float alpha = m.opacity;
    if (m.alpha_texture != kNoTexture) {
        const uint32_t* index = &mesh.indices[size_t(triangle) * 3];
        const float b0 = (1.0f - b1) - b2;
        const auto& a = mesh.attributes;
        const float u =
            ((b0 * a[index[0]].u + b1 * a[index[1]].u) + b2 * a[index[2]].u) + m.u_offset;
        const float v =
            ((b0 * a[index[0]].v + b1 * a[index[1]].v) + b2 * a[index[2]].v) + m.v_offset;
        const AlphaTexture& texture = scene.list->alpha_textures[size_t(m.alpha_texture)];
        alpha = alpha *
                float(int32_t{texture.texels[texelAt(texture.levels, texture.wrap, u, v)]}) *
                (1.0f / 255.0f);
    }
    if (m.alpha_mode != AlphaMode::stochastic) {
        return alpha < 0.5f;
    }
    uint32_t h = random ^ (uint32_t(part - mesh.parts.begin()) + instance * 61u) * 0xC2B2AE3Du;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    return float(int32_t(h >> 16)) >= alpha * 65536.0f;
}

TraceKernels traceReference() {
    return {occludedRays, occludedRays, closestOfRays};
}

}  // namespace still::internal
