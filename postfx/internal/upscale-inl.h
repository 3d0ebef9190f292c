// The upscaler's gather in lanes of 16 bits; upscale_reference.cpp is the truth and names the
// steps. Windows and ways are the frame's pixels', in lanes as the gather has them, a row ahead of
// their samples; output pixels take them over and look at samples of their own. Included once per
// target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// Where a layer of each of a row's pixels was in a frame; rows of −32768: it was not followed.
struct StopRow {
    PixelRow column, row;
    PixelRow x_fx8, y_fx8;        ///< beyond it, less the offset of the samples there
    PixelRow motion[2];           ///< into the frame
    PixelRow jitter_x, jitter_y;  ///< only where tiles lie otherwise
};
constexpr int kNotFollowed = -32768;

/// A row of the frame's pixels in a tile.
struct LookedAt {
    PixelRow surface, depth, step, tolerance, normal, moved, layered, apart, slide;
    PixelRow far_surface, far_depth, far_step;
    bool any_moved, any_layered, any_apart;
    StopRow own[kMaxUpscaleRing], far[upscale::kFarFrames];
    /// Frames, and of the farther layer, of each group of pixels.
    int frames[kTileSize / kBlockLanes], far_frames[kTileSize / kBlockLanes];
};

HWY_INLINE void storeStop(const Job& job, const SlotIn& slot, const WayStop& stop, int i,
                          StopRow& row) {
    const JitterLanes jitter = jitterAt(job, slot, stop.place.column, stop.place.row, stop.alive);
    row.column.store(i, stop.place.column);
    row.row.store(i, hn::IfThenElse(stop.alive, stop.place.row, set(kNotFollowed)));
    row.x_fx8.store(i, hn::Sub(stop.place.x_fx8, jitter.x_fx8));
    row.y_fx8.store(i, hn::Sub(stop.place.y_fx8, jitter.y_fx8));
    row.motion[0].store(i, stop.motion[0]);
    row.motion[1].store(i, stop.motion[1]);
    if (slot.tile_jitter != nullptr) {
        row.jitter_x.store(i, jitter.x_fx8);
        row.jitter_y.store(i, jitter.y_fx8);
    }
}

HWY_INLINE void stepLimited(const Job& job, int k, int frames, const LayerLanes& layer, VS limit,
                            Walker& walker, WayOf<kMaxUpscaleRing>& way) {
    walker.alive = hn::And(walker.alive, hn::Gt(limit, set(k)));
    stepWay(job, k, k + 1 == frames, layer, set(32767), walker, way);
}

/// Frames from `begin` on in which no lane of a group is followed.
HWY_INLINE void endWay(StopRow* stops, int begin, int end, int i) {
    for (int k = begin; k < end; ++k) {
        stops[k].row.store(i, set(kNotFollowed));
    }
}

/// A group of the frame's pixels while it is looked at.
struct PixelGroup {
    WindowLanes window;
    Walker walker;
    WayOf<kMaxUpscaleRing> way;
};

/// The farther layers' ways of a group.
HWY_NOINLINE void lookFar(const Job& job, int x, int y, int i, int g, PixelGroup& group,
                          LookedAt& row) {
    const WindowLanes& w = group.window;
    const int frames = std::min(upscale::kFarFrames, job.frames);
    group.walker.start(x, y, w.far, w.apart);
    group.way.frames = 0;
    for (int k = 0; k < frames; ++k) {
        stepLimited(job, k, frames, w.far, w.frames, group.walker, group.way);
    }
    row.far_frames[g] = group.way.frames;
    for (int k = 0; k < group.way.frames; ++k) {
        storeStop(job, job.slot[k], group.way.stop[k], i, row.far[k]);
    }
}

