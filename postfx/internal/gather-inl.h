// The gather in lanes, one pixel each; gather_reference.cpp is the truth and names the steps. Two
// passes: the first follows the surfaces back, decides which samples count, and keeps their places
// and weights; the second weighs their colours, once the moments of their places are known.
// Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// Frames to follow at most: in all windows, and in those with little and next to no contrast.
struct FrameLimits {
    int most = kMaxRing, calm = kCalmFrames, flat = kFlatFrames;
};

/// Frames to follow by the windows' contrast alone: see lookAround().
HWY_INLINE VS calmFrames(const Job& job, int x, int y, const FrameLimits& limits) {
    const DS d;
    const ptrdiff_t middle = y * job.stride + x;
    const ptrdiff_t at[3] = {y > 0 ? middle - job.stride : middle, middle,
                             y + 1 < job.height ? middle + job.stride : middle};
    VU loud = hn::Zero(DU()), lively = loud;
    for (int c = 0; c < 3; ++c) {
        const int16_t* plane = job.slot[0].colour[c];
        VS low = load(plane + middle), high = low;
        for (int i = -1; i <= 1; ++i) {
            const VS a = load(plane + at[0] + i), b = load(plane + at[1] + i),
                     e = load(plane + at[2] + i);
            const VS least = hn::Min(hn::Min(a, b), e), most = hn::Max(hn::Max(a, b), e);
            // Columns outside the picture do not count.
            MS out = never();
            if (i < 0 && x == 0) {
                out = hn::Eq(hn::Iota(d, 0), zero());
            } else if (i > 0 && x + kHalves >= job.width) {
                out = hn::Gt(hn::Iota(d, int16_t(x)), set(job.width - 2));
            }
            low = hn::IfThenElse(out, low, hn::Min(low, least));
            high = hn::IfThenElse(out, high, hn::Max(high, most));
        }
        const VU largest = unsign(flipTop(high));
        const VU span = unsign(hn::Sub(high, low));
        const VU four = hn::Set(DU(), 4);
        const auto excess = [&](VU part) { return hn::SaturatedSub(span, hn::Add(part, four)); };
        loud = hn::Or(loud, excess(hn::ShiftRight<kFlatShift>(largest)));
        lively = hn::Or(lively, excess(hn::ShiftRight<kCalmShift>(largest)));
    }
    const MS flat = hn::Eq(sign(loud), zero()), calm = hn::Eq(sign(lively), zero());
    return hn::IfThenElse(flat, set(limits.flat),
                          hn::IfThenElse(calm, set(limits.calm), set(limits.most)));
}

/// The farther layers of the windows where there are two.
HWY_NOINLINE void lookBehind(const Job& job, int x, int y, MS pixels, VS bound, WindowLanes& w) {
    const DS d;
    const Windows windows(job, x, y);
    w.layered = hn::And(pixels, hn::Lt(farthestDepth(windows), bound));
    w.any_layered = any(w.layered);
    if (!w.any_layered) {
        return;
    }
    const Farthest far = farthestOf(windows);
    alignas(64) int16_t from[kHalves], mx[kHalves], my[kHalves], before[kHalves];
    hn::Store(hn::IfThenElse(w.layered, far.which, set(-1)), d, from);
    for (int i = 0; i < kHalves; ++i) {
        mx[i] = my[i] = before[i] = 0;
        if (from[i] >= 0) {
            const ptrdiff_t at = windows.at[from[i] / 3] + i + from[i] % 3 - 1;
            mx[i] = job.now.motion[at].x_fx8;
            my[i] = job.now.motion[at].y_fx8;
            before[i] = lessOffset(job.now.depth_before[at]);
        }
    }
    w.far.surface = surfaces(far.id);
    w.far.depth = far.depth;
    const VS step = hn::SaturatedSub(hn::Load(d, before), far.depth);
    w.far.step = heldSteps(hn::Max(hn::Min(step, set(kMaxStep)), set(-kMaxStep)));
    w.far.tolerance = set(kDepthTolerance);
    w.far.motion[0] = hn::Load(d, mx);
    w.far.motion[1] = hn::Load(d, my);
    w.slide = slideOf(w.owner.motion, w.far.motion);
    const MS unknown = hn::Or(hn::Eq(w.owner.motion[0], set(kNoHistory)),
                              hn::Eq(w.far.motion[0], set(kNoHistory)));
    w.apart = hn::AndNot(unknown, hn::And(w.layered, hn::Gt(w.slide, set(kApart))));
    w.any_apart = any(w.apart);
}

