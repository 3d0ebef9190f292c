// Shading, one pixel per lane; see shade_reference.cpp for the truth.
// Included once per target by kernels_simd.cpp. Phases of a group of lanes: barycentrics → texture
// coordinates → normal → light → colour → motion → merge into the group's outputs.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Planes of one group of pixels, as 32-bit lanes until they are stored.
struct GroupOutput {
    IVec red, green, blue, id;
    IVec normal;
    IVec motion_x, motion_y, depth_before;
};

/// Where a group lies and what all its lanes share.
struct Group {
    const TileContext* tile;
    FVec x, y;  ///< tile-local
    FVec depth;
};

HWY_INLINE Vec3 bumped(const Vec3& n, const Vec3& t, const Vec3& b, const Vec3& raw) {
    const auto unpack = [](FVec v) {
        return hn::Sub(hn::Mul(v, splat(kTexelToNormal)), splat(1.0f));
    };
    const FVec x = unpack(raw.x), y = unpack(raw.y), z = unpack(raw.z);
    const auto combine = [&](FVec tc, FVec bc, FVec nc) {
        return hn::Add(hn::Add(hn::Mul(tc, x), hn::Mul(bc, y)), hn::Mul(nc, z));
    };
    return normalize3({combine(t.x, b.x, n.x), combine(t.y, b.y, n.y), combine(t.z, b.z, n.z)});
}

template <bool kFull, bool kUniform>
HWY_INLINE Vec3 shadingNormal(const LaneTriangles<kUniform>& t, const LaneBarycentrics& p,
                              const Surface& s, const InstanceSetup& instance,
                              const LaneTexture& c) {
    Vec3 n = worldNormal(t, p, s, instance);
    if constexpr (kFull) {
        if (s.normal != nullptr) {
            const Vec3 tangent = worldTangent(t, p, s, instance);
            const Vec3 bitangent = worldBitangent(t, s, instance, n, tangent);
            n = bumped(n, tangent, bitangent, sampleTexture<false>(*s.normal, c, s.mip_bias_fx8));
        }
    }
    return scale3(n, t.word(kWordFlip));
}

struct LaneLight {
    Vec3 diffuse, specular;
};

HWY_INLINE FVec power(FVec x, int n) {
    FVec result = splat(1.0f);
    for (; n > 0; n >>= 1) {
        if ((n & 1) != 0) {
            result = hn::Mul(result, x);
        }
        x = hn::Mul(x, x);
    }
    return result;
}

HWY_INLINE Vec3 addScaled(const Vec3& sum, const std::array<float, 3>& colour, FVec factor) {
    return {hn::Add(sum.x, hn::Mul(splat(colour[0]), factor)),
            hn::Add(sum.y, hn::Mul(splat(colour[1]), factor)),
            hn::Add(sum.z, hn::Mul(splat(colour[2]), factor))};
}

HWY_INLINE void addLight(LaneLight& lit, const Vec3& to_light, const std::array<float, 3>& colour,
                         FVec attenuation, const Vec3& n, const Vec3& to_eye, int shininess) {
    const FVec zero = hn::Zero(FTag());
    const FVec cosine = hn::Mul(hn::Max(dot3(n, to_light), zero), attenuation);
    lit.diffuse = addScaled(lit.diffuse, colour, cosine);
    if (shininess > 0) {
        const Vec3 half = normalize3({hn::Add(to_light.x, to_eye.x), hn::Add(to_light.y, to_eye.y),
                                      hn::Add(to_light.z, to_eye.z)});
        const FVec highlight = hn::Mul(power(hn::Max(dot3(n, half), zero), shininess), attenuation);
        lit.specular =
            addScaled(lit.specular, colour, hn::IfThenElseZero(hn::Gt(cosine, zero), highlight));
    }
}

