// The resolve in lanes: a row of a tile at a time; resolve_reference.cpp is the truth. Pixels that
// do not fit (no history, untrusted taps, two surfaces in the window, picture borders) are handed
// to resolvePixel(), everything else keeps whole vectors busy:
//
//   row ─► owners of the row ─► group of lanes ─┬─ at rest: sum at the same place
//                                               ├─ by whole pixels of motion: 1 or 4×4 taps
//                                               └─ the rest: resolvePixel(), one by one

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// One group of lanes of a general tile.
struct Group {
    const ResolveJob& job;
    int x, y;
    ptrdiff_t at;
    V32 surface, expected, normal;
    V32 tolerance;
    V32 strict;  ///< all ones where only the same surface will do
    VI32 motion_x, motion_y;
    VI32 fx, fy;  ///< fractions of the motion
    Sums sums;    ///< result of the lanes that are done
};

/// What taps are held against in 16-bit lanes, for one displacement by whole pixels.
struct Test {
    V16 surface, expected, tolerance, strict;
    V32 normal;
};

/// Not zero where the tap is not fully trusted (low 16 bits of 32-bit lanes).
HWY_INLINE V32 distrust(const ResolveJob& job, const Test& test, ptrdiff_t at) {
    const D16 d16;
    const D32 d;
    const V16 surface = hn::LoadU(d16, job.before.surface + at);
    const V16 depth = hn::LoadU(d16, job.before.depth + at);
    const V16 apart = hn::Sub(hn::Max(depth, test.expected), hn::Min(depth, test.expected));
    const V16 other = hn::And(hn::Xor(surface, test.surface), test.strict);
    const V16 bad = hn::Or(other, hn::SaturatedSub(apart, test.tolerance));
    V32 result = hn::PromoteTo(d, bad);
    if (job.now.normal != nullptr) {
        const V32 normal = load16(job.before.normal + at);
        if (!hn::AllTrue(d, hn::Eq(normal, test.normal))) {
            const Mask32 differ =
                differentNormals(decodeNormals(normal), decodeNormals(test.normal));
            result = hn::Or(result, hn::VecFromMask(d, differ));
        }
    }
    return result;
}

/// 4×4 (or 4×1, 1×4, 1×1) taps around `from`, the taps of the group's first lane.
struct Footprint {
    ptrdiff_t from;
    int i0, i1, j0, j1;
    Mask32 slides_x, slides_y;  ///< lanes whose motion has a fraction on the axis
};

HWY_INLINE Mask32 neededLanes(const Footprint& f, int i, int j) {
    const D32 d;
    Mask32 needed = hn::Eq(hn::Zero(d), hn::Zero(d));
    needed = i != 0 ? hn::And(needed, f.slides_x) : needed;
    return j != 0 ? hn::And(needed, f.slides_y) : needed;
}

/// Lanes of `lanes` all of whose taps are trusted; `count` becomes the smallest of the inner taps.
HWY_INLINE Mask32 trustFootprint(const ResolveJob& job, const Test& test, const Footprint& f,
                                 Mask32 lanes, V32& count) {
    const D32 d;
    V32 bad = hn::Zero(d);
    count = hn::Set(d, 255u);
    for (int j = f.j0; j <= f.j1; ++j) {
        for (int i = f.i0; i <= f.i1; ++i) {
            const ptrdiff_t at = f.from + j * job.stride + i;
            const Mask32 needed = neededLanes(f, i, j);
            bad = hn::Or(bad, hn::IfThenElseZero(needed, distrust(job, test, at)));
            if (i >= 0 && i <= 1 && j >= 0 && j <= 1) {
                const V32 stored = load8(job.before.count + at);
                count = hn::IfThenElse(needed, hn::Min(count, stored), count);
            }
        }
        if (hn::AllFalse(d, hn::And(lanes, hn::Eq(bad, hn::Zero(d))))) {
            break;
        }
    }
    return hn::And(lanes, hn::Eq(bad, hn::Zero(d)));
}

