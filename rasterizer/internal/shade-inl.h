// Shading, one pixel per lane; see shade_reference.cpp for the truth.
// Included once per target by kernels_simd.cpp. Phases of a group of lanes: barycentrics → texture
// coordinates → normal → light → colour → merge into the group's outputs. Depth and motion of what
// stands still go before, in a pass of their own.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace shading {
namespace hn = hwy::HWY_NAMESPACE;

/// Motion and earlier depth as the planes hold them.
struct LaneMotion {
    IVec packed;  ///< Motion: x in the low half
    IVec depth_before;
};

struct LaneColour {
    IVec red, green, blue;
};

/// What shading finds out about a group of pixels, as 32-bit lanes until it is stored.
struct GroupOutput {
    IVec red, green, blue, id;
    IVec normal;
    LaneColour albedo;  ///< 0 where nobody wants it
    bool own_motion;    ///< the surface moves by itself; otherwise `motion` is not used
    LaneMotion motion;
};

/// Consecutive pixels of a row.
struct Group {
    const TileContext* tile;
    FVec x, y;     ///< tile-local
    ptrdiff_t at;  ///< of the first lane in the planes
};

HWY_INLINE IVec toFx12(FVec linear) {
    const FVec bounded = hn::Min(hn::Max(linear, hn::Zero(FTag())), splat(kColourMax));
    return roundSmall(hn::Mul(bounded, splat(kColourScale)));
}

HWY_INLINE IVec packOctahedral(const Vec3& n) {
    const FVec zero = hn::Zero(FTag()), one = splat(1.0f);
    const FVec sum =
        hn::Max(hn::Add(hn::Add(hn::Abs(n.x), hn::Abs(n.y)), hn::Abs(n.z)), splat(kTiny));
    const FVec inv = div(one, sum);
    const FVec px = hn::Mul(n.x, inv), py = hn::Mul(n.y, inv);
    const auto snorm = [](FVec f) {
        return hn::And(roundSmall(hn::Mul(f, splat(kSnormScale))), splatInt(0xFFFF));
    };
    const auto below = hn::Lt(n.z, zero);
    if (hn::AllFalse(FTag(), below)) {
        return hn::Or(snorm(px), hn::ShiftLeft<16>(snorm(py)));
    }
    const auto sign = [&](FVec v) { return hn::IfThenElse(hn::Lt(v, zero), splat(-1.0f), one); };
    const FVec u = hn::IfThenElse(below, hn::Mul(hn::Sub(one, hn::Abs(py)), sign(px)), px);
    const FVec v = hn::IfThenElse(below, hn::Mul(hn::Sub(one, hn::Abs(px)), sign(py)), py);
    return hn::Or(snorm(u), hn::ShiftLeft<16>(snorm(v)));
}

struct LaneReprojected {
    FVec x, y, depth, w;
};

HWY_INLINE FVec safeInverse(FVec w) {
    const FVec one = splat(1.0f);
    return div(one, hn::IfThenElse(hn::Gt(w, splat(1e-20f)), w, one));
}

HWY_INLINE LaneReprojected reprojectStatic(const TileContext& tile, FVec x, FVec y, FVec depth) {
    const auto& m = tile.reproject.m;
    FVec q[4];
    for (int i = 0; i < 4; ++i) {
        q[i] = hn::Add(hn::Add(hn::Add(hn::Mul(splat(m[i][0]), x), hn::Mul(splat(m[i][1]), y)),
                               hn::Mul(splat(m[i][2]), depth)),
                       splat(m[i][3]));
    }
    const FVec inv = safeInverse(q[3]);
    return {hn::Sub(hn::Mul(q[0], inv), x), hn::Sub(hn::Mul(q[1], inv), y), hn::Mul(q[2], inv),
            q[3]};
}

