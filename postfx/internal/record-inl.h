// Samples and owners of a frame into the ring, in lanes; record_reference.cpp is the truth. Most
// windows show one smooth surface, whose owner is the centre itself: that is found first, and only
// other groups look for the nearest sample. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// A tile's row is only a few cache lines of each of many planes, too short for the hardware to see
/// a pattern: the same place a few rows on is asked for in time.
constexpr int kRowsAhead = 2;
constexpr ptrdiff_t kLineBytes = 64;
template <class T>
HWY_INLINE void prefetchRow(const T* row, int pixels) {
    for (int i = 0; i < pixels; i += int(kLineBytes / ptrdiff_t(sizeof(T)))) {
        hwy::Prefetch(row + i);
    }
}

/// The blocks of a vector that ReorderDemote2To made, in order.
HWY_INLINE VS blocksInOrder(VS v) {
    constexpr int kBlocks = kHalves / 8;
    if constexpr (kBlocks <= 1) {
        return v;
    } else {
        const hn::Repartition<uint64_t, DS> d64;
        alignas(64) static constexpr uint64_t kFour[4] = {0, 2, 1, 3};
        alignas(64) static constexpr uint64_t kEight[8] = {0, 2, 4, 6, 1, 3, 5, 7};
        const auto order = hn::SetTableIndices(d64, kBlocks == 2 ? kFour : kEight);
        return hn::BitCast(DS(), hn::TableLookupLanes(hn::BitCast(d64, v), order));
    }
}

/// logDepth16 less kOffset.
HWY_INLINE VS logDepths(const uint32_t* bits) {
    constexpr int32_t kTop = int32_t(0x3F800000u >> 12) - 65535;
    const DWU d;
    const VW offset = hn::Set(DW(), kTop + kOffset);
    const auto scaled = [&](const uint32_t* p) {
        return hn::Sub(hn::BitCast(DW(), hn::ShiftRight<12>(hn::LoadU(d, p))), offset);
    };
    return blocksInOrder(narrow(scaled(bits), scaled(bits + kHalves / 2)));
}

/// Low and high halves of words.
struct Halves {
    VS low, high;
};
HWY_INLINE Halves splitWords(const void* words) {
    const DS d;
    const auto* p = static_cast<const int16_t*>(words);
    const VS a = hn::LoadU(d, p), b = hn::LoadU(d, p + kHalves);
    return {hn::ConcatEven(d, b, a), hn::ConcatOdd(d, b, a)};
}
/// compactNormal()
HWY_INLINE VS compactNormals(const uint32_t* words) {
    const Halves n = splitWords(words);
    return hn::Or(sign(hn::ShiftRight<8>(unsign(n.low))), hn::And(n.high, set(0xFF00 - 65536)));
}

/// A row of logDepth16 less kOffset, with a column more on each side.
struct DepthRow {
    static constexpr int kFirst = kMaxHalves;
    alignas(64) int16_t depth[kTileSize + 2 * kMaxHalves];
};

HWY_INLINE void fillDepths(const Job& job, const TileRect& tile, int y, DepthRow& row) {
    const uint32_t* bits = job.now.depth + y * job.stride + tile.x0;
    const int width = tile.x1 - tile.x0;
    int16_t* out = row.depth + DepthRow::kFirst;
    for (int i = 0; i < width; i += kHalves) {
        hn::StoreU(logDepths(bits + i), DS(), out + i);
    }
    // Nothing is farther than what lies outside the picture.
    out[-1] = lessOffset(tile.x0 > 0 ? logDepth16(bits[-1]) : 0);
    out[width] = lessOffset(tile.x1 < job.width ? logDepth16(bits[width]) : 0);
}

/// Three rows of the picture around a group of pixels; rows outside repeat the middle one.
struct Rows {
    const int16_t* depth[3];
    ptrdiff_t at[3];  ///< index of the group's first pixel, a row up or down
};

/// seenOwner() of a group.
struct SeenLanes {
    VS id, depth, expected, slope, normal;
    VS motion[2];
};

HWY_INLINE VS idsAt(const Job& job, ptrdiff_t at) {
    return sign(hn::LoadU(DU(), job.now.id + at));
}