/// The filtered colour with kFractionBits, held within the inner taps.
HWY_INLINE VI32 filterChannel(const ResolveJob& job, int channel, const Footprint& f,
                              const Cubic& wx, const Cubic& wy) {
    const DI32 di;
    VI32 low = hn::Set(di, 65535), high = hn::Zero(di), sum = hn::Zero(di);
    for (int j = f.j0; j <= f.j1; ++j) {
        VI32 line = hn::Zero(di);
        for (int i = f.i0; i <= f.i1; ++i) {
            const VI32 tap =
                asSigned(load16(job.before.mean[channel] + f.from + j * job.stride + i));
            line = hn::Add(line, hn::Mul(wx.w[i + 1], tap));
            if (i >= 0 && i <= 1 && j >= 0 && j <= 1) {
                const auto needed = hn::RebindMask(di, neededLanes(f, i, j));
                low = hn::IfThenElse(needed, hn::Min(low, tap), low);
                high = hn::IfThenElse(needed, hn::Max(high, tap), high);
            }
        }
        sum = hn::Add(sum, hn::Mul(wy.w[j + 1], roundedShift<kCubicRowShift>(line)));
    }
    const VI32 value = roundedShift<kCubicColumnShift>(sum);
    return hn::Min(hn::Max(value, hn::ShiftLeft<kFractionBits>(low)),
                   hn::ShiftLeft<kFractionBits>(high));
}

/// History of lanes that moved by a fraction: cubicTaps().
HWY_INLINE Sums filterFootprint(const Group& g, const Footprint& f, V32 count) {
    const Cubic wx = cubicOf(g.fx), wy = cubicOf(g.fy);
    Sums past;
    past.count = hn::Min(count, resampledCounts(g.fx, g.fy));
    for (int c = 0; c < 3; ++c) {
        const VI32 value = filterChannel(g.job, c, f, wx, wy);
        const VI32 mean = roundedShift<kFractionBits>(value);
        const VI32 excess = hn::Sub(value, hn::ShiftLeft<kFractionBits>(mean));
        past.mean[c] = asUnsigned(mean);
        past.rest[c] = roundedShift<kFractionBits>(hn::Mul(excess, asSigned(past.count)));
    }
    return past;
}

/// storeSum(): history that may stand for at most cap − 1 samples, and this frame's sample.
HWY_INLINE Sums accumulate(const Group& g, const Sums& past) {
    const D32 d;
    const V32 count = hn::Min(past.count, hn::Set(d, uint32_t(g.job.sample_cap - 1)));
    const auto keep = hn::Not(hn::Lt(asSigned(hn::Add(count, count)), asSigned(past.count)));
    Sums kept = past;
    for (int c = 0; c < 3; ++c) {
        kept.rest[c] = hn::IfThenElseZero(keep, past.rest[c]);
    }
    return grow(g.job, g.at, kept, hn::Max(count, hn::Set(d, 1)));
}

/// Resolves those of `lanes` that moved by (dx, dy) whole pixels and a fraction and whose taps are
/// all trusted; returns them.
HWY_INLINE Mask32 resolveMoved(Group& g, Mask32 lanes, int dx, int dy) {
    const D32 d;
    const DI32 di;
    const ResolveJob& job = g.job;
    const int count_lanes = int(hn::Lanes(d));
    const VI32 zero = hn::Zero(di);
    Footprint f;
    f.slides_x = hn::RebindMask(d, hn::Ne(g.fx, zero));
    f.slides_y = hn::RebindMask(d, hn::Ne(g.fy, zero));
    const bool any_x = !hn::AllFalse(d, hn::And(lanes, f.slides_x));
    const bool any_y = !hn::AllFalse(d, hn::And(lanes, f.slides_y));
    f.i0 = any_x ? -1 : 0;
    f.i1 = any_x ? 2 : 0;
    f.j0 = any_y ? -1 : 0;
    f.j1 = any_y ? 2 : 0;
    const int ix = g.x + dx, iy = g.y + dy;
    if (iy + f.j0 < 0 || iy + f.j1 >= job.height || ix + f.i1 + count_lanes <= 0 ||
        ix + f.i0 >= job.width) {
        return noLanes();
    }
    // Columns outside the picture are read from the padding and thrown away.
    const VI32 column = hn::Add(hn::Iota(di, 0), hn::Set(di, ix));
    const auto inside = hn::And(hn::Gt(column, hn::Set(di, -f.i0 - 1)),
                                hn::Lt(column, hn::Set(di, job.width - f.i1)));
    lanes = hn::And(lanes, hn::RebindMask(d, inside));
    if (hn::AllFalse(d, lanes)) {
        return lanes;
    }
    f.from = iy * job.stride + ix;
    const Test test{narrow16(g.surface), narrow16(g.expected), narrow16(g.tolerance),
                    narrow16(g.strict), g.normal};
    V32 count;
    lanes = trustFootprint(job, test, f, lanes, count);
    if (hn::AllFalse(d, lanes)) {
        return lanes;
    }
    Sums past = loadSums(job.before, f.from);
    if (any_x || any_y) {
        const Mask32 slides = hn::Or(f.slides_x, f.slides_y);
        past = choose(slides, filterFootprint(g, f, count), past);
    }
    g.sums = choose(lanes, accumulate(g, past), g.sums);
    return lanes;
}