template <bool kFull, bool kUniform>
HWY_INLINE LaneLight lightSurface(const Group& group, const LaneTriangles<kUniform>& t,
                                  const LaneBarycentrics& p, const Surface& s,
                                  const InstanceSetup& instance, const Vec3& n) {
    const Lighting& lighting = group.tile->frame->list->lighting;
    const FVec zero = hn::Zero(FTag());
    LaneLight lit{
        {splat(lighting.ambient[0]), splat(lighting.ambient[1]), splat(lighting.ambient[2])},
        {zero, zero, zero}};
    Vec3 position{zero, zero, zero}, to_eye{zero, zero, zero};
    if (kFull && (s.features & kShadePosition) != 0) {
        position = worldPosition(t, p, s, instance);
        to_eye = towardsEye(*group.tile->frame->view, position);
    }
    const std::array<float, 3>& d = lighting.sun.direction;
    const int shininess = kFull ? s.shininess : 0;
    addLight(lit, {splat(-d[0]), splat(-d[1]), splat(-d[2])}, lighting.sun.colour, splat(1.0f), n,
             to_eye, shininess);
    if constexpr (kFull) {
        for (const PointLight& light : lighting.points) {
            const Vec3 to{hn::Sub(splat(light.position[0]), position.x),
                          hn::Sub(splat(light.position[1]), position.y),
                          hn::Sub(splat(light.position[2]), position.z)};
            const FVec d2 = hn::Max(dot3(to, to), splat(1e-12f));
            const Vec3 direction = scale3(to, hn::Div(splat(1.0f), hn::Sqrt(d2)));
            addLight(lit, direction, light.colour, hn::Div(splat(1.0f), d2), n, to_eye, shininess);
        }
    }
    return lit;
}

HWY_INLINE IVec toFx12(FVec linear) {
    const FVec bounded = hn::Min(hn::Max(linear, hn::Zero(FTag())), splat(kColourMax));
    return roundLanes(FTag(), hn::Mul(bounded, splat(kColourScale)));
}

HWY_INLINE IVec packOctahedral(const Vec3& n) {
    const FVec zero = hn::Zero(FTag()), one = splat(1.0f);
    const FVec sum =
        hn::Max(hn::Add(hn::Add(hn::Abs(n.x), hn::Abs(n.y)), hn::Abs(n.z)), splat(kTiny));
    const FVec inv = hn::Div(one, sum);
    const FVec px = hn::Mul(n.x, inv), py = hn::Mul(n.y, inv);
    const auto sign = [&](FVec v) { return hn::IfThenElse(hn::Lt(v, zero), splat(-1.0f), one); };
    const auto below = hn::Lt(n.z, zero);
    const FVec u = hn::IfThenElse(below, hn::Mul(hn::Sub(one, hn::Abs(py)), sign(px)), px);
    const FVec v = hn::IfThenElse(below, hn::Mul(hn::Sub(one, hn::Abs(px)), sign(py)), py);
    const auto snorm = [](FVec f) {
        return hn::And(roundLanes(FTag(), hn::Mul(f, splat(kSnormScale))), splatInt(0xFFFF));
    };
    return hn::Or(snorm(u), hn::ShiftLeft<16>(snorm(v)));
}

struct LaneReprojected {
    FVec x, y, depth, w;
};

HWY_INLINE FVec safeInverse(FVec w) {
    const FVec one = splat(1.0f);
    return hn::Div(one, hn::IfThenElse(hn::Gt(w, splat(1e-20f)), w, one));
}