HWY_INLINE LaneReprojected reprojectMoved(const InstanceSetup& instance, const Vec3& p) {
    const auto& now = instance.pixels_now.m;
    const auto& before = instance.pixels_before.m;
    const FVec w_before = affineRow(before[3], p);
    const FVec inv_now = safeInverse(affineRow(now[3], p));
    const FVec inv_before = safeInverse(w_before);
    const auto difference = [&](int row) {
        return hn::Sub(hn::Mul(affineRow(before[row], p), inv_before),
                       hn::Mul(affineRow(now[row], p), inv_now));
    };
    return {difference(0), difference(1), hn::Mul(affineRow(before[2], p), inv_before), w_before};
}

HWY_INLINE IVec logDepthLanes(FVec depth) {
    const FVec positive = hn::IfThenElseZero(hn::Gt(depth, hn::Zero(FTag())), depth);
    constexpr int32_t kTop = int32_t(0x3F800000u >> 12) - 65535;
    const IVec v = hn::Sub(hn::ShiftRight<12>(hn::BitCast(ITag(), positive)), splatInt(kTop));
    return hn::Min(hn::Max(v, splatInt(0)), splatInt(65535));
}

HWY_INLINE LaneMotion motionOf(const LaneReprojected& r) {
    const FVec limit = splat(kMotionMax_px);
    const FMask known = hn::And(hn::Gt(r.w, splat(1e-20f)),
                                hn::And(hn::Lt(hn::Abs(r.x), limit), hn::Lt(hn::Abs(r.y), limit)));
    const auto known_i = hn::RebindMask(ITag(), known);
    const auto fx8 = [&](FVec v) {
        return roundSmall(hn::Mul(hn::IfThenElseZero(known, v), splat(kMotionScale)));
    };
    const IVec x = hn::And(fx8(r.x), splatInt(0xFFFF));
    const IVec packed = hn::Or(x, hn::ShiftLeft<16>(fx8(r.y)));
    return {hn::IfThenElse(known_i, packed, splatInt(int32_t{kNoHistory} & 0xFFFF)),
            hn::IfThenElseZero(known_i, logDepthLanes(hn::IfThenElseZero(known, r.depth)))};
}

using U16Tag = hn::Rebind<uint16_t, ITag>;

HWY_INLINE IVec loadU16(const uint16_t* from) {
    return hn::PromoteTo(ITag(), hn::LoadU(U16Tag(), from));
}

HWY_INLINE void storeU16(IVec v, uint16_t* to) {
    hn::StoreU(hn::DemoteTo(U16Tag(), v), U16Tag(), to);
}

HWY_INLINE void storeMotion(const TilePlanes& planes, ptrdiff_t at, const LaneMotion& m) {
    hn::StoreU(m.packed, ITag(), reinterpret_cast<int32_t*>(planes.motion + at));
    storeU16(m.depth_before, planes.depth_before + at);
}

/// What follows from the depth alone: its plane, and motion as if nothing but the camera moved.
HWY_NOINLINE void writeDepthAndMotion(const TileContext& tile) {
    const TilePlanes& planes = tile.planes;
    const int lanes = int(hn::Lanes(FTag()));
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; x += lanes) {
            const FVec depth = hn::LoadU(FTag(), tile.depth + y * kTileSize + x);
            const ptrdiff_t at = y * planes.stride + x;
            hn::StoreU(hn::BitCast(UTag(), depth), UTag(), planes.depth + at);
            if (planes.motion != nullptr) {
                storeMotion(planes, at,
                            motionOf(reprojectStatic(tile, hn::Iota(FTag(), float(x)),
                                                     splat(float(y)), depth)));
            } else if (planes.depth_before != nullptr) {
                storeU16(logDepthLanes(depth), planes.depth_before + at);
            }
        }
    }
}