/// Resolves pixels that stand still with everything around them; `kept` gets the finished ones.
HWY_INLINE Mask32 resolveProven(Group& g, Mask32 lanes, Mask32& kept) {
    const D32 d;
    lanes = hn::And(lanes, hn::Eq(load16(g.job.before.surface + g.at), g.surface));
    if (hn::AllFalse(d, lanes)) {
        return lanes;
    }
    const Sums past = loadSums(g.job.before, g.at);
    const Mask32 grows = notYet(past.count, g.job.sample_cap);
    const V32 count = hn::IfThenElse(grows, past.count, hn::Set(d, 1));
    g.sums = choose(lanes, choose(grows, grow(g.job, g.at, past, count), past), g.sums);
    kept = hn::AndNot(grows, lanes);
    return lanes;
}

HWY_INLINE uint64_t bitsOf(Mask32 mask) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(D32(), mask, bytes);
    return uint64_t{bytes[0]} | uint64_t{bytes[1]} << 8;
}

/// Lanes are taken together as long as they moved by the same number of whole pixels.
HWY_INLINE Mask32 resolveByMotion(Group& g, Mask32 open, VI32 whole_x, VI32 whole_y) {
    const D32 d;
    const DI32 di;
    alignas(64) int32_t dx[kMaxLanes], dy[kMaxLanes];
    hn::Store(whole_x, di, dx);
    hn::Store(whole_y, di, dy);
    Mask32 done = noLanes();
    while (!hn::AllFalse(d, open)) {
        const int first = std::countr_zero(bitsOf(open));
        const auto same = hn::And(hn::Eq(whole_x, hn::Set(di, dx[first])),
                                  hn::Eq(whole_y, hn::Set(di, dy[first])));
        const Mask32 lanes = hn::And(open, hn::RebindMask(d, same));
        done = hn::Or(done, resolveMoved(g, lanes, dx[first], dy[first]));
        open = hn::AndNot(lanes, open);
    }
    return done;
}

HWY_INLINE Group makeGroup(const ResolveJob& job, int x, int y, const Owners& owners, V32 depth) {
    const D32 d;
    const DI32 di;
    const ptrdiff_t at = y * job.stride + x;
    const VI32 motion_x = hn::ShiftRight<16>(hn::ShiftLeft<16>(asSigned(owners.motion)));
    const VI32 motion_y = hn::ShiftRight<16>(asSigned(owners.motion));
    const VI32 fraction = hn::Set(di, 255);
    const VI32 slope = asSigned(hn::Sub(depth, clampedLogDepth(hn::LoadU(d, job.now.depth + at))));
    const VI32 tolerance =
        hn::Add(hn::Set(di, kDepthTolerance), hn::Mul(slope, hn::Set(di, kSlopeFactor)));
    // Where some surfaces move, resting ones with other numbers are left to resolvePixel().
    const auto moved = hn::Gt(asSigned(owners.id), hn::Set(di, kMovedBit - 1));
    const V32 strict = job.at_rest != nullptr
                           ? hn::Set(d, 0xFFFFu)
                           : hn::IfThenElseZero(hn::RebindMask(d, moved), hn::Set(d, 0xFFFFu));
    Sums none;
    for (int c = 0; c < 3; ++c) {
        none.mean[c] = hn::Zero(d);
        none.rest[c] = hn::Zero(di);
    }
    none.count = hn::Set(d, 255u);
    return {job,
            x,
            y,
            at,
            hn::And(owners.id, hn::Set(d, kSurfaceMask)),
            owners.expected,
            owners.normal,
            asUnsigned(hn::Min(tolerance, hn::Set(di, 65535))),
            strict,
            motion_x,
            motion_y,
            hn::And(motion_x, fraction),
            hn::And(motion_y, fraction),
            none};
}