HWY_INLINE LaneReprojected reprojectStatic(const Group& g) {
    const auto& m = g.tile->reproject.m;
    FVec q[4];
    for (int i = 0; i < 4; ++i) {
        q[i] = hn::Add(hn::Add(hn::Add(hn::Mul(splat(m[i][0]), g.x), hn::Mul(splat(m[i][1]), g.y)),
                               hn::Mul(splat(m[i][2]), g.depth)),
                       splat(m[i][3]));
    }
    const FVec inv = safeInverse(q[3]);
    return {hn::Sub(hn::Mul(q[0], inv), g.x), hn::Sub(hn::Mul(q[1], inv), g.y), hn::Mul(q[2], inv),
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

HWY_INLINE void setMotion(const LaneReprojected& r, GroupOutput& out) {
    const FVec limit = splat(kMotionMax_px);
    const FMask known = hn::And(hn::Gt(r.w, splat(1e-20f)),
                                hn::And(hn::Lt(hn::Abs(r.x), limit), hn::Lt(hn::Abs(r.y), limit)));
    const auto known_i = hn::RebindMask(ITag(), known);
    const auto fx8 = [&](FVec v) {
        return roundLanes(FTag(), hn::Mul(hn::IfThenElseZero(known, v), splat(kMotionScale)));
    };
    out.motion_x = hn::IfThenElse(known_i, fx8(r.x), splatInt(int32_t{kNoHistory}));
    out.motion_y = fx8(r.y);
    out.depth_before =
        hn::IfThenElseZero(known_i, logDepthLanes(hn::IfThenElseZero(known, r.depth)));
}

HWY_INLINE GroupOutput backgroundOutput(const Group& group) {
    const std::array<float, 3>& background = group.tile->frame->list->background;
    const IVec zero = hn::Zero(ITag());
    GroupOutput out{toFx12(splat(background[0])),
                    toFx12(splat(background[1])),
                    toFx12(splat(background[2])),
                    zero,
                    zero,
                    zero,
                    zero,
                    zero};
    if (group.tile->planes.motion != nullptr) {
        setMotion(reprojectStatic(group), out);
    }
    return out;
}

/// Levels of specialisation: 0 = plain colours, 1 = textures, 2 = everything but height maps, 3 =
/// with them.
template <int kLevel, bool kUniform>
HWY_INLINE GroupOutput shadeSurface(const Group& group, const LaneTriangles<kUniform>& t,
                                    uint32_t surface) {
    const FrameTables& frame = *group.tile->frame;
    const Surface& s = frame.surfaces[surface];
    const InstanceSetup& instance = frame.instances[s.instance];
    const LaneBarycentrics p = barycentrics(t, group.x, group.y);
    LaneTexture c{};
    if (kLevel >= 1 && (s.features & (kShadeTexture | kShadeNormalMap)) != 0) {
        c = textureCoordinates(t, p, s);
        if (kLevel >= 3 && s.height != nullptr) {
            c = displacedCoordinates(frame, t, p, s, c);
        }
    }
    const Vec3 n = shadingNormal<kLevel >= 2>(t, p, s, instance, c);
    const LaneLight lit = lightSurface<kLevel >= 2>(group, t, p, s, instance, n);
    const Material& m = *s.material;
    Vec3 albedo{splat(m.diffuse[0]), splat(m.diffuse[1]), splat(m.diffuse[2])};
    if (kLevel >= 1 && s.colour != nullptr) {
        const Vec3 texel = sampleTexture<true>(*s.colour, c, s.mip_bias_fx8);
        const FVec linear = splat(kTexelToLinear);
        albedo = {hn::Mul(albedo.x, hn::Mul(texel.x, linear)),
                  hn::Mul(albedo.y, hn::Mul(texel.y, linear)),
                  hn::Mul(albedo.z, hn::Mul(texel.z, linear))};
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
                    zero,
                    zero,
                    zero};
    if (frame.planes.normal) {
        out.normal = packOctahedral(n);
    }
    if (group.tile->planes.motion != nullptr) {
        setMotion(instance.own_motion ? reprojectMoved(instance, objectPosition(t, p, s))
                                      : reprojectStatic(group),
                  out);
    }
    return out;
}

HWY_INLINE void merge(GroupOutput& into, const GroupOutput& from, hn::Mask<ITag> mask) {
    into.red = hn::IfThenElse(mask, from.red, into.red);
    into.green = hn::IfThenElse(mask, from.green, into.green);
    into.blue = hn::IfThenElse(mask, from.blue, into.blue);
    into.id = hn::IfThenElse(mask, from.id, into.id);
    into.normal = hn::IfThenElse(mask, from.normal, into.normal);
    into.motion_x = hn::IfThenElse(mask, from.motion_x, into.motion_x);
    into.motion_y = hn::IfThenElse(mask, from.motion_y, into.motion_y);
    into.depth_before = hn::IfThenElse(mask, from.depth_before, into.depth_before);
}

using U16Tag = hn::Rebind<uint16_t, ITag>;

HWY_INLINE IVec loadU16(const uint16_t* from) {
    return hn::PromoteTo(ITag(), hn::LoadU(U16Tag(), from));
}

HWY_INLINE void storeU16(IVec v, uint16_t* to) {
    hn::StoreU(hn::DemoteTo(U16Tag(), v), U16Tag(), to);
}

HWY_INLINE void storeGroup(const Group& group, const GroupOutput& out, ptrdiff_t at) {
    const TilePlanes& planes = group.tile->planes;
    storeU16(out.red, planes.red + at);
    storeU16(out.green, planes.green + at);
    storeU16(out.blue, planes.blue + at);
    storeU16(out.id, planes.id + at);
    hn::StoreU(hn::BitCast(UTag(), group.depth), UTag(), planes.depth + at);
    if (planes.normal != nullptr) {
        hn::StoreU(out.normal, ITag(), reinterpret_cast<int32_t*>(planes.normal + at));
    }
    if (planes.motion != nullptr) {
        const IVec packed =
            hn::Or(hn::And(out.motion_x, splatInt(0xFFFF)), hn::ShiftLeft<16>(out.motion_y));
        hn::StoreU(packed, ITag(), reinterpret_cast<int32_t*>(planes.motion + at));
        storeU16(out.depth_before, planes.depth_before + at);
    }
}

/// What the planes hold already: forward shading merges into it.
HWY_INLINE GroupOutput loadGroup(const Group& group, ptrdiff_t at) {
    const TilePlanes& planes = group.tile->planes;
    const IVec zero = hn::Zero(ITag());
    GroupOutput out{loadU16(planes.red + at),
                    loadU16(planes.green + at),
                    loadU16(planes.blue + at),
                    loadU16(planes.id + at),
                    zero,
                    zero,
                    zero,
                    zero};
    if (planes.normal != nullptr) {
        out.normal = hn::LoadU(ITag(), reinterpret_cast<const int32_t*>(planes.normal + at));
    }
    if (planes.motion != nullptr) {
        const IVec packed = hn::LoadU(ITag(), reinterpret_cast<const int32_t*>(planes.motion + at));
        out.motion_x = hn::ShiftRight<16>(hn::ShiftLeft<16>(packed));
        out.motion_y = hn::ShiftRight<16>(packed);
        out.depth_before = loadU16(planes.depth_before + at);
    }
    return out;
}

/// Lanes of `mask` show different triangles of one surface.
template <int kLevel>
HWY_NOINLINE GroupOutput shadeMixedSurface(const Group& group, IVec refs, hn::Mask<ITag> mask,
                                           int first_lane_ref, uint32_t surface) {
    const ShadeTriangle* shade = group.tile->shade;
    LaneTriangles<false> t;
    t.words = reinterpret_cast<const float*>(shade);
    // Other lanes borrow a triangle of this surface, so that every gather stays in its arrays.
    const IVec own = hn::IfThenElse(mask, refs, splatInt(first_lane_ref));
    t.first_word = hn::ShiftLeft<4>(own);
    const int32_t* words = reinterpret_cast<const int32_t*>(shade);
    for (int k = 0; k < 3; ++k) {
        t.vertex[k] =
            hn::GatherIndex(ITag(), words, hn::Add(t.first_word, splatInt(kWordVertex + k)));
    }
    return shadeSurface<kLevel>(group, t, surface);
}

template <int kLevel>
HWY_NOINLINE GroupOutput shadeTriangle(const Group& group, uint32_t ref) {
    const LaneTriangles<true> t{&group.tile->shade[ref]};
    return shadeSurface<kLevel>(group, t, uint32_t(t.t->surface));
}

template <int kLevel>
HWY_INLINE void shadeGroup(const Group& group, const uint32_t* visible, ptrdiff_t at) {
    constexpr size_t kMaxLanes = 8;
    const size_t lanes = hn::Lanes(ITag());
    const IVec refs = hn::LoadU(ITag(), reinterpret_cast<const int32_t*>(visible));
    const uint32_t first = visible[0];
    GroupOutput out;
    if (hn::AllTrue(ITag(), hn::Eq(refs, splatInt(int32_t(first))))) {
        if (first == kNothingVisible) {
            out = backgroundOutput(group);
        } else {
            out = shadeTriangle<kLevel>(group, first);
        }
        storeGroup(group, out, at);
        return;
    }
    out = backgroundOutput(group);
    alignas(32) int32_t surface_of[kMaxLanes];
    for (size_t lane = 0; lane < lanes; ++lane) {
        const uint32_t ref = visible[lane];
        surface_of[lane] = ref == kNothingVisible ? 0 : group.tile->shade[ref].surface;
    }
    const IVec surfaces = hn::LoadU(ITag(), surface_of);
    for (size_t lane = 0; lane < lanes; ++lane) {
        const int32_t surface = surface_of[lane];
        if (surface == 0) {
            continue;
        }
        const auto mask = hn::Eq(surfaces, splatInt(surface));
        const uint32_t ref = visible[lane];
        const auto others = hn::AndNot(hn::Eq(refs, splatInt(int32_t(ref))), mask);
        merge(out,
              hn::AllFalse(ITag(), others)
                  ? shadeTriangle<kLevel>(group, ref)
                  : shadeMixedSurface<kLevel>(group, refs, mask, int(ref), uint32_t(surface)),
              mask);
        for (size_t other = lane; other < lanes; ++other) {
            surface_of[other] = surface_of[other] == surface ? 0 : surface_of[other];
        }
    }
    storeGroup(group, out, at);
}

template <int kLevel>
HWY_NOINLINE void shadeTileLevel(const TileContext& tile) {
    const int lanes = int(hn::Lanes(FTag()));
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; x += lanes) {
            const int i = y * kTileSize + x;
            const Group group{&tile, hn::Iota(FTag(), float(x)), splat(float(y)),
                              hn::LoadU(FTag(), tile.depth + i)};
            shadeGroup<kLevel>(group, tile.visible + i, y * tile.planes.stride + x);
        }
    }
}

void shadeTile(const TileContext& tile) {
    if ((tile.features & kShadeHeightMap) != 0) {
        shadeTileLevel<3>(tile);
    } else if ((tile.features & (kShadeNormalMap | kShadePosition)) != 0) {
        shadeTileLevel<2>(tile);
    } else if ((tile.features & kShadeTexture) != 0) {
        shadeTileLevel<1>(tile);
    } else {
        shadeTileLevel<0>(tile);
    }
}

/// Forward shading: the lanes of `mask` just passed the depth test with triangle `ref`.
HWY_NOINLINE void shadeFragments(const TileContext& tile, uint32_t ref, int x, int y, FVec depth,
                                 FMask mask) {
    const Group group{&tile, hn::Iota(FTag(), float(x)), splat(float(y)), depth};
    const ptrdiff_t at = y * tile.planes.stride + x;
    const LaneTriangles<true> t{&tile.shade[ref]};
    GroupOutput out = loadGroup(group, at);
    merge(out, shadeSurface<3>(group, t, uint32_t(t.t->surface)), hn::RebindMask(ITag(), mask));
    storeGroup(group, out, at);
}

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
