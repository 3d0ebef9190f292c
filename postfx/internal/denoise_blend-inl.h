// What a pixel shows, and present and past light blended, in lanes; denoise_reference.cpp is the
// truth. Included once per target by denoise_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::denoising {
namespace HWY_NAMESPACE {

/// decodeOctahedral(), one axis.
HWY_INLINE VF octahedralAxis(VI half) {
    return div(hn::ConvertTo(DF(), half), set(32767.0f));
}

/// v, with the sign of `of`; 0 counts as positive.
HWY_INLINE VF signedLike(VF v, VF of) {
    return hn::Mul(v, hn::IfThenElse(hn::Lt(of, hn::Zero(DF())), set(-1.0f), set(1.0f)));
}

/// stepAt(). `first`, `last`: lanes without a neighbour on that side; not both.
HWY_INLINE VF stepLanes(VF here, VF before, VF after, MF first, MF last) {
    const VF toward = hn::Sub(here, before), away = hn::Sub(after, here);
    const VF ahead = hn::IfThenElse(last, toward, away);
    const VF back = hn::IfThenElse(first, ahead, toward);
    return hn::IfThenElse(hn::Lt(hn::Abs(back), hn::Abs(ahead)), back, ahead);
}

HWY_INLINE void guidesGroup(const Job& job, int x, int y) {
    const DF d;
    const ptrdiff_t at = y * job.stride + x;
    const VI surface = hn::And(loadInt(job.id + at), setInt(kSurfaceMask));
    hn::StoreU(hn::DemoteTo(D16(), surface), D16(), job.now.surface + at);

    const VI bits = hn::LoadU(DI(), reinterpret_cast<const int32_t*>(job.depth) + at);
    // logDepth16()
    const VI log = hn::Sub(hn::ShiftRight<12>(bits), setInt(int32_t(0x3F800000u >> 12) - 65535));
    const VI held = hn::Min(hn::Max(log, setInt(0)), setInt(65535));
    hn::StoreU(hn::DemoteTo(D16(), held), D16(), job.now.depth + at);

    const VI packed = hn::LoadU(DI(), reinterpret_cast<const int32_t*>(job.normal) + at);
    const VF u = octahedralAxis(hn::ShiftRight<16>(hn::ShiftLeft<16>(packed)));
    const VF v = octahedralAxis(hn::ShiftRight<16>(packed));
    const VF one = set(1.0f);
    const VF nz = hn::Sub(hn::Sub(one, hn::Abs(u)), hn::Abs(v));
    const MF folded = hn::Lt(nz, hn::Zero(d));
    const VF nx = hn::IfThenElse(folded, signedLike(hn::Sub(one, hn::Abs(v)), u), u);
    const VF ny = hn::IfThenElse(folded, signedLike(hn::Sub(one, hn::Abs(u)), v), v);
    const VF square = hn::Add(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)), hn::Mul(nz, nz));
    const MF background = hn::RebindMask(d, hn::Eq(surface, setInt(0)));
    const VF scale = hn::IfThenZeroElse(background, div(one, squareRoot(square)));
    store(hn::Mul(nx, scale), job.now.normal[0] + at);
    store(hn::Mul(ny, scale), job.now.normal[1] + at);
    store(hn::Mul(nz, scale), job.now.normal[2] + at);

    const VF here = loadDepth(job.depth + at);
    const MF never = noLanes(), every = hn::Not(never);
    if (job.width == 1) {
        store(hn::Zero(d), job.step[0] + at);
    } else {
        const MF first = hn::Not(lanesWithin(x, 1, job.width));
        const MF last = hn::Not(lanesWithin(x, 0, job.width - 1));
        store(stepLanes(here, loadDepth(job.depth + at - 1), loadDepth(job.depth + at + 1), first,
                        last),
              job.step[0] + at);
    }
    if (job.height == 1) {
        store(hn::Zero(d), job.step[1] + at);
    } else {
        const bool top = y == 0, bottom = y + 1 == job.height;
        const VF above = top ? here : loadDepth(job.depth + at - job.stride);
        const VF below = bottom ? here : loadDepth(job.depth + at + job.stride);
        store(stepLanes(here, above, below, top ? every : never, bottom ? every : never),
              job.step[1] + at);
    }
}

