// As many shadow rays as there are lanes walk through the tree together: each box and triangle is
// tested by all that have met what it lies in, with the operations that a single ray does. Included
// by trace-inl.h, in the middle of its namespace.

using PacketTag = hn::CappedTag<float, 16>;
using PacketVec = hn::Vec<PacketTag>;
using PacketMask = hn::Mask<PacketTag>;
constexpr int kPacket = int(hn::MaxLanes(PacketTag()));

/// Bit i: lane i.
HWY_INLINE uint32_t packetBits(PacketMask mask) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(PacketTag(), mask, bits);
    return uint32_t{bits[0]} | uint32_t{bits[1]} << 8;
}

/// Rays whose directions have the same signs and the same largest axis.
struct Packet {
    PacketVec origin[3], inverse[3], end, sx, sy, sz;
    int near_at[3], far_at[3];
    int kx, ky, kz;

    /// As TraceRay. False where the rays `active` differ in what they have to share.
    HWY_INLINE bool shape(const PacketVec o[3], const PacketVec direction[3], uint32_t active) {
        const PacketTag d;
        const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        for (int k = 0; k < 3; ++k) {
            const auto least = hn::Set(d, kLeastDirection);
            const auto tiny = hn::Lt(hn::Abs(direction[k]), least);
            origin[k] = o[k];
            inverse[k] =
                div(one, hn::IfThenElse(tiny, hn::CopySign(least, direction[k]), direction[k]));
            const uint32_t negative = packetBits(hn::Lt(inverse[k], zero)) & active;
            if (negative != 0 && negative != active) {
                return false;
            }
            const int high = negative != 0 ? 1 : 0;
            near_at[k] = (high * 3 + k) * kTreeWidth;
            far_at[k] = ((1 - high) * 3 + k) * kTreeWidth;
        }
        const auto x = hn::Abs(direction[0]), y = hn::Abs(direction[1]), z = hn::Abs(direction[2]);
        const uint32_t xy = packetBits(hn::Gt(x, y)), xz = packetBits(hn::Gt(x, z));
        const uint32_t yz = packetBits(hn::Gt(y, z));
        const uint32_t largest[3] = {xy & xz & active, ~xy & yz & active,
                                     ((xy & ~xz) | (~xy & ~yz)) & active};
        kz = 0;
        while (kz < 3 && largest[kz] != active) {
            ++kz;
        }
        if (kz == 3) {
            return false;
        }
        kx = kz == 2 ? 0 : kz + 1;
        ky = kx == 2 ? 0 : kx + 1;
        sz = div(one, direction[kz]);
        sx = hn::Mul(direction[kx], sz);
        sy = hn::Mul(direction[ky], sz);
        return true;
    }

    /// Lanes that meet a child's box.
    HWY_INLINE uint32_t meet(const BvhNode& node, int child) const {
        const PacketTag d;
        const float* bounds = node.bounds[0][0] + child;
        auto entry = hn::Zero(d), exit = end;
        for (int k = 0; k < 3; ++k) {
            const auto near_side = hn::Set(d, bounds[near_at[k]]);
            const auto far_side = hn::Set(d, bounds[far_at[k]]);
            entry = hn::Max(entry, hn::Mul(hn::Sub(near_side, origin[k]), inverse[k]));
            exit = hn::Min(exit, hn::Mul(hn::Sub(far_side, origin[k]), inverse[k]));
        }
        return packetBits(hn::Le(entry, hn::Mul(exit, hn::Set(d, kFarSlack))));
    }