/// Every window of the group shows one surface without a step in depth.
HWY_INLINE bool smooth(const Job& job, const Rows& rows, VS id, VS depth) {
    VS other = zero(), nearest = depth;
    for (int j = 0; j < 3; ++j) {
        for (int i = -1; i <= 1; ++i) {
            other = hn::Or(other, hn::Xor(idsAt(job, rows.at[j] + i), id));
            nearest = hn::Max(nearest, load(rows.depth[j] + i));
        }
    }
    const MS step = hn::Gt(hn::SaturatedSub(nearest, depth), set(job.centre_tolerance));
    const MS seam = hn::Ne(hn::And(other, set(kSurfaceMask)), zero());
    return !any(hn::Or(step, seam));
}

/// The nearest samples of the windows, or the centres where they show the same surface.
HWY_INLINE VS findNearest(const Job& job, const Rows& rows, SeenLanes& seen) {
    struct Best {
        VS depth, id, which;
    };
    const auto sample = [&](int j, int i) {
        return Best{load(rows.depth[j] + i), idsAt(job, rows.at[j] + i), set(j * 3 + i + 1)};
    };
    const auto take = [](Best& best, const Best& other) {
        const MS nearer = hn::Gt(other.depth, best.depth);
        best.depth = hn::Max(other.depth, best.depth);
        best.id = hn::IfThenElse(nearer, other.id, best.id);
        best.which = hn::IfThenElse(nearer, other.which, best.which);
    };
    const Best best = bestOfWindow(sample, take);
    const VS mask = set(kSurfaceMask);
    const MS same = hn::Eq(hn::And(best.id, mask), hn::And(seen.id, mask));
    const VS step = hn::SaturatedSub(best.depth, seen.depth);
    const MS centre = hn::AndNot(hn::Gt(step, set(job.centre_tolerance)), same);
    seen.slope = hn::IfThenElseZero(hn::AndNot(centre, same), hn::Min(step, set(kMaxSlope)));
    seen.id = hn::IfThenElse(centre, seen.id, best.id);
    seen.depth = hn::IfThenElse(centre, seen.depth, best.depth);
    return hn::IfThenElse(centre, set(4), best.which);
}

/// What belongs to samples that are not the centres.
HWY_INLINE void fetchOthers(const Job& job, const Rows& rows, VS which, SeenLanes& seen) {
    const DS d;
    alignas(64) int16_t from[kHalves], x[kHalves], y[kHalves], expected[kHalves], normal[kHalves];
    hn::Store(which, d, from);
    hn::Store(seen.motion[0], d, x);
    hn::Store(seen.motion[1], d, y);
    hn::Store(seen.expected, d, expected);
    hn::Store(seen.normal, d, normal);
    for (int i = 0; i < kHalves; ++i) {
        if (from[i] == 4) {
            continue;
        }
        const ptrdiff_t at = rows.at[from[i] / 3] + from[i] % 3 - 1 + i;
        x[i] = job.now.motion[at].x_fx8;
        y[i] = job.now.motion[at].y_fx8;
        expected[i] = lessOffset(job.now.depth_before[at]);
        if (job.now.normal != nullptr) {
            normal[i] = int16_t(compactNormal(job.now.normal[at]));
        }
    }
    seen.motion[0] = hn::Load(d, x);
    seen.motion[1] = hn::Load(d, y);
    seen.expected = hn::Load(d, expected);
    seen.normal = hn::Load(d, normal);
}

HWY_INLINE SeenLanes seenOwners(const Job& job, const Rows& rows) {
    const ptrdiff_t at = rows.at[1];
    const Halves motion = splitWords(job.now.motion + at);
    SeenLanes seen{idsAt(job, at),
                   load(rows.depth[1]),
                   flipTop(sign(hn::LoadU(DU(), job.now.depth_before + at))),
                   zero(),
                   zero(),
                   {motion.low, motion.high}};
    if (job.now.normal != nullptr) {
        seen.normal = compactNormals(job.now.normal + at);
    }
    if (!smooth(job, rows, seen.id, seen.depth)) {
        const VS which = findNearest(job, rows, seen);
        if (any(hn::Ne(which, set(4)))) {
            fetchOthers(job, rows, which, seen);
        }
    }
    return seen;
}