/// lookAround() for a group, whose owners stand in this frame's record.
HWY_NOINLINE void windowOf(const Job& job, int x, int y, MS pixels, WindowLanes& w,
                           const FrameLimits& limits = {}) {
    const DS d;
    const SlotIn& now = job.slot[0];
    const ptrdiff_t at = y * job.stride + x;
    const VS owner = load(now.owner + at), hint = load(job.hint + at);
    const MS inferred = hn::Lt(owner, zero());
    w.owner.surface = surfaces(owner);
    w.owner.depth = load(now.owner_depth + at);
    w.owner.motion[0] = load(now.motion[0] + at);
    w.owner.motion[1] = load(now.motion[1] + at);
    w.owner.step = heldSteps(hn::ShiftRight<1>(hint));
    w.normal = load(now.normal + at);
    w.moved = hn::And(pixels, hn::Ne(hn::And(hint, set(1)), zero()));
    w.any_moved = any(w.moved);
    const VS rise = hn::Min(hn::SaturatedSub(w.owner.depth, load(now.depth + at)), set(kMaxSlope));
    const MS same = hn::Eq(surfaces(load(now.id + at)), w.owner.surface);
    const VS slope = hn::IfThenElseZero(hn::AndNot(inferred, same), rise);
    const VS sloped = hn::Add(hn::Add(slope, slope), slope);
    static_assert(kSlopeFactor == 3);
    w.owner.tolerance = hn::Add(set(kDepthTolerance), sloped);
    w.far = {zero(), zero(), zero(), zero(), {zero(), zero()}};
    w.slide = zero();
    w.apart = never();
    w.any_apart = false;
    lookBehind(job, x, y, pixels,
               hn::SaturatedSub(w.owner.depth, hn::Add(w.owner.tolerance, sloped)), w);
    w.frames = hn::IfThenElse(hn::Or(w.layered, inferred), set(limits.most),
                              calmFrames(job, x, y, limits));
    w.flat = hn::Eq(w.frames, set(limits.flat));
    const VS speed = hn::Max(magnitude(w.owner.motion[0]), magnitude(w.owner.motion[1]));
    w.frames =
        hn::IfThenElse(hn::Gt(speed, set(kFast)), hn::Min(w.frames, set(kFastFrames)), w.frames);
    w.lit_frames = set(limits.most);
    if (job.light_age != nullptr) {
        const hn::Rebind<uint8_t, DS> d8;
        const VS age = hn::PromoteTo(d, hn::LoadU(d8, job.light_age + at));
        w.lit_frames = hn::Add(age, set(1));
        w.frames = hn::Min(w.frames, w.lit_frames);
    }
    if (job.turning != nullptr && any(hn::Or(w.moved, inferred))) {
        const MS turns = hn::Ne(lookUp(job.turning, w.owner.surface), zero());
        w.frames = hn::IfThenElse(hn::And(turns, hn::Or(w.moved, inferred)),
                                  hn::Min(w.frames, set(kTurningFrames)), w.frames);
    }
}

/// Samples of surfaces whose shading has changed since do not count.
HWY_NOINLINE void dropOlder(const uint32_t* ages, int k, const SlotIn& slot,
                            const Clusters& clusters, VS weight[4]) {
    const Four id = fetchFour(slot.id, clusters);
    for (int t = 0; t < 4; ++t) {
        const MS old = olderThan(ages, k, surfaces(id.of[t]));
        weight[t] = hn::IfThenZeroElse(old, weight[t]);
    }
}

/// follow(): the samples along a way.
template <class Rule>
HWY_NOINLINE void collect(const Job& job, int x, int y, const Way& way, const LayerLanes& layer,
                          Rule rule, Kept& kept) {
    kept.clear();
    Outlook outlook;
    outlook.start(layer);
    for (int k = 0; k < way.frames; ++k) {
        const SlotIn& slot = job.slot[k];
        const WayStop& stop = way.stop[k];
        if (k > 0) {
            outlook.next(layer);
            rule.next();
        }
        Site site;
        Kept::Frame& frame = kept.frame[kept.frames];
        const bool now = k == 0 && findSiteNow(job, x, y, stop.alive, site, frame.clusters);
        if (!now && !findSite(job, slot, stop.place, stop.alive, site, frame.clusters)) {
            continue;
        }
        const View view{k, slot, site, frame.clusters, stop, outlook};
        bool part = rule(view, site.weight, frame.behind);
        if (k > 0 && job.change_age != nullptr) {
            dropOlder(job.change_age, k, slot, frame.clusters, site.weight);
            part = true;
        }
        frame.slot = k;
        frame.cx = site.cx;
        frame.cy = site.cy;
        for (int t = 0; t < 4; ++t) {
            frame.weight[t] = site.weight[t];
        }
        ++kept.frames;
        if (part || !site.inner) {
            addPart(site, site.weight, kept.part);
        } else {
            addWhole(site, kept.whole);
        }
        if (k == 0) {
            kept.first_weight = kept.weight();
        }
    }
}