HWY_ATTR void guidesTile(const Job& job, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; x += laneCount()) {
            guidesGroup(job, x, y);
        }
    }
}

/// Found
struct FoundLanes {
    VF light[kChannels], square[kParts], count[kParts], age[kParts], weight;

    HWY_INLINE void clear() {
        weight = hn::Zero(DF());
        for (int c = 0; c < kChannels; ++c) {
            light[c] = weight;
        }
        for (int p = 0; p < kParts; ++p) {
            square[p] = count[p] = age[p] = weight;
        }
    }
    HWY_INLINE void scale(VF by) {
        for (int c = 0; c < kChannels; ++c) {
            light[c] = hn::Mul(light[c], by);
        }
        for (int p = 0; p < kParts; ++p) {
            square[p] = hn::Mul(square[p], by);
            count[p] = hn::Mul(count[p], by);
            age[p] = hn::Mul(age[p], by);
        }
    }
};

/// What the past must be like.
struct WantedLanes {
    VI surface, depth, tolerance;
    VF normal[3], cosine;
};

HWY_INLINE WantedLanes wantedLanes(const Job& job, ptrdiff_t at) {
    WantedLanes w;
    w.surface = loadInt(job.now.surface + at);
    w.depth = loadInt(job.depth_before + at);
    const VF step = hn::Max(hn::Abs(load(job.step[0] + at)), hn::Abs(load(job.step[1] + at)));
    // pastTolerance()
    const VF steep = div(step, hn::Add(loadDepth(job.depth + at), set(1e-12f)));
    const VF slope = hn::Mul(hn::Min(steep, set(1.0f)), set(kSlopeFactor));
    const VI tolerance = hn::Add(setInt(kDepthTolerance), hn::ConvertTo(DI(), slope));
    const auto rests =
        hn::Eq(hn::LoadU(DI(), reinterpret_cast<const int32_t*>(job.motion) + at), setInt(0));
    w.tolerance = hn::IfThenElse(rests, setInt(65535), tolerance);
    w.cosine = hn::IfThenElse(hn::RebindMask(DF(), rests), set(-2.0f), set(kPastCosine));
    for (int c = 0; c < 3; ++c) {
        w.normal[c] = load(job.now.normal[c] + at);
    }
    return w;
}

/// fits()
HWY_INLINE MF fitLanes(const Job& job, const WantedLanes& w, ptrdiff_t from) {
    const Past& past = job.before;
    const VI off = hn::Abs(hn::Sub(loadInt(past.depth + from), w.depth));
    const auto apart =
        hn::Or(hn::Ne(loadInt(past.surface + from), w.surface), hn::Gt(off, w.tolerance));
    const VF cosine = hn::Add(hn::Add(hn::Mul(w.normal[0], load(past.normal[0] + from)),
                                      hn::Mul(w.normal[1], load(past.normal[1] + from))),
                              hn::Mul(w.normal[2], load(past.normal[2] + from)));
    return hn::AndNot(hn::RebindMask(DF(), apart), hn::Ge(cosine, w.cosine));
}

HWY_INLINE void addPastLanes(const Past& past, ptrdiff_t from, MF lanes, VF weight, FoundLanes& f) {
    // What is masked may be anything: its products must not count.
    const auto add = [&](VF& sum, VF value) {
        sum = hn::Add(sum, hn::IfThenElseZero(lanes, hn::Mul(weight, value)));
    };
    for (int c = 0; c < kChannels; ++c) {
        add(f.light[c], load(past.light[c] + from));
    }
    for (int p = 0; p < kParts; ++p) {
        add(f.square[p], load(past.square[p] + from));
        add(f.count[p], loadByte(past.count[p] + from));
        add(f.age[p], loadByte(past.age[p] + from));
    }
    f.weight = hn::Add(f.weight, hn::IfThenElseZero(lanes, weight));
}

