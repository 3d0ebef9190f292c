// The upscaler's gather in lanes of 16 bits; upscale_reference.cpp is the truth and names the
// steps. Windows and ways are the frame's pixels', in lanes as the gather has them, a row ahead of
// their samples; the output pixels in each of them then look at samples of their own. Included once
// per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// The output pixels of a group of the frame's pixels.
struct OutputBlock {
    const OutputColumns& columns;
    int x, y, i;         ///< the group's first pixel; its number in the tile
    int across, y0, y1;  ///< in each pixel at most; rows
    int offset_y[kMaxUpscale];
    MS wanted[kMaxUpscale][kMaxUpscale];  ///< by row and number in the pixel
};

/// A group of the frame's pixels.
struct PixelGroup {
    WindowLanes window;
    Walker walker;
    WayOf<kMaxUpscaleRing> way;  ///< of the window's owner
};

HWY_INLINE void stepLimited(const Job& job, int k, int frames, const LayerLanes& layer, VS limit,
                            Walker& walker, WayOf<kMaxUpscaleRing>& way) {
    walker.alive = hn::And(walker.alive, hn::Gt(limit, set(k)));
    stepWay(job, k, k + 1 == frames, layer, set(32767), walker, way);
}

/// Windows and ways of a row of a tile.
HWY_NOINLINE void lookAlongFrame(const Job& job, const TileRect& tile, int y, PixelGroup* groups) {
    const int count = (tile.x1 - tile.x0 + kHalves - 1) / kHalves;
    prefetchWindows(job, tile, y);
    for (int g = 0; g < count; ++g) {
        const int x = tile.x0 + g * kHalves;
        const MS pixels = lanesUnder(tile.x1 - x);
        windowOf(job, x, y, pixels, groups[g].window,
                 {kMaxUpscaleRing, upscale::kCalmFrames, upscale::kFlatFrames});
        groups[g].walker.start(x, y, groups[g].window.owner, pixels);
        groups[g].way.frames = 0;
    }
    // Each step of a way waits for the one before: all groups of the row wait at once.
    for (int k = 0; k < job.frames; ++k) {
        for (int g = 0; g < count; ++g) {
            PixelGroup& group = groups[g];
            stepLimited(job, k, job.frames, group.window.owner, group.window.frames, group.walker,
                        group.way);
        }
    }
    for (int g = 0; g < count; ++g) {
        const WayOf<kMaxUpscaleRing>& way = groups[g].way;
        for (int k = 1; k < way.frames; ++k) {
            prefetchStop(job, job.slot[k], way.stop[k].place, g + 1 == count);
        }
    }
}

/// Lanes whose samples are in the picture and lie as those of the place's tile do.
HWY_INLINE MS usable(const Job& job, const SlotIn& slot, const JitterLanes& jitter, VS column,
                     VS row, MS alive) {
    const VS out = hn::Or(beyond(column, job.width - 1), beyond(row, job.height - 1));
    alive = hn::And(alive, hn::Eq(out, zero()));
    if (!jitter.alike && any(alive)) {
        const JitterLanes there = jitterAt(job, slot, column, row, alive);
        alive = hn::And(alive, hn::Eq(there.x_fx8, jitter.x_fx8));
        alive = hn::And(alive, hn::Eq(there.y_fx8, jitter.y_fx8));
    }
    return alive;
}

/// Old samples on the owner's way where not all are the owner's: counts().
HWY_NOINLINE VS sifted(const Job& job, int k, const WindowLanes& w, const Outlook& own,
                       const Outlook& far, const VS motion[2], const Pieces& pieces, VS id,
                       VS depth, MS same, VS weight, VS& behind) {
    const SlotIn& slot = job.slot[k];
    const Depths near(w.owner, own);
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
        const VS other[2] = {pieces.fetch(slot.motion[0]), pieces.fetch(slot.motion[1])};
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
            const Normals then(pieces.fetch(slot.normal)), now(w.normal);
            drop(hn::AndNot(litAlike(then, now), lit));
        }
    }
    return weight;
}