/// What is recorded of the owners.
struct Recorded {
    VS owner, depth, hint, normal;
    VS motion[2];
};

/// Places a motion away, rounded to pixels, and whether they lie in the picture.
struct Target {
    VS column, row;  ///< column less the lane's number
    MS inside;
};
HWY_INLINE Target targetOf(const Job& job, int x, int y, const VS motion[2]) {
    const auto rounded = [](VS v) {
        return hn::Add(hn::ShiftRight<8>(v), hn::And(hn::ShiftRight<7>(v), set(1)));
    };
    const VS dx = rounded(motion[0]), row = hn::Add(set(y), rounded(motion[1]));
    const VS out = hn::Or(beyond(hn::Add(hn::Iota(DS(), int16_t(x)), dx), job.width - 1),
                          beyond(row, job.height - 1));
    return {hn::Add(set(x), dx), row, hn::Eq(out, zero())};
}

/// inferOwner() for `found`.
HWY_INLINE void inferOwners(const Job& job, int x, int y, MS found, const SeenLanes& seen,
                            Recorded& out) {
    const SlotIn& before = job.slot[1];
    const VS mask = set(kSurfaceMask);
    const Target target = targetOf(job, x, y, seen.motion);
    found = hn::And(found, target.inside);
    found = hn::AndNot(hn::Eq(seen.motion[0], set(kNoHistory)), found);
    if (!any(found)) {
        return;
    }
    VS depth = zero();
    forClusters(target.column, target.row, found, [&](int column, int row, MS lanes) {
        hwy::Prefetch(before.owner_depth + (row + kRowsAhead) * job.stride + column);
        depth = hn::IfThenElse(lanes, load(before.owner_depth + row * job.stride + column), depth);
    });
    const VS slope = hn::Add(hn::Add(seen.slope, seen.slope), seen.slope);
    static_assert(kSlopeFactor == 3);
    const VS bound = hn::SaturatedAdd(seen.expected, hn::Add(slope, set(kDepthTolerance)));
    found = hn::And(found, hn::Gt(depth, bound));
    if (!any(found)) {
        return;
    }
    VS owner = zero(), motion[2] = {owner, owner};
    forClusters(target.column, target.row, found, [&](int column, int row, MS lanes) {
        const ptrdiff_t at = row * job.stride + column;
        owner = hn::IfThenElse(lanes, load(before.owner + at), owner);
        motion[0] = hn::IfThenElse(lanes, load(before.motion[0] + at), motion[0]);
        motion[1] = hn::IfThenElse(lanes, load(before.motion[1] + at), motion[1]);
    });
    found = hn::AndNot(hn::Lt(owner, zero()), found);  // kInferredBit
    found = hn::AndNot(hn::Eq(owner, hn::And(seen.id, mask)), found);
    found = hn::AndNot(hn::Eq(motion[0], set(kNoHistory)), found);
    if (job.start_age != nullptr && any(found)) {
        const VS age = lookUp(job.start_age, hn::And(owner, mask));
        found = hn::AndNot(hn::Eq(age, zero()), found);
    }
    const Target source = targetOf(job, x, y, motion);
    found = hn::And(found, source.inside);
    if (!any(found)) {
        return;
    }
    VS from_owner = zero(), from_depth = zero(), normal = zero();
    forClusters(source.column, source.row, found, [&](int column, int row, MS lanes) {
        const ptrdiff_t at = row * job.stride + column;
        from_owner = hn::IfThenElse(lanes, load(before.owner + at), from_owner);
        from_depth = hn::IfThenElse(lanes, load(before.owner_depth + at), from_depth);
        normal = hn::IfThenElse(lanes, load(before.normal + at), normal);
        motion[0] = hn::IfThenElse(lanes, load(before.motion[0] + at), motion[0]);
        motion[1] = hn::IfThenElse(lanes, load(before.motion[1] + at), motion[1]);
    });
    found = hn::And(found, hn::Eq(from_owner, owner));
    found = hn::AndNot(hn::Gt(distance(from_depth, depth), set(kDepthTolerance)), found);
    out.owner = hn::IfThenElse(found, hn::Or(from_owner, set(kInferredBit - 65536)), out.owner);
    out.depth = hn::IfThenElse(found, from_depth, out.depth);
    out.hint = hn::IfThenZeroElse(found, out.hint);
    out.normal = hn::IfThenElse(found, normal, out.normal);
    out.motion[0] = hn::IfThenElse(found, motion[0], out.motion[0]);
    out.motion[1] = hn::IfThenElse(found, motion[1], out.motion[1]);
}