    /// Lanes that hit triangle `i`; b1 and b2 of it are only written where there are some.
    HWY_INLINE uint32_t hit(const TriangleBlock& block, int i, float* b1, float* b2) const {
        const PacketTag d;
        const auto zero = hn::Zero(d);
        PacketVec x[3], y[3], z[3];
        for (int c = 0; c < 3; ++c) {
            const auto& corner = block.corner[c];
            z[c] = hn::Sub(hn::Set(d, corner[kz][i]), origin[kz]);
            x[c] = hn::Sub(hn::Sub(hn::Set(d, corner[kx][i]), origin[kx]), hn::Mul(sx, z[c]));
            y[c] = hn::Sub(hn::Sub(hn::Set(d, corner[ky][i]), origin[ky]), hn::Mul(sy, z[c]));
        }
        const auto u = hn::Sub(hn::Mul(x[2], y[1]), hn::Mul(y[2], x[1]));
        const auto v = hn::Sub(hn::Mul(x[0], y[2]), hn::Mul(y[0], x[2]));
        const auto w = hn::Sub(hn::Mul(x[1], y[0]), hn::Mul(y[1], x[0]));
        const auto least = hn::Min(hn::Min(u, v), w), most = hn::Max(hn::Max(u, v), w);
        const auto inside = hn::Or(hn::Ge(least, zero), hn::Le(most, zero));
        if (hn::AllFalse(d, inside)) {
            return 0;
        }
        const auto det = hn::Add(hn::Add(u, v), w);
        const auto t =
            hn::Add(hn::Add(hn::Mul(u, hn::Mul(sz, z[0])), hn::Mul(v, hn::Mul(sz, z[1]))),
                    hn::Mul(w, hn::Mul(sz, z[2])));
        const auto ahead = hn::IfThenElse(hn::Lt(det, zero), hn::Neg(t), t);
        const auto reached =
            hn::And(hn::Gt(ahead, zero), hn::Le(ahead, hn::Mul(end, hn::Abs(det))));
        const uint32_t bits = packetBits(hn::And(inside, reached));
        if (bits != 0 && (block.triangle[i] & kHolesBit) != 0) {
            hn::StoreU(div(v, det), d, b1);
            hn::StoreU(div(w, det), d, b2);
        }
        return bits;
    }
};

/// Nodes that wait, with the lanes that have met them.
struct PacketStack {
    uint32_t node[kTraceStack];
    uint32_t lanes[kTraceStack];
    int size = 0;

    HWY_INLINE void push(uint32_t at, uint32_t mask) {
        node[size] = at;
        lanes[size++] = mask;
    }
    HWY_INLINE void pushChildren(const BvhNode& parent, const Packet& packet, uint32_t mask) {
        for (int i = 0; i < kTreeWidth && parent.child[i] != kNoChild; ++i) {
            const uint32_t met = packet.meet(parent, i) & mask;
            if (met != 0) {
                push(parent.child[i], met);
            }
        }
    }
};

/// Lanes of `mask` that are blocked by the block's triangles.
HWY_INLINE uint32_t blockedBy(const SceneTree& scene, uint32_t instance, const Packet& packet,
                              const TriangleBlock& block, uint32_t mask, const Ray* rays) {
    float b1[kPacket], b2[kPacket];
    uint32_t blocked = 0;
    for (int i = 0; i < kTreeWidth && block.triangle[i] != kNoTriangle; ++i) {
        uint32_t hit = packet.hit(block, i, b1, b2) & mask & ~blocked;
        if ((block.triangle[i] & kHolesBit) != 0) {
            for (uint32_t rest = hit; rest != 0; rest &= rest - 1) {
                const int lane = std::countr_zero(rest);
                if (holeAt(scene, instance, block.triangle[i] & ~kHolesBit, b1[lane], b2[lane],
                           rays[lane].random)) {
                    hit &= ~(1u << lane);
                }
            }
        }
        blocked |= hit;
    }
    return blocked;
}