/// kLevel: shadeLevel().
template <int kLevel, bool kUniform>
HWY_INLINE GroupOutput shadeSurface(const TileContext& tile, FVec x, FVec y,
                                    const LaneTriangles<kUniform>& t, uint32_t surface) {
    const FrameTables& frame = *tile.frame;
    const Surface& s = frame.surfaces[surface];
    const InstanceSetup& instance = frame.instances[s.instance];
    const LaneBarycentrics p = barycentrics(t, x, y);
    LaneTexture c{};
    if (kLevel >= 1 && (s.features & (kShadeTexture | kShadeNormalMap)) != 0) {
        c = textureCoordinates(t, p, s);
        if (kLevel >= 3 && s.height != nullptr) {
            c = displacedCoordinates(frame, t, p, s, c);
        }
    }
    LaneSample sample;
    if (kLevel >= 1 && s.colour != nullptr) {
        findTexels(*s.colour, c, s.mip_bias_fx8, sample);
    }
    const Vec3 n = shadingNormal<kLevel >= 2>(t, p, s, instance, c, sample);
    const LaneLight lit = lightSurface<kLevel >= 2>(tile, t, p, s, instance, n);
    const Material& m = *s.material;
    Vec3 albedo{splat(m.diffuse[0]), splat(m.diffuse[1]), splat(m.diffuse[2])};
    if (kLevel >= 1 && s.colour != nullptr) {
        const Vec3 texel = sampleTexture<true>(*s.colour, sample, kTexelToLinear);
        albedo = {hn::Mul(albedo.x, texel.x), hn::Mul(albedo.y, texel.y),
                  hn::Mul(albedo.z, texel.z)};
    }
    Vec3 colour{hn::Add(hn::Mul(albedo.x, lit.diffuse.x), splat(m.emission[0])),
                hn::Add(hn::Mul(albedo.y, lit.diffuse.y), splat(m.emission[1])),
                hn::Add(hn::Mul(albedo.z, lit.diffuse.z), splat(m.emission[2]))};
    if (kLevel >= 2 && s.shininess > 0) {
        colour = {hn::Add(colour.x, hn::Mul(splat(m.specular[0]), lit.specular.x)),
                  hn::Add(colour.y, hn::Mul(splat(m.specular[1]), lit.specular.y)),
                  hn::Add(colour.z, hn::Mul(splat(m.specular[2]), lit.specular.z))};
    }
    const IVec zero = hn::Zero(ITag());
    GroupOutput out{toFx12(colour.x),
                    toFx12(colour.y),
                    toFx12(colour.z),
                    splatInt(int32_t(surface | (instance.moved ? kMovedBit : 0u))),
                    zero,
                    {zero, zero, zero},
                    instance.own_motion && tile.planes.motion != nullptr,
                    {zero, zero}};
    if (frame.planes.normal) {
        out.normal = packOctahedral(n);
    }
    if (frame.planes.albedo) {
        out.albedo = {toFx12(albedo.x), toFx12(albedo.y), toFx12(albedo.z)};
    }
    if (out.own_motion) {
        out.motion = motionOf(reprojectMoved(instance, attribute3(t, p, kQuadPosition)));
    }
    return out;
}

HWY_INLINE void storeAlbedo(const TilePlanes& planes, ptrdiff_t at, const LaneColour& albedo) {
    storeU16(albedo.red, planes.albedo_red + at);
    storeU16(albedo.green, planes.albedo_green + at);
    storeU16(albedo.blue, planes.albedo_blue + at);
}

/// Without motion.
HWY_INLINE void storePlanes(const TilePlanes& planes, ptrdiff_t at, const GroupOutput& out) {
    storeU16(out.red, planes.red + at);
    storeU16(out.green, planes.green + at);
    storeU16(out.blue, planes.blue + at);
    storeU16(out.id, planes.id + at);
    if (planes.normal != nullptr) {
        hn::StoreU(out.normal, ITag(), reinterpret_cast<int32_t*>(planes.normal + at));
    }
    if (planes.albedo_red != nullptr) {
        storeAlbedo(planes, at, out.albedo);
    }
}

HWY_INLINE void storeBackground(const Group& group) {
    const std::array<float, 3>& background = group.tile->frame->list->background;
    const IVec zero = hn::Zero(ITag());
    storePlanes(group.tile->planes, group.at,
                {toFx12(splat(background[0])),
                 toFx12(splat(background[1])),
                 toFx12(splat(background[2])),
                 zero,
                 zero,
                 {zero, zero, zero},
                 false,
                 {zero, zero}});
}