/// Windows and ways of a row of a tile.
HWY_NOINLINE void lookAlongFrame(const Job& job, const TileRect& tile, int y, LookedAt& row) {
    const int count = (tile.x1 - tile.x0 + kHalves - 1) / kHalves;
    PixelGroup groups[kTileSize / kHalves];
    row.any_moved = row.any_layered = row.any_apart = false;
    prefetchWindows(job, tile, y);
    for (int g = 0; g < count; ++g) {
        const int x = tile.x0 + g * kHalves, i = g * kHalves;
        PixelGroup& group = groups[g];
        WindowLanes& w = group.window;
        const MS pixels = lanesUnder(tile.x1 - x);
        windowOf(job, x, y, pixels, w,
                 {kMaxUpscaleRing, upscale::kCalmFrames, upscale::kFlatFrames});
        row.surface.store(i, w.owner.surface);
        row.depth.store(i, w.owner.depth);
        row.step.store(i, w.owner.step);
        row.tolerance.store(i, w.owner.tolerance);
        row.normal.store(i, w.normal);
        const DS d;
        row.moved.store(i, hn::VecFromMask(d, w.moved));
        row.layered.store(i, hn::VecFromMask(d, w.layered));
        row.apart.store(i, hn::VecFromMask(d, w.apart));
        row.slide.store(i, w.slide);
        row.far_surface.store(i, w.far.surface);
        row.far_depth.store(i, w.far.depth);
        row.far_step.store(i, w.far.step);
        row.any_moved |= w.any_moved;
        row.any_layered |= w.any_layered;
        row.any_apart |= w.any_apart;
        group.walker.start(x, y, w.owner, pixels);
        group.way.frames = 0;
    }
    // Each step of a way waits for the one before: all groups of the row wait at once.
    for (int k = 0; k < job.frames; ++k) {
        for (int g = 0; g < count; ++g) {
            PixelGroup& group = groups[g];
            stepLimited(job, k, job.frames, group.window.owner, group.window.frames, group.walker,
                        group.way);
        }
    }
    int most = 0, most_far = 0;
    for (int g = 0; g < count; ++g) {
        const int x = tile.x0 + g * kHalves, i = g * kHalves;
        PixelGroup& group = groups[g];
        row.frames[g] = group.way.frames;
        for (int k = 0; k < group.way.frames; ++k) {
            storeStop(job, job.slot[k], group.way.stop[k], i, row.own[k]);
            if (k > 0) {
                prefetchStop(job, job.slot[k], group.way.stop[k].place, g + 1 == count);
            }
        }
        row.far_frames[g] = 0;
        if (group.window.any_apart) {
            lookFar(job, x, y, i, g, group, row);
        }
        most = std::max(most, row.frames[g]);
        most_far = std::max(most_far, row.far_frames[g]);
    }
    for (int g = 0; g < count; ++g) {
        endWay(row.own, row.frames[g], most, g * kHalves);
        endWay(row.far, row.far_frames[g], most_far, g * kHalves);
    }
}

/// The samples that count for a group of output pixels.
struct OutputTaps {
    static constexpr int kMost = kMaxUpscaleRing + 4;
    VS weight[kMost], ex[kMost], ey[kMost], behind[kMost];
    VS colour[3][kMost];
    int count = 0;

    HWY_INLINE void add(VS w, VS x, VS y, VS back, const SlotIn& slot, const Samples& samples) {
        weight[count] = w;
        ex[count] = x;
        ey[count] = y;
        behind[count] = back;
        for (int c = 0; c < 3; ++c) {
            colour[c][count] = samples.of(slot.colour[c]);
        }
        ++count;
    }
};

HWY_INLINE VS toImage(VS distance_fx8, int ratio_fx8) {
    return hn::MulHigh(hn::ShiftLeft<6>(distance_fx8), set(4 * ratio_fx8));
}
HWY_INLINE VS axisKernels(VS e_fx8) {
    const VS scaled = hn::Add(hn::Mul(hn::Sub(set(205), hn::Abs(e_fx8)), set(53)), set(256));
    return hn::Min(hn::Max(hn::ShiftRight<9>(scaled), zero()), set(kAxisWeight));
}
HWY_INLINE VS placesOf(VS e_fx8) {
    const VS place = hn::ShiftRight<2>(e_fx8);
    return hn::Max(hn::Min(place, set(upscale::kFarthest)), set(-upscale::kFarthest));
}

/// What the group's pixels look at.
struct OutputWindow {
    const OutputGroup& group;
    const LookedAt& row;
    LayerLanes own, far;
    VS normal, slide;
    MS pixels, moved, layered, apart;
    bool any_moved = false, any_apart = false;
    int offset_y;
    VS offset_x;