/// mixSpatial() for the few lanes that need it.
HWY_NOINLINE void mixSpatialLanes(const Job& job, int x, int y, VS old_weight, MS lanes,
                                  Colour& colour) {
    const DU d;
    alignas(64) uint16_t rgb[3][kHalves];
    alignas(64) int16_t weight[kHalves];
    for (int c = 0; c < 3; ++c) {
        hn::Store(colour.of[c], d, rgb[c]);
    }
    hn::Store(hn::IfThenElse(lanes, old_weight, set(-1)), DS(), weight);
    for (int i = 0; i < kHalves; ++i) {
        if (weight[i] >= 0) {
            int pixel[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
            mixSpatial(job, x + i, y, weight[i], pixel);
            for (int c = 0; c < 3; ++c) {
                rgb[c][i] = uint16_t(pixel[c]);
            }
        }
    }
    for (int c = 0; c < 3; ++c) {
        colour.of[c] = hn::Load(d, rgb[c]);
    }
}

/// A group of pixels of a row.
struct Group {
    WindowLanes window;
    Walker walker;
    Way way;    ///< of the window's owner
    MS pixels;  ///< that are asked for
    bool wanted;
};

/// Shows the pixels; others keep what the sums have shown.
HWY_INLINE void show(const Job& job, ptrdiff_t at, MS pixels, bool sums_valid, const Colour& colour,
                     VS weight) {
    const DU d;
    const hn::Rebind<uint8_t, DS> d8;
    VS count = hn::ShiftRight<8>(hn::Add(weight, set(128)));
    Colour shown = colour;
    if (sums_valid) {
        for (int c = 0; c < 3; ++c) {
            const VS old = sign(hn::LoadU(d, job.shown[c] + at));
            shown.of[c] = unsign(hn::IfThenElse(pixels, sign(colour.of[c]), old));
        }
        const VS old = hn::PromoteTo(DS(), hn::LoadU(d8, job.shown_count + at));
        count = hn::IfThenElse(pixels, count, old);
    }
    for (int c = 0; c < 3; ++c) {
        hn::StoreU(shown.of[c], d, job.shown[c] + at);
    }
    hn::StoreU(hn::DemoteTo(d8, count), d8, job.shown_count + at);
}

HWY_INLINE void gatherGroup(const Job& job, int x, int y, bool sums_valid, const Group& group) {
    const ptrdiff_t at = y * job.stride + x;
    const WindowLanes& window = group.window;
    Colour colour;
    for (int c = 0; c < 3; ++c) {
        colour.of[c] = unsign(flipTop(load(job.slot[0].colour[c] + at)));
    }
    Kept kept;
    Colour behind = colour;
    MS separate = never();
    if (window.any_apart) {
        const int frames = std::min(kFarFrames, job.frames);
        Walker walker;
        walker.start(x, y, window.far, window.apart);
        Way way;
        for (int k = 0; k < frames; ++k) {
            stepWay(job, k, k + 1 == frames, window.far, window.lit_frames, walker, way);
        }
        collect(job, x, y, way, window.far, FarRule(window), kept);
        separate = hn::And(fitLanes(job, kept, nullptr, never(), behind), window.apart);
    }
    collect(job, x, y, group.way, window.owner, OwnRule(job, window, x, y), kept);
    fitLanes(job, kept, window.any_apart ? &behind : nullptr, separate, colour);
    const VS weight = kept.weight();
    const VS old_weight = hn::Sub(weight, kept.first_weight);
    const MS lone =
        hn::AndNot(window.flat, hn::And(group.pixels, hn::Lt(old_weight, set(kFrameWeight))));
    if (any(lone)) {
        mixSpatialLanes(job, x, y, old_weight, lone, colour);
    }
    show(job, at, group.pixels, sums_valid, colour, weight);
}

/// A row of a tile.
struct GroupRow {
    Group groups[kTileSize / kHalves];
};

/// Asks for the samples at a stop, or `below_fx8`, and for what the next row's way will read there.
/// A line holds 32 pixels of a plane.
HWY_INLINE void prefetchStop(const Job& job, const SlotIn& slot, const PlaceLanes& place,
                             bool last_group, int below_fx8 = 0) {
    const int y_fx8 = hn::GetLane(place.y_fx8);
    const int upper = hn::GetLane(place.row) + ((y_fx8 - slot.jitter_y_fx8 + below_fx8) >> 8);
    const int nearest = hn::GetLane(place.row) + ((y_fx8 - slot.jitter_y_fx8 + 128) >> 8);
    const int column = hn::GetLane(place.column);
    const ptrdiff_t samples = (upper + 1) * job.stride + column;
    const ptrdiff_t owners = (nearest + 1) * job.stride + column;
    for (int end = 0; end <= (last_group ? kHalves : 0); end += kHalves) {
        for (const int16_t* plane :
             {slot.colour[0], slot.colour[1], slot.colour[2], slot.id, slot.depth}) {
            hwy::Prefetch(plane + samples + end);
        }
        for (const int16_t* plane :
             {slot.owner, slot.owner_depth, slot.motion[0], slot.motion[1]}) {
            hwy::Prefetch(plane + owners + end);
        }
    }
}

/// Asks for what the windows of two rows on will read.
HWY_INLINE void prefetchWindows(const Job& job, const TileRect& tile, int y) {
    const SlotIn& now = job.slot[0];
    const int last = job.height - 1;
    const ptrdiff_t below = std::min(y + kRowsAhead + 1, last) * job.stride + tile.x0;
    const ptrdiff_t here = std::min(y + kRowsAhead, last) * job.stride + tile.x0;
    const int width = tile.x1 - tile.x0;
    for (const int16_t* plane : {now.colour[0], now.colour[1], now.colour[2], now.id, now.depth}) {
        prefetchRow(plane + below, width + 1);
    }
    for (const int16_t* plane : {now.owner, now.owner_depth, now.motion[0], now.motion[1],
                                 now.normal, static_cast<const int16_t*>(job.hint)}) {
        prefetchRow(plane + here, width);
    }
}

/// Windows and ways of a row.
HWY_INLINE void lookAlong(const Job& job, const TileRect& tile, int y, bool sums_valid,
                          GroupRow& row) {
    const hn::Rebind<uint8_t, DS> d8;
    const int count = (tile.x1 - tile.x0 + kHalves - 1) / kHalves;
    prefetchWindows(job, tile, y);
    for (int i = 0; i < count; ++i) {
        const int x = tile.x0 + i * kHalves;
        Group& group = row.groups[i];
        group.pixels = lanesUnder(tile.x1 - x);
        if (sums_valid) {
            const uint8_t* counts = job.sums.count + y * job.stride + x;
            const VS samples = hn::PromoteTo(DS(), hn::LoadU(d8, counts));
            group.pixels = hn::And(group.pixels, hn::Lt(samples, set(job.settled)));
        }
        group.wanted = any(group.pixels);
        group.way.frames = 0;
        if (group.wanted) {
            windowOf(job, x, y, group.pixels, group.window);
            group.walker.start(x, y, group.window.owner, group.pixels);
        }
    }
    // Each step of a way waits for the one before: all groups of the row wait at once.
    for (int k = 0; k < job.frames; ++k) {
        for (int i = 0; i < count; ++i) {
            Group& group = row.groups[i];
            if (group.wanted) {
                stepWay(job, k, k + 1 == job.frames, group.window.owner, group.window.frames,
                        group.walker, group.way);
            }
        }
    }
    for (int i = 0; i < count; ++i) {
        const Way& way = row.groups[i].way;
        for (int k = 1; k < way.frames; ++k) {
            prefetchStop(job, job.slot[k], way.stop[k].place, i + 1 == count);
        }
    }
}

HWY_ATTR void gatherTile(const Job& job, const TileRect& tile, bool sums_valid) noexcept {
    const int count = (tile.x1 - tile.x0 + kHalves - 1) / kHalves;
    GroupRow rows[2];
    // The next row's samples are on their way while this one is made.
    for (int y = tile.y0 - 1; y < tile.y1; ++y) {
        if (y + 1 < tile.y1) {
            lookAlong(job, tile, y + 1, sums_valid, rows[(y + 1) & 1]);
        }
        for (int i = 0; i < count && y >= tile.y0; ++i) {
            const Group& group = rows[y & 1].groups[i];
            if (group.wanted) {
                gatherGroup(job, tile.x0 + i * kHalves, y, sums_valid, group);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