/// All lanes show triangle `ref`.
template <int kLevel>
HWY_NOINLINE void shadeUniform(const Group& group, uint32_t ref) {
    const TileContext& tile = *group.tile;
    const LaneTriangles<true> t{&tile.shade[ref]};
    const GroupOutput out = shadeSurface<kLevel>(tile, group.x, group.y, t, uint32_t(t.t->surface));
    storePlanes(tile.planes, group.at, out);
    if (out.own_motion) {
        storeMotion(tile.planes, group.at, out.motion);
    }
}

/// Lanes show the triangles `refs` of one surface.
template <int kLevel>
HWY_NOINLINE GroupOutput shadeMixed(const TileContext& tile, FVec x, FVec y, IVec refs,
                                    uint32_t surface) {
    alignas(64) int32_t first_word[hn::MaxLanes(ITag())];
    hn::Store(hn::ShiftLeft<6>(refs), ITag(), first_word);
    static_assert(sizeof(ShadeTriangle) == 4 << 6);
    const LaneTriangles<false> t{reinterpret_cast<const float*>(tile.shade), first_word};
    return shadeSurface<kLevel>(tile, x, y, t, surface);
}

/// Pixels of one surface from groups that show several ones, until there are enough for a group.
struct PixelQueue {
    static constexpr int kCapacity = 2 * int(hn::MaxLanes(ITag()));
    int32_t surface = 0;
    int count = 0;
    alignas(64) int32_t pixel[kCapacity] = {};  ///< y · kTileSize + x
    alignas(64) int32_t ref[kCapacity] = {};
};

HWY_INLINE void storeQueuedAlbedo(const TilePlanes& planes, const PixelQueue& queue, int count,
                                  const LaneColour& albedo) {
    alignas(64) int32_t value[3][hn::MaxLanes(ITag())];
    hn::Store(albedo.red, ITag(), value[0]);
    hn::Store(albedo.green, ITag(), value[1]);
    hn::Store(albedo.blue, ITag(), value[2]);
    for (int lane = 0; lane < count; ++lane) {
        const int i = queue.pixel[lane];
        const ptrdiff_t at = (i / kTileSize) * planes.stride + i % kTileSize;
        planes.albedo_red[at] = uint16_t(value[0][lane]);
        planes.albedo_green[at] = uint16_t(value[1][lane]);
        planes.albedo_blue[at] = uint16_t(value[2][lane]);
    }
}

/// Shades the first pixels of the queue and takes them out of it.
template <int kLevel>
HWY_NOINLINE void shadeQueued(const TileContext& tile, PixelQueue& queue) {
    constexpr int kLanes = int(hn::MaxLanes(ITag()));
    const ITag d;
    const int count = std::min(queue.count, kLanes);
    // Other lanes repeat the first one.
    const auto valid = hn::FirstN(d, size_t(count));
    const IVec pixel = hn::IfThenElse(valid, hn::Load(d, queue.pixel), splatInt(queue.pixel[0]));
    const IVec ref = hn::IfThenElse(valid, hn::Load(d, queue.ref), splatInt(queue.ref[0]));
    const FVec x = hn::ConvertTo(FTag(), hn::And(pixel, splatInt(kTileSize - 1)));
    const FVec y = hn::ConvertTo(FTag(), hn::ShiftRight<6>(pixel));
    static_assert(kTileSize == 1 << 6);
    const GroupOutput out = shadeMixed<kLevel>(tile, x, y, ref, uint32_t(queue.surface));
    alignas(64) int32_t value[7][kLanes];
    const IVec outputs[7] = {out.red,
                             out.green,
                             out.blue,
                             out.id,
                             out.normal,
                             out.motion.packed,
                             out.motion.depth_before};
    for (int k = 0; k < (out.own_motion ? 7 : 5); ++k) {
        hn::Store(outputs[k], d, value[k]);
    }
    const TilePlanes& planes = tile.planes;
    for (int lane = 0; lane < count; ++lane) {
        const int i = queue.pixel[lane];
        const ptrdiff_t at = (i / kTileSize) * planes.stride + i % kTileSize;
        planes.red[at] = uint16_t(value[0][lane]);
        planes.green[at] = uint16_t(value[1][lane]);
        planes.blue[at] = uint16_t(value[2][lane]);
        planes.id[at] = uint16_t(value[3][lane]);
        if (planes.normal != nullptr) {
            planes.normal[at] = uint32_t(value[4][lane]);
        }
        if (out.own_motion) {
            planes.motion[at] = {int16_t(value[5][lane]), int16_t(value[5][lane] >> 16)};
            planes.depth_before[at] = uint16_t(value[6][lane]);
        }
    }
    if (planes.albedo_red != nullptr) {
        storeQueuedAlbedo(planes, queue, count, out.albedo);
    }
    queue.count -= count;
    hn::Store(hn::Load(d, queue.pixel + kLanes), d, queue.pixel);
    hn::Store(hn::Load(d, queue.ref + kLanes), d, queue.ref);
}