    HWY_INLINE OutputWindow(const OutputGroup& g, const LookedAt& r, MS asked, int y_fx8)
        : group(g), row(r), pixels(asked), offset_y(y_fx8) {
        own = {g.spread(r.surface),
               g.spread(r.depth),
               g.spread(r.step),
               g.spread(r.tolerance),
               {zero(), zero()}};
        far = {zero(), zero(), zero(), set(kDepthTolerance), {zero(), zero()}};
        offset_x = hn::LoadU(DS(), g.columns.offset + g.i);
        normal = slide = zero();
        moved = layered = apart = never();
        if (r.any_moved) {
            moved = g.spreadMask(r.moved);
            normal = g.spread(r.normal);
            any_moved = any(moved);
        }
        if (r.any_layered) {
            layered = g.spreadMask(r.layered);
            far.surface = g.spread(r.far_surface);
            far.depth = g.spread(r.far_depth);
            far.step = g.spread(r.far_step);
        }
        if (r.any_apart) {
            slide = g.spread(r.slide);
            apart = g.spreadMask(r.apart);
            any_apart = any(hn::And(apart, pixels));
        }
    }
    int frames(const int* of_groups) const {
        int most = 0;
        const int last = group.lastPixel() / kHalves;
        for (int g = group.firstPixel() / kHalves; g <= last; ++g) {
            most = std::max(most, of_groups[g]);
        }
        return most;
    }
};

/// Where the ways of a group's pixels come to in a frame.
struct Spot {
    VS column, row, x_fx8, y_fx8;
    MS alive;
};
HWY_INLINE Spot spotOf(const OutputWindow& w, const StopRow& stop) {
    Spot spot;
    spot.column = w.group.spread(stop.column);
    spot.row = w.group.spread(stop.row);
    spot.x_fx8 = hn::Add(w.group.spread(stop.x_fx8), w.offset_x);
    spot.y_fx8 = hn::Add(w.group.spread(stop.y_fx8), set(w.offset_y));
    spot.alive = hn::And(w.pixels, hn::Ne(spot.row, set(kNotFollowed)));
    return spot;
}

/// Lanes whose samples are in the picture and lie as those of the place's tile do.
HWY_INLINE MS usable(const Job& job, const SlotIn& slot, const OutputWindow& w, const StopRow& stop,
                     VS column, VS row, MS alive) {
    const VS out = hn::Or(beyond(column, job.width - 1), beyond(row, job.height - 1));
    alive = hn::And(alive, hn::Eq(out, zero()));
    if (slot.tile_jitter != nullptr) {
        const JitterLanes there = jitterAt(job, slot, column, row, alive);
        alive = hn::And(alive, hn::Eq(there.x_fx8, w.group.spread(stop.jitter_x)));
        alive = hn::And(alive, hn::Eq(there.y_fx8, w.group.spread(stop.jitter_y)));
    }
    return alive;
}

/// Old samples on the owner's way where not all are the owner's: counts().
HWY_NOINLINE VS sifted(const Job& job, int k, const OutputWindow& w, const Outlook& own,
                       const Outlook& far, const StopRow& stop, const Samples& samples, VS id,
                       VS depth, MS same, VS weight, VS& behind) {
    const SlotIn& slot = job.slot[k];
    const Depths near(w.own, own);
    const MS weighs = hn::Gt(weight, zero());
    const MS farther = hn::AndNot(hn::Or(same, hn::Gt(depth, near.high)), weighs);
    const MS moved = hn::Lt(id, zero());
    const VS surface = surfaces(id);
    const MS easy = hn::Or(same, hn::And(farther, w.layered));
    const MS known = hn::And(w.layered, hn::Eq(surface, w.far.surface));
    const auto drop = [&](MS lanes) { weight = hn::IfThenZeroElse(lanes, weight); };
    drop(hn::AndNot(known, hn::AndNot(w.moved, hn::And(farther, moved))));
    if (w.any_apart) {
        const VU low = unsign(flipTop(far.depth)), high = unsign(flipTop(own.depth));
        const VS quarter = flipTop(sign(hn::AverageRound(low, hn::AverageRound(low, high))));
        const MS lags = hn::Gt(w.slide, set(kMaxLag / k));
        const MS back = hn::And(hn::And(farther, hn::Lt(depth, quarter)), lags);
        behind = hn::VecFromMask(DS(), back);
    }
    const MS hard = hn::And(weighs, hn::Or(hn::Not(easy), hn::And(w.moved, moved)));
    if (any(hard)) {
        const VS other[2] = {samples.of(slot.motion[0]), samples.of(slot.motion[1])};
        const VS motion[2] = {w.group.spread(stop.motion[0]), w.group.spread(stop.motion[1])};
        MS off = hn::Or(hn::Eq(other[0], set(kNoHistory)),
                        hn::Gt(slideOf(other, motion), set(kMaxSlide / k)));
        if (job.start_age != nullptr) {
            off = hn::Or(off, olderThan(job.start_age, k, surface));
        }
        drop(hn::And(hard, off));
    }
    if (w.any_moved) {
        const MS lit = hn::And(hn::AndNot(hn::Eq(w.normal, zero()), w.moved), same);
        if (any(hn::And(lit, hn::Gt(weight, zero())))) {
            const Normals then(samples.of(slot.normal)), now(w.normal);
            drop(hn::AndNot(litAlike(then, now), lit));
        }
    }
    return weight;
}