/// Samples along the owners' ways.
struct OwnKeep {
    const Job& job;
    const WindowLanes& window;
    Outlook own, far;

    OwnKeep(const Job& j, const WindowLanes& w) : job(j), window(w) {
        own.start(w.owner);
        far.start(w.far);
    }
    HWY_INLINE void next() {
        own.next(window.owner);
        far.next(window.far);
    }
    HWY_INLINE VS operator()(int k, const WayStop& stop, const Pieces& pieces, VS weight,
                             VS& behind) const {
        if (k == 0) {
            return weight;
        }
        const VS id = pieces.fetch(job.slot[k].id), depth = pieces.fetch(job.slot[k].depth);
        const MS same = hn::And(hn::Eq(surfaces(id), window.owner.surface),
                                Depths(window.owner, own).within(depth));
        if (window.any_moved || any(hn::AndNot(same, hn::Gt(weight, zero())))) {
            weight = sifted(job, k, window, own, far, stop.motion, pieces, id, depth, same, weight,
                            behind);
        }
        if (job.change_age != nullptr) {
            weight = hn::IfThenZeroElse(olderThan(job.change_age, k, surfaces(id)), weight);
        }
        return weight;
    }
};

/// Samples of the farther layers, where the owners did not hide them.
struct FarKeep {
    const Job& job;
    const WindowLanes& window;
    Outlook own, far;

    FarKeep(const Job& j, const WindowLanes& w) : job(j), window(w) {
        own.start(w.owner);
        far.start(w.far);
    }
    HWY_INLINE void next() {
        own.next(window.owner);
        far.next(window.far);
    }
    HWY_INLINE VS operator()(int k, const WayStop&, const Pieces& pieces, VS weight, VS&) const {
        const VS id = pieces.fetch(job.slot[k].id), depth = pieces.fetch(job.slot[k].depth);
        const Depths near(window.owner, own);
        const MS same = hn::And(hn::Eq(surfaces(id), window.owner.surface), near.within(depth));
        const MS nearer =
            hn::Or(hn::Gt(depth, near.high), hn::Gt(depth, Depths(window.far, far).high));
        weight = hn::IfThenZeroElse(hn::Or(same, nearer), weight);
        if (job.change_age != nullptr && k > 0) {
            weight = hn::IfThenZeroElse(olderThan(job.change_age, k, surfaces(id)), weight);
        }
        return weight;
    }
};

/// A frame's sample at a crossing of two axes.
template <class Keep>
HWY_INLINE void takeSample(const Job& job, int k, const WayStop& stop, const JitterLanes& jitter,
                           const AxisSite& across, const AxisSite& down, MS wanted,
                           const Keep& keep, OutputTaps& taps) {
    const SlotIn& slot = job.slot[k];
    const MS alive = usable(job, slot, jitter, across.number, down.number, wanted);
    if (!any(alive)) {
        return;
    }
    const VS narrow = hn::ShiftRight<1>(hn::Mul(across.kernel, down.kernel));
    const VS wide = k == 0 ? hn::MulHigh(hn::ShiftLeft<3>(across.tent), hn::ShiftLeft<2>(down.tent))
                           : set(upscale::kFarWeight);
    VS weight = hn::IfThenElseZero(alive, hn::Add(narrow, wide));
    const Pieces pieces(across.number, down.number, alive, job.stride);
    VS behind = zero();
    weight = keep(k, stop, pieces, weight, behind);
    taps.add(weight, across.place, down.place, behind, slot, pieces);
}

