// How rays walk through the trees, for any boxMask(),
// pushChildren() and blockMask(). Included in the middle of a namespace, once for each instruction
// set and once for the scalar truth.

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

/// A ray on its way to whatever is in it, one node or leaf a step.
struct OcclusionWalk {
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

inline Step stepOf(const SceneTree& scene, OcclusionWalk& walk) {
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

/// Rays take turns: while one waits for a node's memory and arithmetic, the others go on.
inline void occludedRays(const SceneTree& scene, const Ray* rays, int count, uint8_t* blocked) {
    constexpr int kTogether = 8;
    OcclusionWalk walks[kTogether];
    OcclusionWalk* active[kTogether];
    int going = std::min(count, kTogether), next = going;
    for (int i = 0; i < going; ++i) {
        walks[i].start(scene, rays[i]);
        active[i] = &walks[i];
    }
    while (going > 0) {
        for (int i = 0; i < going; ++i) {
            OcclusionWalk& walk = *active[i];
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
    for (int i = 0; i < count; ++i) {
        hits[i] = closestInScene(scene, rays[i]);
    }
}
