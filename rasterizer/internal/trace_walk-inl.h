// How rays walk through the trees, for any boxMask(),
// pushChildren(), pushNearestLast() and blockMask(). Included in the middle of a namespace, once
// for each instruction set and once for the scalar truth.

/// Of the block's triangles `mask` those that are some, and have no hole where they are hit. By
/// exact rules nothing hits an empty place, but no index should depend on how a build rounds.
inline uint32_t withoutHoles(const SceneTree& scene, uint32_t instance, const TriangleBlock& block,
                             const BlockHits& hits, uint32_t mask, uint32_t random) {
    uint32_t rest = mask;
    while (rest != 0) {
        const int i = std::countr_zero(rest);
        rest &= rest - 1;
        const uint32_t triangle = block.triangle[i];
        if (triangle == kNoTriangle ||
            ((triangle & kHolesBit) != 0 &&
             holeAt(scene, instance, triangle & ~kHolesBit, hits.b1[i], hits.b2[i], random))) {
            mask &= ~(1u << i);
        }
    }
    return mask;
}

/// A ray on its way through the trees, one node or leaf a step.
struct Walk {
    TraceRay shape;
    const Ray* world = nullptr;
    const BvhNode* nodes = nullptr;  ///< of the mesh it is in, or of the scene
    const TriangleBlock* blocks = nullptr;
    uint32_t instance = kNothingHit;  ///< it is in; kNothingHit: none
    int size = 0;                     ///< of the stack
    int floor = 0;                    ///< what lies below belongs to the scene's tree
    uint32_t stack[kTraceStack];

    void start(const SceneTree& scene, const Ray& ray) {
        shape = TraceRay(ray.origin, ray.direction);
        world = &ray;
        nodes = scene.nodes.data();
        instance = kNothingHit;
        floor = 0;
        stack[0] = 0;
        size = scene.nodes.empty() ? 0 : 1;
    }
    void enter(const SceneTree& scene, uint32_t which) {
        const InstanceTree& i = scene.instances[which];
        if (!i.identity) {
            shape = toObject(i, *world);
        }
        instance = which;
        nodes = i.tree->nodes.data();
        blocks = i.tree->blocks.data();
        floor = size;
        stack[size++] = 0;
    }
    void leave(const SceneTree& scene) {
        if (!scene.instances[instance].identity) {
            shape = TraceRay(world->origin, world->direction);
        }
        instance = kNothingHit;
        nodes = scene.nodes.data();
        floor = 0;
    }
};

enum class Step { goes_on, blocked, free };

inline Step stepOf(const SceneTree& scene, Walk& walk) {
    if (walk.size == walk.floor) {
        if (walk.instance == kNothingHit) {
            return Step::free;
        }
        walk.leave(scene);
        return Step::goes_on;
    }
    const uint32_t at = walk.stack[--walk.size];
    if ((at & kLeafBit) == 0) {
        const BvhNode& node = walk.nodes[at];
        const uint32_t mask = boxMask<false>(node, walk.shape, walk.world->end, nullptr);
        walk.size = pushChildren(node, mask, walk.stack, walk.size);
        return Step::goes_on;
    }
    if (walk.instance == kNothingHit) {
        walk.enter(scene, at & ~kLeafBit);
        return Step::goes_on;
    }
    const TriangleBlock& block = walk.blocks[at & ~kLeafBit];
    BlockHits hits;
    const uint32_t mask = blockMask(block, walk.shape, walk.world->end, hits);
    const bool blocked =
        mask != 0 && withoutHoles(scene, walk.instance, block, hits, mask, walk.world->random) != 0;
    return blocked ? Step::blocked : Step::goes_on;
}

/// Of one ray and the triangles of one instance.
inline bool instanceOccludes(const SceneTree& scene, uint32_t instance, const Ray& ray) {
    Walk walk;
    walk.start(scene, ray);
    walk.size = 0;
    walk.enter(scene, instance);
    Step step = Step::goes_on;
    while (step == Step::goes_on) {
        step = stepOf(scene, walk);
    }
    return step == Step::blocked;
}