/// The four samples of this frame around the pixels: all of the owner's way, of the farther
/// layer's those that show it.
template <class Keep>
HWY_INLINE void takeFresh(const upscale::Job& job, const OutputWindow& w, const StopRow& stop,
                          OutputTaps& taps, const Keep& keep) {
    const Job& frame = job.frame;
    const SlotIn& slot = frame.slot[0];
    const Spot spot = spotOf(w, stop);
    const VS x0 = hn::Add(spot.column, hn::ShiftRight<8>(spot.x_fx8));
    const VS y0 = hn::Add(spot.row, hn::ShiftRight<8>(spot.y_fx8));
    const VS fx = hn::And(spot.x_fx8, set(255)), fy = hn::And(spot.y_fx8, set(255));
    for (int t = 0; t < 4; ++t) {
        const VS dx = hn::Sub(set((t & 1) * 256), fx), dy = hn::Sub(set((t >> 1) * 256), fy);
        const VS column = hn::Add(x0, set(t & 1)), row = hn::Add(y0, set(t >> 1));
        const VS ex = toImage(dx, job.x.ratio_fx8), ey = toImage(dy, job.y.ratio_fx8);
        const VS side_x = hn::Sub(set(256), hn::Abs(dx)), side_y = hn::Sub(set(256), hn::Abs(dy));
        const VS tent = hn::MulHigh(hn::ShiftLeft<3>(side_x), hn::ShiftLeft<2>(side_y));
        VS weight = hn::Add(hn::ShiftRight<1>(hn::Mul(axisKernels(ex), axisKernels(ey))), tent);
        const MS alive = usable(frame, slot, w, stop, column, row, spot.alive);
        weight = hn::IfThenElseZero(alive, weight);
        const Samples samples(column, row, alive, frame.width, frame.height, frame.stride);
        weight = keep(samples, weight);
        taps.add(weight, placesOf(ex), placesOf(ey), zero(), slot, samples);
    }
}

/// The nearest sample of an old frame, which `keep` judges.
template <class Keep>
HWY_INLINE void takeNearest(const upscale::Job& job, int k, const OutputWindow& w,
                            const StopRow& stop, OutputTaps& taps, const Keep& keep) {
    const Job& frame = job.frame;
    const SlotIn& slot = frame.slot[k];
    const Spot spot = spotOf(w, stop);
    const VS middle = set(128);
    const VS x = hn::Add(spot.x_fx8, middle), y = hn::Add(spot.y_fx8, middle);
    const VS column = hn::Add(spot.column, hn::ShiftRight<8>(x));
    const VS row = hn::Add(spot.row, hn::ShiftRight<8>(y));
    const MS alive = usable(frame, slot, w, stop, column, row, spot.alive);
    if (!any(alive)) {
        return;
    }
    const VS ex = toImage(hn::Sub(middle, hn::And(x, set(255))), job.x.ratio_fx8);
    const VS ey = toImage(hn::Sub(middle, hn::And(y, set(255))), job.y.ratio_fx8);
    VS weight = hn::Add(hn::ShiftRight<1>(hn::Mul(axisKernels(ex), axisKernels(ey))),
                        set(upscale::kFarWeight));
    weight = hn::IfThenElseZero(alive, weight);
    const Samples samples(column, row, alive, frame.width, frame.height, frame.stride);
    VS behind = zero();
    const VS id = samples.of(slot.id);
    weight = keep(samples, id, weight, behind);
    if (frame.change_age != nullptr) {
        weight = hn::IfThenZeroElse(olderThan(frame.change_age, k, surfaces(id)), weight);
    }
    taps.add(weight, placesOf(ex), placesOf(ey), behind, slot, samples);
}