HWY_INLINE void recordGroup(const Job& job, const Rows& rows, int x, int y, int end) {
    const DS d;
    const ptrdiff_t at = rows.at[1];
    const SeenLanes seen = seenOwners(job, rows);
    const VS limit = set(kMaxStep);
    const VS step =
        hn::Max(hn::Min(hn::SaturatedSub(seen.expected, seen.depth), limit), set(-kMaxStep));
    const VS moved = sign(hn::ShiftRight<15>(unsign(seen.id)));
    Recorded owner{hn::And(seen.id, set(kSurfaceMask)),
                   seen.depth,
                   hn::Or(hn::Add(step, step), moved),
                   seen.normal,
                   {seen.motion[0], seen.motion[1]}};
    if (job.frames > 1) {
        inferOwners(job, x, y, lanesUnder(end - x), seen, owner);
    }
    const SlotOut& out = job.record;
    for (int c = 0; c < 3; ++c) {
        hn::StoreU(flipTop(sign(hn::LoadU(DU(), job.now.colour[c] + at))), d, out.colour[c] + at);
    }
    hn::StoreU(idsAt(job, at), d, out.id + at);
    hn::StoreU(load(rows.depth[1]), d, out.depth + at);
    hn::StoreU(owner.depth, d, out.owner_depth + at);
    hn::StoreU(owner.owner, d, out.owner + at);
    hn::StoreU(owner.motion[0], d, out.motion[0] + at);
    hn::StoreU(owner.motion[1], d, out.motion[1] + at);
    hn::StoreU(owner.normal, d, out.normal + at);
    hn::StoreU(owner.hint, d, job.hint + at);
}

HWY_INLINE void prefetchSamples(const Job& job, const TileRect& tile, int y) {
    const ptrdiff_t at = y * job.stride + tile.x0;
    const int width = tile.x1 - tile.x0 + 1;
    const Current& now = job.now;
    for (const uint16_t* plane :
         {now.colour[0], now.colour[1], now.colour[2], now.id, now.depth_before}) {
        prefetchRow(plane + at, width);
    }
    prefetchRow(now.depth + at + job.stride, width);
    prefetchRow(now.motion + at, width);
    if (now.normal != nullptr) {
        prefetchRow(now.normal + at, width);
    }
}

HWY_ATTR void recordTile(const Job& job, const TileRect& tile) noexcept {
    DepthRow depths[3];
    if (tile.y0 > 0) {
        fillDepths(job, tile, tile.y0 - 1, depths[(tile.y0 - 1) % 3]);
    }
    fillDepths(job, tile, tile.y0, depths[tile.y0 % 3]);
    for (int y = tile.y0; y < tile.y1; ++y) {
        const int up = y > 0 ? y - 1 : y, down = y + 1 < job.height ? y + 1 : y;
        if (down > y) {
            fillDepths(job, tile, down, depths[down % 3]);
        }
        if (y + kRowsAhead + 1 < tile.y1) {
            prefetchSamples(job, tile, y + kRowsAhead);
        }
        for (int x = tile.x0; x < tile.x1; x += kHalves) {
            Rows rows;
            for (int j = 0; j < 3; ++j) {
                const int row = j == 0 ? up : (j == 1 ? y : down);
                rows.depth[j] = depths[row % 3].depth + DepthRow::kFirst + (x - tile.x0);
                rows.at[j] = row * job.stride + x;
            }
            recordGroup(job, rows, x, y, tile.x1);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