/// A surface has its queue by its number; two that meet in one take turns.
struct PixelQueues {
    static constexpr uint32_t kCount = 16;
    PixelQueue queue[kCount];

    template <int kLevel>
    PixelQueue& of(const TileContext& tile, int32_t surface) {
        PixelQueue& q = queue[uint32_t(surface) % kCount];
        if (q.surface != surface) {
            if (q.count > 0) {
                shadeQueued<kLevel>(tile, q);
            }
            q.surface = surface;
        }
        return q;
    }
};

/// Of the triangles `refs`, which all have records.
HWY_INLINE IVec surfacesOf(const TileContext& tile, IVec refs) {
    alignas(64) int32_t first_word[hn::MaxLanes(ITag())];
    hn::Store(hn::ShiftLeft<6>(refs), ITag(), first_word);
    constexpr int kWord = offsetof(ShadeTriangle, surface) / sizeof(float);
    static_assert(kWord % 4 == 3);
    const float* words = reinterpret_cast<const float*>(tile.shade) + (kWord - 3);
    return hn::BitCast(ITag(), loadQuads(words, first_word).word[3]);
}

/// The first of the lanes in `mask`, of which there is one.
HWY_INLINE int32_t firstLane(IVec v, hn::Mask<ITag> mask) {
    alignas(64) int32_t lanes[hn::MaxLanes(ITag())];
    hn::Store(v, ITag(), lanes);
    return lanes[hn::FindFirstTrue(ITag(), mask)];
}

template <int kLevel>
HWY_INLINE void shadeGroup(const Group& group, const uint32_t* visible, PixelQueues& queues) {
    const ITag d;
    const TileContext& tile = *group.tile;
    const IVec refs = hn::LoadU(d, reinterpret_cast<const int32_t*>(visible));
    const uint32_t first = visible[0];
    if (hn::AllTrue(d, hn::Eq(refs, splatInt(int32_t(first))))) {
        if (first == kNothingVisible) {
            storeBackground(group);
        } else {
            shadeUniform<kLevel>(group, first);
        }
        return;
    }
    const auto shown = hn::Ne(refs, splatInt(int32_t(kNothingVisible)));
    const IVec surfaces = hn::IfThenElseZero(
        shown, surfacesOf(tile, hn::IfThenElse(shown, refs, splatInt(firstLane(refs, shown)))));
    const int32_t first_surface = hn::GetLane(surfaces);
    if (first_surface != 0 && hn::AllTrue(d, hn::Eq(surfaces, splatInt(first_surface)))) {
        const GroupOutput out =
            shadeMixed<kLevel>(tile, group.x, group.y, refs, uint32_t(first_surface));
        storePlanes(tile.planes, group.at, out);
        if (out.own_motion) {
            storeMotion(tile.planes, group.at, out.motion);
        }
        return;
    }
    if (!hn::AllTrue(d, shown)) {
        storeBackground(group);
    }
    const IVec pixels = hn::Iota(d, int32_t(visible - tile.visible));
    for (auto left = shown; !hn::AllFalse(d, left);) {
        const int32_t surface = firstLane(surfaces, left);
        const auto mask = hn::Eq(surfaces, splatInt(surface));
        PixelQueue& queue = queues.of<kLevel>(tile, surface);
        hn::CompressStore(pixels, mask, d, queue.pixel + queue.count);
        queue.count += int(hn::CompressStore(refs, mask, d, queue.ref + queue.count));
        if (queue.count >= int(hn::MaxLanes(d))) {
            shadeQueued<kLevel>(tile, queue);
        }
        left = hn::AndNot(mask, left);
    }
}