/// Samples along the owners' ways.
HWY_NOINLINE void collectOwn(const upscale::Job& job, const OutputWindow& w, OutputTaps& taps) {
    const Job& frame = job.frame;
    const int frames = w.frames(w.row.frames);
    taps.count = 0;
    takeFresh(job, w, w.row.own[0], taps, [](const Samples&, VS weight) { return weight; });
    Outlook own, far;
    own.start(w.own);
    far.start(w.far);
    for (int k = 1; k < frames; ++k) {
        own.next(w.own);
        far.next(w.far);
        const StopRow& stop = w.row.own[k];
        takeNearest(
            job, k, w, stop, taps, [&](const Samples& samples, VS id, VS weight, VS& behind) {
                const VS depth = samples.of(frame.slot[k].depth);
                const MS same =
                    hn::And(hn::Eq(surfaces(id), w.own.surface), Depths(w.own, own).within(depth));
                const MS others = hn::AndNot(same, hn::Gt(weight, zero()));
                if (!w.any_moved && !any(others)) {
                    return weight;
                }
                return sifted(frame, k, w, own, far, stop, samples, id, depth, same, weight,
                              behind);
            });
    }
}

/// Samples of the farther layers, where the owners did not hide them.
HWY_NOINLINE void collectFar(const upscale::Job& job, const OutputWindow& w, OutputTaps& taps) {
    const Job& frame = job.frame;
    const int frames = w.frames(w.row.far_frames);
    taps.count = 0;
    Outlook own, far;
    own.start(w.own);
    far.start(w.far);
    const auto judge = [&](VS id, VS depth, VS weight) {
        const Depths near(w.own, own);
        const MS same = hn::And(hn::Eq(surfaces(id), w.own.surface), near.within(depth));
        const MS nearer = hn::Or(hn::Gt(depth, near.high), hn::Gt(depth, Depths(w.far, far).high));
        return hn::IfThenZeroElse(hn::Or(same, nearer), weight);
    };
    for (int k = 0; k < frames; ++k) {
        const SlotIn& slot = frame.slot[k];
        if (k == 0) {
            takeFresh(job, w, w.row.far[0], taps, [&](const Samples& samples, VS weight) {
                return judge(samples.of(slot.id), samples.of(slot.depth), weight);
            });
            continue;
        }
        own.next(w.own);
        far.next(w.far);
        takeNearest(job, k, w, w.row.far[k], taps,
                    [&](const Samples& samples, VS id, VS weight, VS&) {
                        return judge(id, samples.of(slot.depth), weight);
                    });
    }
}

HWY_NOINLINE void tiltOutput(const OutputTaps& taps, VS& weight, VS& tilt_x, VS& tilt_y) {
    const DS d;
    const VS none = zero(), one = set(1);
    Wide x, y, xx, xy, yy;
    for (Wide* wide : {&x, &y, &xx, &xy, &yy}) {
        wide->clear();
    }
    weight = none;
    for (int i = 0; i < taps.count; i += 2) {
        const bool two = i + 1 < taps.count;
        const VS w0 = taps.weight[i], w1 = two ? taps.weight[i + 1] : none;
        const VS x0 = taps.ex[i], x1 = two ? taps.ex[i + 1] : none;
        const VS y0 = taps.ey[i], y1 = two ? taps.ey[i + 1] : none;
        const VS wx0 = hn::Mul(w0, x0), wx1 = hn::Mul(w1, x1);
        const VS wy0 = hn::Mul(w0, y0), wy1 = hn::Mul(w1, y1);
        weight = hn::Add(weight, hn::Add(w0, w1));
        x.add(wx0, wx1, one, one);
        y.add(wy0, wy1, one, one);
        xx.add(wx0, wx1, x0, x1);
        xy.add(wx0, wx1, y0, y1);
        yy.add(wy0, wy1, y0, y1);
    }
    const DW dw;
    VW x_lower, y_lower, x_upper, y_upper;
    tiltOf({hn::BitCast(dw, hn::InterleaveLower(d, weight, none)), x.lower, y.lower, xx.lower,
            xy.lower, yy.lower},
           x_lower, y_lower);
    tiltOf({hn::BitCast(dw, hn::InterleaveUpper(d, weight, none)), x.upper, y.upper, xx.upper,
            xy.upper, yy.upper},
           x_upper, y_upper);
    tilt_x = narrow(x_lower, x_upper);
    tilt_y = narrow(y_lower, y_upper);
    for (int i = 0; i < 6; ++i) {
        const MS steep = hn::Gt(hn::Add(hn::Abs(tilt_x), hn::Abs(tilt_y)), set(kMaxTilt));
        if (!any(steep)) {
            return;
        }
        tilt_x = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_x), tilt_x);
        tilt_y = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_y), tilt_y);
    }
}