/// The 2×2 samples of `lanes`, whose places all lie `dx`, `dy` whole pixels away.
HWY_INLINE void addCluster(const Job& job, const WantedLanes& wanted, int x, int y, int dx, int dy,
                           VI fx, VI fy, MF lanes, FoundLanes& f) {
    const int lane_count = laneCount();
    for (int tap = 0; tap < 4; ++tap) {
        const int i = tap & 1, j = tap >> 1;
        const int row = y + dy + j, column = x + dx + i;
        if (row < 0 || row >= job.height || column + lane_count <= 0 || column >= job.width) {
            continue;
        }
        const VI wx = i != 0 ? fx : hn::Sub(setInt(256), fx);
        const VI wy = j != 0 ? fy : hn::Sub(setInt(256), fy);
        const VF weight = hn::ConvertTo(DF(), hn::Mul(wx, wy));
        MF taken = hn::And(lanes, hn::Gt(weight, hn::Zero(DF())));
        taken = hn::And(taken, lanesWithin(column, 0, job.width));
        if (!any(taken)) {
            continue;
        }
        const ptrdiff_t from = row * job.stride + column;
        taken = hn::And(taken, fitLanes(job, wanted, from));
        addPastLanes(job.before, from, taken, weight, f);
    }
}

/// Motion in lanes.
HWY_INLINE void loadMotion(const Motion* motion, VI& mx, VI& my) {
    const VI both = hn::LoadU(DI(), reinterpret_cast<const int32_t*>(motion));
    mx = hn::ShiftRight<16>(hn::ShiftLeft<16>(both));
    my = hn::ShiftRight<16>(both);
}

/// findPast(), without the 3×3; lanes that need it are returned.
HWY_INLINE MF findLanes(const Job& job, int x, int y, MF pixels, FoundLanes& f, MF& exact) {
    const ptrdiff_t at = y * job.stride + x;
    f.clear();
    exact = noLanes();
    if (!job.has_past) {
        return exact;
    }
    const DF d;
    VI mx, my;
    loadMotion(job.motion + at, mx, my);
    const MF known = hn::RebindMask(d, hn::Ne(mx, setInt(kNoHistory)));
    const MF sought = hn::And(pixels, known);
    const WantedLanes wanted = wantedLanes(job, at);
    const VI fx = hn::And(mx, setInt(255)), fy = hn::And(my, setInt(255));
    alignas(64) int32_t dx[kMostLanes], dy[kMostLanes];
    hn::Store(hn::ShiftRight<8>(mx), DI(), dx);
    hn::Store(hn::ShiftRight<8>(my), DI(), dy);
    MF left = sought;
    for (intptr_t first = hn::FindFirstTrue(d, left); first >= 0;
         first = hn::FindFirstTrue(d, left)) {
        const auto same = hn::And(hn::Eq(hn::Load(DI(), dx), setInt(dx[first])),
                                  hn::Eq(hn::Load(DI(), dy), setInt(dy[first])));
        const MF lanes = hn::And(left, hn::RebindMask(d, same));
        addCluster(job, wanted, x, y, dx[first], dy[first], fx, fy, lanes, f);
        left = hn::AndNot(lanes, left);
    }
    const auto whole = hn::Eq(hn::Or(fx, fy), setInt(0));
    exact = hn::And(hn::RebindMask(d, whole), hn::Eq(f.weight, set(65536.0f)));
    f.scale(hn::IfThenElseZero(hn::Gt(f.weight, hn::Zero(d)),
                               div(set(1.0f), hn::Max(f.weight, set(1.0f)))));
    return hn::And(sought, hn::Lt(f.weight, set(float(kEnoughPast))));
}

struct ChangeLanes {
    VF ratio[kParts], unsure[kParts];
};

HWY_INLINE ChangeLanes changeLanes(const Job& job, int x, int y, int count) {
    ChangeLanes lanes;
    alignas(64) float ratio[kMostLanes] = {}, unsure[kMostLanes] = {};
    for (int p = 0; p < kParts; ++p) {
        lanes.ratio[p] = set(1.0f);
        lanes.unsure[p] = hn::Zero(DF());
        if (job.change[p] == nullptr) {
            continue;
        }
        for (int i = 0; i < count; ++i) {
            const BlockChange change = changeAt(job, p, x + i, y);
            ratio[i] = change.ratio;
            unsure[i] = change.unsure;
        }
        lanes.ratio[p] = hn::Load(DF(), ratio);
        lanes.unsure[p] = hn::Load(DF(), unsure);
    }
    return lanes;
}