template <int kLevel>
HWY_NOINLINE void shadeTileLevel(const TileContext& tile) {
    writeDepthAndMotion(tile);
    PixelQueues queues;
    const int lanes = int(hn::Lanes(FTag()));
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; x += lanes) {
            const Group group{&tile, hn::Iota(FTag(), float(x)), splat(float(y)),
                              y * tile.planes.stride + x};
            shadeGroup<kLevel>(group, tile.visible + y * kTileSize + x, queues);
        }
    }
    for (PixelQueue& queue : queues.queue) {
        if (queue.count > 0) {
            shadeQueued<kLevel>(tile, queue);
        }
    }
}

void shadeTile(const TileContext& tile) {
    switch (shadeLevel(tile.features)) {
        case 3:
            return shadeTileLevel<3>(tile);
        case 2:
            return shadeTileLevel<2>(tile);
        case 1:
            return shadeTileLevel<1>(tile);
        default:
            return shadeTileLevel<0>(tile);
    }
}

/// Forward shading: pixels x + i of row y just passed the depth test with triangle `ref`, for each
/// set bit i of `passed`. Their depths stand in the tile.
HWY_NOINLINE void shadeFragments(const TileContext& tile, uint32_t ref, int x, int y,
                                 uint32_t passed) {
    const int misaligned = x % int(hn::Lanes(FTag()));
    x -= misaligned;
    passed <<= misaligned;
    const uint8_t bits[8] = {uint8_t(passed), uint8_t(passed >> 8)};
    const auto mask = hn::RebindMask(ITag(), hn::LoadMaskBits(FTag(), bits));
    const auto merged = [&](IVec now, IVec before) { return hn::IfThenElse(mask, now, before); };
    const TilePlanes& planes = tile.planes;
    const ptrdiff_t at = y * planes.stride + x;
    const FVec px = hn::Iota(FTag(), float(x)), py = splat(float(y));
    const FVec depth = hn::LoadU(FTag(), tile.depth + y * kTileSize + x);
    hn::StoreU(hn::BitCast(UTag(), depth), UTag(), planes.depth + at);
    const LaneTriangles<true> t{&tile.shade[ref]};
    GroupOutput out = shadeSurface<3>(tile, px, py, t, uint32_t(t.t->surface));
    out.red = merged(out.red, loadU16(planes.red + at));
    out.green = merged(out.green, loadU16(planes.green + at));
    out.blue = merged(out.blue, loadU16(planes.blue + at));
    out.id = merged(out.id, loadU16(planes.id + at));
    const auto words = [&](const void* from) {
        return hn::LoadU(ITag(), static_cast<const int32_t*>(from));
    };
    if (planes.albedo_red != nullptr) {
        out.albedo = {merged(out.albedo.red, loadU16(planes.albedo_red + at)),
                      merged(out.albedo.green, loadU16(planes.albedo_green + at)),
                      merged(out.albedo.blue, loadU16(planes.albedo_blue + at))};
    }
    if (planes.normal != nullptr) {
        out.normal = merged(out.normal, words(planes.normal + at));
    }
    storePlanes(planes, at, out);
    if (planes.motion != nullptr) {
        if (!out.own_motion) {
            out.motion = motionOf(reprojectStatic(tile, px, py, depth));
        }
        storeMotion(planes, at,
                    {merged(out.motion.packed, words(planes.motion + at)),
                     merged(out.motion.depth_before, loadU16(planes.depth_before + at))});
    } else if (planes.depth_before != nullptr) {
        storeU16(logDepthLanes(depth), planes.depth_before + at);
    }
}

}  // namespace shading
}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