/// fit(): `colour` stays where the result is false. `behind` replaces what shows the layer behind.
HWY_NOINLINE MS fitOutput(const OutputTaps& taps, const Colour* behind, MS separate, VS& weight,
                          Colour& colour) {
    const DS d;
    VS tilt_x, tilt_y;
    tiltOutput(taps, weight, tilt_x, tilt_y);
    Wide sums[3];
    for (Wide& sum : sums) {
        sum.clear();
    }
    VS total = zero(), replaced = zero();
    VS last = zero();
    for (int i = 0; i < taps.count; ++i) {
        const VS lift = hn::Neg(hn::Add(hn::Mul(tilt_x, taps.ex[i]), hn::Mul(tilt_y, taps.ey[i])));
        const VS w = taps.weight[i];
        VS tilted = hn::Max(hn::Add(w, hn::MulFixedPoint15(hn::Add(w, w), lift)), zero());
        total = hn::Add(total, tilted);
        if (behind != nullptr) {
            const MS back = hn::And(separate, hn::MaskFromVec(taps.behind[i]));
            replaced = hn::Add(replaced, hn::IfThenElseZero(back, tilted));
            tilted = hn::IfThenZeroElse(back, tilted);
        }
        if ((i & 1) == 0 && i + 1 < taps.count) {
            last = tilted;
            continue;
        }
        const VS first = (i & 1) == 0 ? zero() : last;
        const int before = (i & 1) == 0 ? i : i - 1;
        for (int c = 0; c < 3; ++c) {
            sums[c].add(first, tilted, taps.colour[c][before], taps.colour[c][i]);
        }
    }
    const MS fits = hn::And(hn::Gt(weight, set(1)), hn::Gt(total, set(1)));
    const DWU dwu;
    const auto lower = [&](VS v) { return hn::BitCast(dwu, hn::InterleaveLower(d, v, zero())); };
    const auto upper = [&](VS v) { return hn::BitCast(dwu, hn::InterleaveUpper(d, v, zero())); };
    const VWU totals[2] = {lower(total), upper(total)};
    const VWU replaceds[2] = {lower(replaced), upper(replaced)};
    for (int c = 0; c < 3; ++c) {
        VW mean[2];
        for (int p = 0; p < 2; ++p) {
            const VWU reciprocal =
                hn::GatherIndex(dwu, kReciprocals.data(), hn::BitCast(DW(), totals[p]));
            VWU sum = hn::BitCast(dwu, p == 0 ? sums[c].lower : sums[c].upper);
            sum = hn::Add(sum, hn::ShiftRight<1>(totals[p]));
            sum = hn::Add(sum, hn::ShiftLeft<15>(hn::Sub(totals[p], replaceds[p])));
            if (behind != nullptr) {
                const VS b = sign(behind->of[c]);
                sum = hn::Add(sum, hn::Mul(replaceds[p], p == 0 ? lower(b) : upper(b)));
            }
            mean[p] =
                hn::Sub(hn::BitCast(DW(), highProduct(sum, reciprocal)), hn::Set(DW(), kOffset));
        }
        const VS both = flipTop(narrow(mean[0], mean[1]));
        colour.of[c] = unsign(hn::IfThenElse(fits, both, sign(colour.of[c])));
    }
    return fits;
}