/// visitSamples() for all output pixels of a block.
template <class Keep>
HWY_NOINLINE void collectOutput(const upscale::Job& job, const OutputBlock& block,
                                const WayOf<kMaxUpscaleRing>& way, Keep keep, OutputTaps* taps) {
    const Job& frame = job.frame;
    const int rows = block.y1 - block.y0;
    for (int t = 0; t < rows * kMaxUpscale; ++t) {
        taps[t].count = 0;
    }
    for (int k = 0; k < way.frames; ++k) {
        const WayStop& stop = way.stop[k];
        const JitterLanes jitter =
            jitterAt(frame, frame.slot[k], stop.place.column, stop.place.row, stop.alive);
        const VS x = hn::Sub(stop.place.x_fx8, jitter.x_fx8);
        const VS y = hn::Sub(stop.place.y_fx8, jitter.y_fx8);
        const int each = k == 0 ? 2 : 1;
        AxisSite across[kMaxUpscale * 2], down[kMaxUpscale * 2];
        for (int p = 0; p < block.across; ++p) {
            const VS part = hn::Add(x, load(block.columns.offset[p] + block.i));
            if (k > 0) {
                across[p] = nearestSite(stop.place.column, part, job.x.ratio_fx8);
            } else {
                across[2 * p] = besideSite(stop.place.column, part, 0, job.x.ratio_fx8);
                across[2 * p + 1] = besideSite(stop.place.column, part, 1, job.x.ratio_fx8);
            }
        }
        for (int r = 0; r < rows; ++r) {
            const VS part = hn::Add(y, set(block.offset_y[r]));
            if (k > 0) {
                down[r] = nearestSite(stop.place.row, part, job.y.ratio_fx8);
            } else {
                down[2 * r] = besideSite(stop.place.row, part, 0, job.y.ratio_fx8);
                down[2 * r + 1] = besideSite(stop.place.row, part, 1, job.y.ratio_fx8);
            }
        }
        for (int r = 0; r < rows; ++r) {
            for (int p = 0; p < block.across; ++p) {
                const MS wanted = hn::And(block.wanted[r][p], stop.alive);
                for (int t = 0; t < each * each; ++t) {
                    takeSample(frame, k, stop, jitter, across[each * p + t % each],
                               down[each * r + t / each], wanted, keep, taps[r * kMaxUpscale + p]);
                }
            }
        }
        keep.next();
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

/// An output pixel of each lane.
struct Shown {
    Colour colour;
    VS count;
};

/// Writes a row of a block.
HWY_INLINE void showOutput(const upscale::Job& job, const OutputBlock& block, int row,
                           const Shown* shown) {
    alignas(64) uint16_t values[kMaxUpscale][3][kHalves];
    alignas(64) int16_t counts[kMaxUpscale][kHalves], wanted[kMaxUpscale][kHalves];
    for (int p = 0; p < block.across; ++p) {
        for (int c = 0; c < 3; ++c) {
            hn::Store(shown[p].colour.of[c], DU(), values[p][c]);
        }
        hn::Store(shown[p].count, DS(), counts[p]);
        hn::Store(hn::VecFromMask(DS(), block.wanted[row][p]), DS(), wanted[p]);
    }
    const ptrdiff_t start = (block.y0 + row) * job.stride;
    for (int i = 0; i < kHalves; ++i) {
        const ptrdiff_t at = start + block.columns.first[block.i + i];
        for (int p = 0; p < block.across; ++p) {
            if (wanted[p][i] != 0) {
                for (int c = 0; c < 3; ++c) {
                    job.shown[c][at + p] = values[p][c][i];
                }
                job.shown_count[at + p] = uint8_t(counts[p][i]);
            }
        }
    }
}

/// Which output pixels are asked for; whether any is.
HWY_INLINE bool ask(const upscale::Job& job, int row, bool sums_valid, OutputBlock& block) {
    block.y = row;
    block.y0 = job.y.firstOf(row);
    block.y1 = job.y.firstOf(row + 1);
    MS all = never();
    for (int y = block.y0; y < block.y1; ++y) {
        const int r = y - block.y0;
        block.offset_y[r] = job.y.toFrame(job.y.offsetOf(y, row));
        for (int p = 0; p < block.across; ++p) {
            MS wanted = hn::Ne(load(block.columns.used[p] + block.i), zero());
            if (sums_valid) {
                alignas(64) int16_t counts[kHalves];
                for (int i = 0; i < kHalves; ++i) {
                    const int x = block.columns.first[block.i + i] + p;
                    counts[i] = int16_t(std::min<int>(job.sums.count[y * job.stride + x], 32767));
                }
                wanted = hn::And(wanted, hn::Lt(hn::Load(DS(), counts), set(job.settled)));
            }
            block.wanted[r][p] = wanted;
            all = hn::Or(all, wanted);
        }
    }
    return any(all);
}

HWY_NOINLINE void gatherBlock(const upscale::Job& job, const OutputBlock& block,
                              const PixelGroup& group) {
    const WindowLanes& window = group.window;
    const int rows = block.y1 - block.y0;
    const ptrdiff_t at = block.y * job.frame.stride + block.x;
    Shown shown[kMaxUpscale * kMaxUpscale];
    Colour behind[kMaxUpscale * kMaxUpscale];
    MS separate[kMaxUpscale * kMaxUpscale];
    OutputTaps taps[kMaxUpscale * kMaxUpscale];
    Colour own;
    for (int c = 0; c < 3; ++c) {
        own.of[c] = unsign(flipTop(load(job.frame.slot[0].colour[c] + at)));
    }
    if (window.any_apart) {
        const int frames = std::min(upscale::kFarFrames, job.frame.frames);
        Walker walker;
        walker.start(block.x, block.y, window.far, window.apart);
        WayOf<kMaxUpscaleRing> way;
        for (int k = 0; k < frames; ++k) {
            stepLimited(job.frame, k, frames, window.far, window.frames, walker, way);
        }
        collectOutput(job, block, way, FarKeep(job.frame, window), taps);
        for (int t = 0; t < rows * kMaxUpscale; ++t) {
            if (t % kMaxUpscale < block.across) {
                VS weight;
                behind[t] = own;
                separate[t] =
                    hn::And(fitOutput(taps[t], nullptr, never(), weight, behind[t]), window.apart);
            }
        }
    }
    collectOutput(job, block, group.way, OwnKeep(job.frame, window), taps);
    for (int r = 0; r < rows; ++r) {
        for (int p = 0; p < block.across; ++p) {
            const int t = r * kMaxUpscale + p;
            VS weight;
            shown[p].colour = own;
            fitOutput(taps[t], window.any_apart ? &behind[t] : nullptr,
                      window.any_apart ? separate[t] : never(), weight, shown[p].colour);
            const VS count = hn::ShiftRight<7>(hn::Add(weight, set(64)));
            shown[p].count = hn::Min(hn::Max(count, set(1)), set(255));
        }
        showOutput(job, block, r, shown);
    }
}

/// All slots have the frame's size.
HWY_ATTR void upscaleTile(const upscale::Job& job, const TileRect& tile, bool sums_valid) noexcept {
    constexpr int kGroups = kTileSize / kHalves;
    const OutputColumns columns(job, tile);
    const int count = (tile.x1 - tile.x0 + kHalves - 1) / kHalves;
    PixelGroup rows[2][kGroups];
    // The next row's samples are on their way while this one's pixels are made.
    for (int y = tile.y0 - 1; y < tile.y1; ++y) {
        if (y + 1 < tile.y1) {
            lookAlongFrame(job.frame, tile, y + 1, rows[(y + 1) & 1]);
        }
        for (int g = 0; g < count && y >= tile.y0; ++g) {
            OutputBlock block{.columns = columns,
                              .x = tile.x0 + g * kHalves,
                              .y = y,
                              .i = g * kHalves,
                              .across = columns.most};
            if (ask(job, y, sums_valid, block)) {
                gatherBlock(job, block, rows[y & 1][g]);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