/// On its way to the closest hit. Children wait with where the ray enters them; the nearest of a
/// node's comes first, the others as they lie.
struct ClosestWalk : Walk {
    float end = 0.0f;  ///< of what is still looked at
    RayHit best;
    float near_t[kTraceStack];

    void start(const SceneTree& scene, const Ray& ray) {
        Walk::start(scene, ray);
        end = ray.end;
        best = {};
        near_t[0] = 0.0f;
    }
    void enter(const SceneTree& scene, uint32_t which) {
        near_t[size] = 0.0f;
        Walk::enter(scene, which);
    }
    void take(const TriangleBlock& block, const BlockHits& hits, uint32_t mask) {
        for (; mask != 0; mask &= mask - 1) {
            const int i = std::countr_zero(mask);
            const uint32_t triangle = block.triangle[i] & ~kHolesBit;
            const float t = hits.t[i];
            const bool none = best.instance == kNothingHit;
            const bool before =
                instance < best.instance || (instance == best.instance && triangle < best.triangle);
            if (none ? t <= end : t < end || (t == end && before)) {
                end = t;
                best = {t, hits.b1[i], hits.b2[i], instance, triangle};
            }
        }
    }
};

/// False when the ray has come to its end.
inline bool stepOf(const SceneTree& scene, ClosestWalk& walk) {
    if (walk.size == walk.floor) {
        if (walk.instance == kNothingHit) {
            return false;
        }
        walk.leave(scene);
        return true;
    }
    const float end = walk.end * kEndSlack;
    --walk.size;
    if (walk.near_t[walk.size] > end) {
        return true;
    }
    const uint32_t at = walk.stack[walk.size];
    if ((at & kLeafBit) == 0) {
        const BvhNode& node = walk.nodes[at];
        alignas(32) float near_t[kTreeWidth];
        const uint32_t mask = boxMask<true>(node, walk.shape, end, near_t);
        walk.size = pushNearestLast(node, mask, near_t, walk.stack, walk.near_t, walk.size);
        return true;
    }
    if (walk.instance == kNothingHit) {
        walk.enter(scene, at & ~kLeafBit);
        return true;
    }
    const TriangleBlock& block = walk.blocks[at & ~kLeafBit];
    BlockHits hits;
    const uint32_t mask = blockMask(block, walk.shape, end, hits);
    if (mask != 0) {
        walk.take(block, hits,
                  withoutHoles(scene, walk.instance, block, hits, mask, walk.world->random));
    }
    return true;
}

/// Rays take turns: while one waits for a node's memory and arithmetic, the others go on.
inline void occludedRays(const SceneTree& scene, const Ray* rays, int count, uint8_t* blocked) {
    constexpr int kTogether = 8;
    Walk walks[kTogether];
    Walk* active[kTogether];
    int going = std::min(count, kTogether), next = going;
    for (int i = 0; i < going; ++i) {
        walks[i].start(scene, rays[i]);
        active[i] = &walks[i];
    }
    while (going > 0) {
        for (int i = 0; i < going; ++i) {
            Walk& walk = *active[i];
            const Step step = stepOf(scene, walk);
            if (step == Step::goes_on) {
                continue;
            }
            blocked[walk.world - rays] = step == Step::blocked ? 1 : 0;
            if (next < count) {
                walk.start(scene, rays[next++]);
            } else {
                std::swap(active[i], active[--going]);
            }
        }
    }
}

inline void closestOfRays(const SceneTree& scene, const Ray* rays, int count, RayHit* hits) {
    constexpr int kTogether = 8;
    ClosestWalk walks[kTogether];
    ClosestWalk* active[kTogether];
    int going = std::min(count, kTogether), next = going;
    for (int i = 0; i < going; ++i) {
        walks[i].start(scene, rays[i]);
        active[i] = &walks[i];
    }
    while (going > 0) {
        for (int i = 0; i < going; ++i) {
            ClosestWalk& walk = *active[i];
            if (stepOf(scene, walk)) {
                continue;
            }
            hits[walk.world - rays] = walk.best;
            if (next < count) {
                walk.start(scene, rays[next++]);
            } else {
                std::swap(active[i], active[--going]);
            }
        }
    }
}
