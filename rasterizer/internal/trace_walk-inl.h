// How rays walk through the trees, for any pair of boxMask() and blockMask(). Included in the
// middle of a namespace, once for each instruction set and once for the scalar truth.

/// Whether the block's triangles `mask` have a hole at each place they are hit: those that have
/// none stay.
inline uint32_t withoutHoles(const SceneTree& scene, uint32_t instance, const TriangleBlock& block,
                             const BlockHits& hits, uint32_t mask, uint32_t random) {
    uint32_t rest = mask;
    while (rest != 0) {
        const int i = std::countr_zero(rest);
        rest &= rest - 1;
        const uint32_t triangle = block.triangle[i];
        if ((triangle & kHolesBit) != 0 &&
            holeAt(scene, instance, triangle & ~kHolesBit, hits.b1[i], hits.b2[i], random)) {
            mask &= ~(1u << i);
        }
    }
    return mask;
}

inline bool meshOccludes(const SceneTree& scene, uint32_t instance, const TraceRay& ray,
                         const Ray& world) {
    const MeshTree& tree = *scene.instances[instance].tree;
    uint32_t stack[kTraceStack];
    int size = 1;
    stack[0] = 0;
    BlockHits hits;
    while (size > 0) {
        const uint32_t at = stack[--size];
        if ((at & kLeafBit) == 0) {
            const BvhNode& node = tree.nodes[at];
            for (uint32_t mask = boxMask<false>(node, ray, world.end, nullptr); mask != 0;
                 mask &= mask - 1) {
                stack[size++] = node.child[std::countr_zero(mask)];
            }
            continue;
        }
        const TriangleBlock& block = tree.blocks[at & ~kLeafBit];
        const uint32_t mask = blockMask(block, ray, world.end, hits);
        if (mask != 0 && withoutHoles(scene, instance, block, hits, mask, world.random) != 0) {
            return true;
        }
    }
    return false;
}

inline bool sceneOccludes(const SceneTree& scene, const Ray& world) {
    if (scene.nodes.empty()) {
        return false;
    }
    const TraceRay ray(world.origin, world.direction);
    uint32_t stack[kTraceStack];
    int size = 1;
    stack[0] = 0;
    while (size > 0) {
        const uint32_t at = stack[--size];
        if ((at & kLeafBit) == 0) {
            const BvhNode& node = scene.nodes[at];
            for (uint32_t mask = boxMask<false>(node, ray, world.end, nullptr); mask != 0;
                 mask &= mask - 1) {
                stack[size++] = node.child[std::countr_zero(mask)];
            }
            continue;
        }
        const uint32_t i = at & ~kLeafBit;
        const InstanceTree& instance = scene.instances[i];
        if (meshOccludes(scene, i, instance.identity ? ray : toObject(instance, world), world)) {
            return true;
        }
    }
    return false;
}

/// Children that wait for their turn, the nearest on top.
struct NearestFirst {
    uint32_t child[kTraceStack];
    float near_t[kTraceStack];
    int size = 0;

    void push(const BvhNode& node, uint32_t mask, const float* t) {
        const int first = size;
        for (; mask != 0; mask &= mask - 1) {
            const int i = std::countr_zero(mask);
            int at = size++;
            for (; at > first && near_t[at - 1] < t[i]; --at) {
                near_t[at] = near_t[at - 1];
                child[at] = child[at - 1];
            }
            near_t[at] = t[i];
            child[at] = node.child[i];
        }
    }
    /// False when nothing is left that may be as near as `end`.
    bool pop(float end, uint32_t& at) {
        while (size > 0) {
            --size;
            if (near_t[size] <= end) {
                at = child[size];
                return true;
            }
        }
        return false;
    }
};

inline void closestInMesh(const SceneTree& scene, uint32_t instance, const TraceRay& ray,
                          const Ray& world, float& end, RayHit& best) {
    const MeshTree& tree = *scene.instances[instance].tree;
    NearestFirst stack;
    stack.child[0] = 0;
    stack.near_t[0] = 0.0f;
    stack.size = 1;
    BlockHits hits;
    alignas(32) float near_t[kTreeWidth];
    uint32_t at = 0;
    while (stack.pop(end * kEndSlack, at)) {
        if ((at & kLeafBit) == 0) {
            const uint32_t mask = boxMask<true>(tree.nodes[at], ray, end * kEndSlack, near_t);
            stack.push(tree.nodes[at], mask, near_t);
            continue;
        }
        const TriangleBlock& block = tree.blocks[at & ~kLeafBit];
        uint32_t mask = blockMask(block, ray, end * kEndSlack, hits);
        if (mask != 0) {
            mask = withoutHoles(scene, instance, block, hits, mask, world.random);
        }
        for (; mask != 0; mask &= mask - 1) {
            const int i = std::countr_zero(mask);
            const uint32_t triangle = block.triangle[i] & ~kHolesBit;
            const bool tie = hits.t[i] == best.t && best.instance != kNothingHit &&
                             (instance < best.instance ||
                              (instance == best.instance && triangle < best.triangle));
            const bool first = best.instance == kNothingHit && hits.t[i] <= end;
            if (hits.t[i] < end || first || tie) {
                end = hits.t[i];
                best = {hits.t[i], hits.b1[i], hits.b2[i], instance, triangle};
            }
        }
    }
}

inline RayHit closestInScene(const SceneTree& scene, const Ray& world) {
    RayHit best;
    if (scene.nodes.empty()) {
        return best;
    }
    const TraceRay ray(world.origin, world.direction);
    float end = world.end;
    NearestFirst stack;
    stack.child[0] = 0;
    stack.near_t[0] = 0.0f;
    stack.size = 1;
    alignas(32) float near_t[kTreeWidth];
    uint32_t at = 0;
    while (stack.pop(end * kEndSlack, at)) {
        if ((at & kLeafBit) == 0) {
            const uint32_t mask = boxMask<true>(scene.nodes[at], ray, end * kEndSlack, near_t);
            stack.push(scene.nodes[at], mask, near_t);
            continue;
        }
        const uint32_t i = at & ~kLeafBit;
        const InstanceTree& instance = scene.instances[i];
        closestInMesh(scene, i, instance.identity ? ray : toObject(instance, world), world, end,
                      best);
    }
    return best;
}

inline void occludedRays(const SceneTree& scene, const Ray* rays, int count, uint8_t* blocked) {
    for (int i = 0; i < count; ++i) {
        blocked[i] = sceneOccludes(scene, rays[i]) ? 1 : 0;
    }
}

inline void closestOfRays(const SceneTree& scene, const Ray* rays, int count, RayHit* hits) {
    for (int i = 0; i < count; ++i) {
        hits[i] = closestInScene(scene, rays[i]);
    }
}