/// Lanes of `active` that the instance blocks.
HWY_INLINE uint32_t packetInInstance(const SceneTree& scene, uint32_t instance,
                                     const Packet& packet, uint32_t active, const Ray* rays) {
    const MeshTree& tree = *scene.instances[instance].tree;
    PacketStack stack;
    stack.push(0, active);
    uint32_t blocked = 0;
    while (stack.size > 0 && blocked != active) {
        const uint32_t at = stack.node[--stack.size];
        const uint32_t mask = stack.lanes[stack.size] & ~blocked;
        if (mask == 0) {
            continue;
        }
        if ((at & kLeafBit) == 0) {
            stack.pushChildren(tree.nodes[at], packet, mask);
        } else {
            blocked |= blockedBy(scene, instance, packet, tree.blocks[at & ~kLeafBit], mask, rays);
        }
    }
    return blocked;
}

/// The packet as the instance sees it: as toObject().
HWY_INLINE bool packetToObject(const InstanceTree& instance, const PacketVec o[3],
                               const PacketVec direction[3], uint32_t active, Packet& out) {
    const PacketTag d;
    const float* m = instance.to_object;
    PacketVec object_o[3], object_d[3];
    for (int r = 0; r < 3; ++r) {
        const auto m0 = hn::Set(d, m[r * 4]), m1 = hn::Set(d, m[r * 4 + 1]);
        const auto m2 = hn::Set(d, m[r * 4 + 2]), m3 = hn::Set(d, m[r * 4 + 3]);
        object_o[r] =
            hn::Add(hn::Add(hn::Mul(m0, o[0]), hn::Mul(m1, o[1])), hn::Add(hn::Mul(m2, o[2]), m3));
        object_d[r] = hn::Add(hn::Add(hn::Mul(m0, direction[0]), hn::Mul(m1, direction[1])),
                              hn::Mul(m2, direction[2]));
    }
    return out.shape(object_o, object_d, active);
}

HWY_INLINE void occludedPacket(const SceneTree& scene, const Ray* rays, int count,
                               uint8_t* blocked) {
    const PacketTag d;
    const uint32_t all = (1u << count) - 1u;
    PacketVec o[3], direction[3];
    alignas(64) float lanes[7][kPacket];
    for (int i = 0; i < kPacket; ++i) {
        const Ray& ray = rays[i < count ? i : 0];
        for (int k = 0; k < 3; ++k) {
            lanes[k][i] = ray.origin[k];
            lanes[3 + k][i] = ray.direction[k];
        }
        lanes[6][i] = ray.end;
    }
    for (int k = 0; k < 3; ++k) {
        o[k] = hn::Load(d, lanes[k]);
        direction[k] = hn::Load(d, lanes[3 + k]);
    }
    Packet world, object;
    if (scene.nodes.empty() || !world.shape(o, direction, all)) {
        occludedRays(scene, rays, count, blocked);
        return;
    }
    world.end = object.end = hn::Load(d, lanes[6]);
    PacketStack stack;
    stack.push(0, all);
    uint32_t done = 0;
    while (stack.size > 0 && done != all) {
        const uint32_t at = stack.node[--stack.size];
        const uint32_t mask = stack.lanes[stack.size] & ~done;
        if (mask == 0) {
            continue;
        }
        if ((at & kLeafBit) == 0) {
            stack.pushChildren(scene.nodes[at], world, mask);
            continue;
        }
        const uint32_t i = at & ~kLeafBit;
        const InstanceTree& instance = scene.instances[i];
        if (instance.identity) {
            done |= packetInInstance(scene, i, world, mask, rays);
        } else if (packetToObject(instance, o, direction, mask, object)) {
            done |= packetInInstance(scene, i, object, mask, rays);
        } else {
            for (uint32_t rest = mask; rest != 0; rest &= rest - 1) {
                const int lane = std::countr_zero(rest);
                done |= instanceOccludes(scene, i, rays[lane]) ? 1u << lane : 0u;
            }
        }
    }
    for (int i = 0; i < count; ++i) {
        blocked[i] = uint8_t(done >> i & 1u);
    }
}

void occludedPackets(const SceneTree& scene, const Ray* rays, int count, uint8_t* blocked) {
    for (int i = 0; i < count; i += kPacket) {
        occludedPacket(scene, rays + i, std::min(kPacket, count - i), blocked + i);
    }
}