HWY_INLINE void blendGroup(const Job& job, int x, int y, int count) {
    const DF d;
    const ptrdiff_t at = y * job.stride + x;
    const VF zero = hn::Zero(d), one = set(1.0f);
    const MF surface = hn::RebindMask(d, hn::Ne(loadInt(job.now.surface + at), setInt(0)));
    const MF pixels = hn::And(surface, lanesWithin(x, x, x + count));
    FoundLanes found;
    MF exact;
    const MF apart = findLanes(job, x, y, pixels, found, exact);
    const ChangeLanes change = changeLanes(job, x, y, count);
    const MF has_past = hn::Gt(found.weight, zero);
    const VF longest =
        hn::IfThenElse(exact, set(float(kLongest - 1)), set(float(kLongestMoving - 1)));
    VI mx, my;
    loadMotion(job.motion + at, mx, my);
    const MF rests =
        job.has_past ? hn::RebindMask(d, hn::Eq(hn::Or(mx, my), setInt(0))) : noLanes();
    const VF most = set(255.0f);
    const VF still = job.has_past
                         ? hn::IfThenElseZero(
                               rests, hn::Min(hn::Add(loadByte(job.before.still + at), one), most))
                         : zero;
    const MF young = hn::Eq(still, set(float(kYoungFrames)));
    VF light_age = most;
    for (int p = 0; p < kParts; ++p) {
        const VF even = div(one, hn::Add(hn::Min(found.count[p], longest), one));
        const VF grown = hn::Add(even, hn::Mul(hn::Sub(one, even), change.unsure[p]));
        const VF share = hn::IfThenElse(has_past, grown, one);
        VF sample[3];
        for (int c = 0; c < 3; ++c) {
            sample[c] = loadLight(job.noisy[3 * p + c] + at);
            const VF past = hn::Mul(found.light[3 * p + c], change.ratio[p]);
            const VF mean = hn::Add(past, hn::Mul(hn::Sub(sample[c], past), share));
            const VF held = hn::IfThenElseZero(surface, mean);
            store(held, job.now.light[3 * p + c] + at);
            storeLight(held, job.first.light[3 * p + c] + at);
        }
        const VF bright = luminanceLanes(sample[0], sample[1], sample[2]);
        const VF past_square = hn::Mul(found.square[p], hn::Mul(change.ratio[p], change.ratio[p]));
        const VF square =
            hn::Add(past_square, hn::Mul(hn::Sub(hn::Mul(bright, bright), past_square), share));
        store(hn::IfThenElseZero(surface, square), job.now.square[p] + at);
        storeByte(hn::IfThenElseZero(surface, div(one, share)), job.now.count[p] + at);
        const VF drift = hn::Max(hn::Abs(hn::Sub(change.ratio[p], one)),
                                 hn::Mul(change.unsure[p], set(kDriftPart)));
        const VF bound = hn::IfThenElse(
            hn::Gt(drift, zero),
            hn::Min(set(255.0f), div(set(kAgeDrift), hn::Max(drift, set(1e-9f)))), set(255.0f));
        const MF grown_up = hn::And(young, hn::Le(found.count[p], set(float(kYoungFrames))));
        const VF oldest = hn::IfThenElse(grown_up, set(float(kYoungKept)), set(255.0f));
        const VF older = hn::Min(hn::Add(found.age[p], one), oldest);
        const VF age = hn::IfThenElse(has_past, hn::Min(older, bound), set(255.0f));
        storeByte(hn::IfThenElseZero(surface, age), job.now.age[p] + at);
        light_age = hn::Min(light_age, hn::Floor(hn::Add(age, set(0.5f))));
    }
    storeByte(hn::IfThenElse(surface, light_age, most), job.light_age + at);
    storeByte(still, job.now.still + at);
    if (any(apart)) {
        alignas(64) float asks[kMostLanes];
        hn::Store(hn::IfThenElseZero(apart, one), d, asks);
        for (int i = 0; i < count; ++i) {
            if (asks[i] != 0) {
                blendPixel(job, x + i, y);
            }
        }
    }
}