HWY_INLINE void resolveGroup(const ResolveJob& job, const TileRect& tile, const OwnerStrip& strip,
                             int x, int y, TileResult& result) {
    const D32 d;
    const DI32 di;
    const ptrdiff_t at = y * job.stride + x;
    const Owners owners = ownersOf(strip, x - tile.x0);
    const V32 own_id = load16(job.now.id + at);
    const V32 depth = clampedLogDepth(owners.depth);
    storeOwners(job, at, owners, depth);

    Group g = makeGroup(job, x, y, owners, depth);
    const Mask32 pixels = lanesBefore(tile.x1 - x);
    const auto has_motion = hn::RebindMask(d, hn::Ne(g.motion_x, hn::Set(di, kNoHistory)));
    Mask32 open = hn::And(hn::And(pixels, has_motion), hn::Eq(own_id, owners.id));
    Mask32 kept = noLanes();
    Mask32 done = noLanes();
    if (!job.camera_moved) {
        const Mask32 rests = hn::Lt(owners.id, hn::Set(d, kMovedBit));
        const Mask32 proven = hn::And(open, rests);
        done = resolveProven(g, proven, kept);
        open = hn::AndNot(proven, open);
    }
    done = hn::Or(done, resolveByMotion(g, open, hn::ShiftRight<8>(g.motion_x),
                                        hn::ShiftRight<8>(g.motion_y)));
    storeSums(job.next, at, g.sums);
    report(result, job, hn::And(pixels, done), g.sums.count, kept);
    for (uint64_t left = bitsOf(hn::AndNot(done, pixels)); left != 0; left &= left - 1) {
        const int lane = std::countr_zero(left);
        result.changed |= !resolvePixel(job, x + lane, y);
        result.finished &= int(job.next.count[at + lane]) >= job.sample_cap;
    }
}

/// The row of owners below is already loaded; history is expected where the row's middle comes
/// from.
HWY_INLINE void prefetchRow(const ResolveJob& job, const TileRect& tile, int y) {
    const int ahead = std::min(y + kRowsAhead, job.height - 1);
    const int below = std::min(ahead + 1, job.height - 1);
    const ptrdiff_t now = below * job.stride + tile.x0;
    for (int quarter = 0; quarter < kTileSize; quarter += 16) {
        hwy::Prefetch(job.now.depth + now + quarter);
        hwy::Prefetch(job.now.motion + now + quarter);
        if (job.now.normal != nullptr) {
            hwy::Prefetch(job.now.normal + now + quarter);
        }
    }
    for (int half = 0; half < kTileSize; half += 32) {
        hwy::Prefetch(job.now.id + now + half);
        hwy::Prefetch(job.now.depth_before + now + half);
    }
    const Motion motion = job.now.motion[y * job.stride + (tile.x0 + tile.x1) / 2];
    const int from_x = std::clamp(tile.x0 + (motion.x_fx8 >> 8), 0, job.width - 1);
    const int from_y = std::clamp(ahead + 2 + (motion.y_fx8 >> 8), 0, job.height - 1);
    const ptrdiff_t from = from_y * job.stride + from_x;
    prefetchPixels(job, ahead * job.stride + tile.x0, from);
    prefetchOwners(job, ahead * job.stride + tile.x0, from);
}

HWY_ATTR TileResult resolveGeneral(const ResolveJob& job, const TileRect& tile) {
    const int lanes = int(hn::Lanes(D32()));
    TileResult result{true, false};
    OwnerStrip strip;
    for (int y = tile.y0; y < tile.y1; ++y) {
        prefetchRow(job, tile, y);
        fillStrip(job, tile, y, strip);
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            resolveGroup(job, tile, strip, x, y, result);
        }
    }
    return result;
}

TileResult resolveTile(const ResolveJob& job, const TileRect& tile, TileWork work) noexcept {
    if (work == TileWork::still) {
        return resolveStill(job, tile);
    }
    if (work == TileWork::fresh) {
        return resolveFresh(job, tile);
    }
    // A frame with changed light holds every pixel against its window; a cap of 1 keeps nothing.
    if (job.shading_changed || job.sample_cap == 1) {
        return resolveTileReference(job, tile, work);
    }
    return resolveGeneral(job, tile);
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