/// Writes the first `count` of the group's pixels, those of `pixels`.
HWY_INLINE void showOutput(const upscale::Job& job, ptrdiff_t at, int count, MS pixels,
                           const Colour& colour, VS weight) {
    const DU d;
    const hn::Rebind<uint8_t, DS> d8;
    alignas(64) uint16_t values[3][kHalves];
    alignas(64) uint8_t counts[kHalves];
    alignas(64) int16_t wanted[kHalves];
    VS samples = hn::ShiftRight<7>(hn::Add(weight, set(64)));
    samples = hn::Min(hn::Max(samples, set(1)), set(255));
    if (count >= kHalves && hn::AllTrue(DS(), pixels)) {
        for (int c = 0; c < 3; ++c) {
            hn::StoreU(colour.of[c], d, job.shown[c] + at);
        }
        hn::StoreU(hn::DemoteTo(d8, samples), d8, job.shown_count + at);
        return;
    }
    for (int c = 0; c < 3; ++c) {
        hn::Store(colour.of[c], d, values[c]);
    }
    hn::Store(hn::DemoteTo(d8, samples), d8, counts);
    hn::Store(hn::VecFromMask(DS(), pixels), DS(), wanted);
    for (int i = 0; i < std::min(count, kHalves); ++i) {
        if (wanted[i] != 0) {
            for (int c = 0; c < 3; ++c) {
                job.shown[c][at + i] = values[c][i];
            }
            job.shown_count[at + i] = counts[i];
        }
    }
}

/// Lanes without samples get this frame's nearest one.
HWY_NOINLINE void fillOutput(const upscale::Job& job, int x, int y, int count, MS lanes,
                             Colour& colour) {
    alignas(64) uint16_t values[3][kHalves];
    alignas(64) int16_t wanted[kHalves];
    hn::Store(hn::VecFromMask(DS(), lanes), DS(), wanted);
    for (int c = 0; c < 3; ++c) {
        hn::Store(colour.of[c], DU(), values[c]);
        for (int i = 0; i < std::min(count, kHalves); ++i) {
            if (wanted[i] != 0) {
                values[c][i] = job.frame.now.colour[c][upscale::nearestInFrame(job, x + i, y)];
            }
        }
        colour.of[c] = hn::Load(DU(), values[c]);
    }
}

HWY_INLINE void gatherOutput(const upscale::Job& job, const OutputGroup& group, const LookedAt& row,
                             int y, int offset_y, bool sums_valid) {
    const int x = group.columns.first + group.i, count = group.columns.end - x;
    const ptrdiff_t at = y * job.stride + x;
    MS pixels = lanesUnder(count);
    if (sums_valid) {
        const VU samples = hn::LoadU(DU(), job.sums.count + at);
        pixels = hn::And(pixels, hn::Lt(sign(samples), set(job.settled)));
        if (!any(pixels)) {
            return;
        }
    }
    const OutputWindow window(group, row, pixels, offset_y);
    OutputTaps taps;
    Colour colour{{hn::Zero(DU()), hn::Zero(DU()), hn::Zero(DU())}}, behind = colour;
    MS separate = never();
    VS weight;
    if (window.any_apart) {
        collectFar(job, window, taps);
        separate = hn::And(fitOutput(taps, nullptr, never(), weight, behind), window.apart);
    }
    collectOwn(job, window, taps);
    const MS fits = fitOutput(taps, window.any_apart ? &behind : nullptr, separate, weight, colour);
    const MS bare = hn::AndNot(fits, pixels);
    if (any(bare)) {
        fillOutput(job, x, y, count, bare, colour);
    }
    showOutput(job, at, count, pixels, colour, weight);
}

/// All slots have the frame's size.
HWY_ATTR void upscaleTile(const upscale::Job& job, const TileRect& tile, bool sums_valid) noexcept {
    const TileRect out = upscale::outputRect(job, tile);
    const OutputColumns columns(job, tile.x0, out.x0, out.x1);
    LookedAt rows[2];
    // The next row's samples are on their way while this one's pixels are made.
    for (int row = tile.y0 - 1; row < tile.y1; ++row) {
        if (row + 1 < tile.y1) {
            lookAlongFrame(job.frame, tile, row + 1, rows[(row + 1) & 1]);
        }
        if (row < tile.y0) {
            continue;
        }
        for (int y = job.y.firstOf(row); y < job.y.firstOf(row + 1); ++y) {
            const int offset_y = job.y.toFrame(job.y.offsetOf(y, row));
            for (int i = 0; i < out.x1 - out.x0; i += kHalves) {
                gatherOutput(job, OutputGroup(columns, i), rows[row & 1], y, offset_y, sums_valid);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