HWY_ATTR void blendTile(const Job& job, const TileRect& tile) noexcept {
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; x += laneCount()) {
            blendGroup(job, x, y, std::min(laneCount(), tile.x1 - x));
        }
    }
}

HWY_INLINE VF pastLuminanceLanes(const Job& job, int part, ptrdiff_t at) {
    return luminanceLanes(load(job.now.light[3 * part] + at),
                          load(job.now.light[3 * part + 1] + at),
                          load(job.now.light[3 * part + 2] + at));
}

/// alike(), of pixels that lie inside.
HWY_INLINE MF alikeLanes(const Job& job, ptrdiff_t a, ptrdiff_t b) {
    const VF cosine =
        hn::Add(hn::Add(hn::Mul(load(job.now.normal[0] + a), load(job.now.normal[0] + b)),
                        hn::Mul(load(job.now.normal[1] + a), load(job.now.normal[1] + b))),
                hn::Mul(load(job.now.normal[2] + a), load(job.now.normal[2] + b)));
    const VI off = hn::Abs(hn::Sub(loadInt(job.now.depth + a), loadInt(job.now.depth + b)));
    const auto apart = hn::Or(hn::Gt(off, setInt(kAroundTolerance)),
                              hn::Eq(loadInt(job.now.surface + b), setInt(0)));
    return hn::AndNot(hn::RebindMask(DF(), apart), hn::Ge(cosine, set(kPastCosine)));
}

/// variedAround()
HWY_NOINLINE VF variedAroundLanes(const Job& job, int part, int x, int y) {
    const ptrdiff_t at = y * job.stride + x;
    const VF zero = hn::Zero(DF()), one = set(1.0f);
    VF total = zero, sum = zero, squares = zero;
    for (int j = std::max(y - kAround, 0); j <= std::min(y + kAround, job.height - 1); ++j) {
        for (int i = -kAround; i <= kAround; ++i) {
            const ptrdiff_t from = j * job.stride + x + i;
            const MF in = hn::And(lanesWithin(x + i, 0, job.width), alikeLanes(job, at, from));
            const VF bright = pastLuminanceLanes(job, part, from);
            total = hn::Add(total, hn::IfThenElseZero(in, one));
            sum = hn::Add(sum, hn::IfThenElseZero(in, bright));
            squares = hn::Add(squares, hn::IfThenElseZero(in, load(job.now.square[part] + from)));
        }
    }
    const VF mean = div(sum, total);
    const VF off = hn::Sub(pastLuminanceLanes(job, part, at), mean);
    return hn::Max(hn::Mul(set(kOutlier), hn::Mul(off, off)),
                   hn::Sub(div(squares, total), hn::Mul(mean, mean)));
}

HWY_ATTR void varianceTile(const Job& job, const TileRect& tile) noexcept {
    const DF d;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; x += laneCount()) {
            const ptrdiff_t at = y * job.stride + x;
            const MF surface =
                hn::And(hn::RebindMask(d, hn::Ne(loadInt(job.now.surface + at), setInt(0))),
                        lanesWithin(x, 0, job.width));
            for (int p = 0; p < kParts; ++p) {
                const VF count = hn::IfThenElse(surface, loadByte(job.now.count[p] + at), set(255));
                const VF mean = pastLuminanceLanes(job, p, at);
                const VF own = hn::Max(hn::Zero(d),
                                       hn::Sub(load(job.now.square[p] + at), hn::Mul(mean, mean)));
                VF variance = div(own, hn::Max(hn::Sub(count, set(1.0f)), set(1.0f)));
                const MF fresh = hn::Lt(count, set(float(kShort)));
                if (any(fresh)) {
                    const VF around = div(variedAroundLanes(job, p, x, y), count);
                    variance = hn::IfThenElse(fresh, around, variance);
                }
                store(hn::IfThenElseZero(surface, variance), job.first.variance[p] + at);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::denoising
HWY_AFTER_NAMESPACE();
