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
    int x, y, i;                     ///< the group's first pixel; its number in the tile
    int across = 0, y0 = 0, y1 = 0;  ///< in each pixel at most; rows
    int offset_y[kMaxUpscale]{};
    MS wanted[kMaxUpscale][kMaxUpscale]{};  ///< by row and number in the pixel
};

/// A group of the frame's pixels.
struct PixelGroup {
    WindowLanes window;
    Walker walker;
    WayOf<kMaxRing> way;  ///< of the window's owner
};

HWY_INLINE void stepLimited(const Job& job, int k, int frames, const LayerLanes& layer, VS limit,
                            Walker& walker, WayOf<kMaxRing>& way) {
    walker.alive = hn::And(walker.alive, hn::Gt(limit, set(k)));
    stepWay(job, k, k + 1 == frames, layer, set(32767), walker, way);
}

/// Windows and ways of a row of a tile.
HWY_NOINLINE void lookAlongFrame(const Job& job, const TileRect& tile, int y, int offset_y,
                                 PixelGroup* groups) {
    const int count = (tile.x1 - tile.x0 + kHalves - 1) / kHalves;
    prefetchWindows(job, tile, y);
    for (int g = 0; g < count; ++g) {
        const int x = tile.x0 + g * kHalves;
        const MS pixels = lanesUnder(tile.x1 - x);
        windowOf(job, x, y, pixels, groups[g].window,
                 {kMaxRing, upscale::kCalmFrames, upscale::kFlatFrames});
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
        const WayOf<kMaxRing>& way = groups[g].way;
        for (int k = 1; k < way.frames; ++k) {
            prefetchStop(job, job.slot[k], way.stop[k].place, g + 1 == count, offset_y + 128);
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

/// Old samples on the owner's way where not all are the owner's: counts(). `keeps`: all ones for
/// those that count so far.
HWY_NOINLINE void sifted(const Job& job, int k, const WindowLanes& w, const Outlook& own,
                         const Outlook& far, const VS motion[2], const Clusters& clusters,
                         const Four& id, const Four& depth, const MS same[4], Four& keeps,
                         Four& behind) {
    const DS d;
    const SlotIn& slot = job.slot[k];
    const Depths near(w.owner, own);
    MS hard[4], any_hard = never();
    for (int t = 0; t < 4; ++t) {
        const MS weighs = hn::MaskFromVec(keeps.of[t]);
        const MS farther = hn::AndNot(hn::Or(same[t], hn::Gt(depth.of[t], near.high)), weighs);
        const MS moved = hn::Lt(id.of[t], zero());
        const MS easy = hn::Or(same[t], hn::And(farther, w.layered));
        const MS known = hn::And(w.layered, hn::Eq(surfaces(id.of[t]), w.far.surface));
        const MS gone = hn::AndNot(known, hn::AndNot(w.moved, hn::And(farther, moved)));
        keeps.of[t] = hn::IfThenZeroElse(gone, keeps.of[t]);
        hard[t] = hn::And(weighs, hn::Or(hn::Not(easy), hn::And(w.moved, moved)));
        any_hard = hn::Or(any_hard, hard[t]);
        if (w.any_apart) {
            const VU low = unsign(flipTop(far.depth)), high = unsign(flipTop(own.depth));
            const VS quarter = flipTop(sign(hn::AverageRound(low, hn::AverageRound(low, high))));
            const MS lags = hn::Gt(w.slide, set(kMaxLag / k));
            behind.of[t] =
                hn::VecFromMask(d, hn::And(hn::And(farther, hn::Lt(depth.of[t], quarter)), lags));
        }
    }
    if (any(any_hard)) {
        const Four other[2] = {fetchFour(slot.motion[0], clusters),
                               fetchFour(slot.motion[1], clusters)};
        for (int t = 0; t < 4; ++t) {
            const VS there[2] = {other[0].of[t], other[1].of[t]};
            MS off = hn::Or(hn::Eq(there[0], set(kNoHistory)),
                            hn::Gt(slideOf(there, motion), set(kMaxSlide / k)));
            if (job.start_age != nullptr) {
                off = hn::Or(off, olderThan(job.start_age, k, surfaces(id.of[t])));
            }
            keeps.of[t] = hn::IfThenZeroElse(hn::And(hard[t], off), keeps.of[t]);
        }
    }
    if (w.any_moved) {
        const MS lit = hn::AndNot(hn::Eq(w.normal, zero()), w.moved);
        const Four then = fetchFour(slot.normal, clusters);
        const Normals now(w.normal);
        for (int t = 0; t < 4; ++t) {
            const MS tested = hn::And(lit, same[t]);
            if (any(tested)) {
                const MS unlike = hn::AndNot(litAlike(Normals(then.of[t]), now), tested);
                keeps.of[t] = hn::IfThenZeroElse(unlike, keeps.of[t]);
            }
        }
    }
}

/// Samples of surfaces whose shading has changed since do not count.
HWY_NOINLINE void dropChanged(const uint32_t* ages, int k, const Four& id, int count, Four& keeps) {
    for (int t = 0; t < count; ++t) {
        keeps.of[t] = hn::IfThenZeroElse(olderThan(ages, k, surfaces(id.of[t])), keeps.of[t]);
    }
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
    HWY_INLINE void operator()(int k, const WayStop& stop, const Clusters& clusters, int count,
                               Four& keeps, Four& behind) const {
        if (k == 0) {
            return;
        }
        const Four id = fetchFour(job.slot[k].id, clusters);
        const Four depth = fetchFour(job.slot[k].depth, clusters);
        const Depths near(window.owner, own);
        MS same[4], others = never();
        for (int t = 0; t < 4; ++t) {
            same[t] =
                hn::And(hn::Eq(surfaces(id.of[t]), window.owner.surface), near.within(depth.of[t]));
            others = hn::Or(others, hn::AndNot(same[t], hn::MaskFromVec(keeps.of[t])));
        }
        if (window.any_moved || any(others)) {
            sifted(job, k, window, own, far, stop.motion, clusters, id, depth, same, keeps, behind);
        }
        if (job.change_age != nullptr) {
            dropChanged(job.change_age, k, id, count, keeps);
        }
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
    HWY_INLINE void operator()(int k, const WayStop&, const Clusters& clusters, int count,
                               Four& keeps, Four&) const {
        const Four id = fetchFour(job.slot[k].id, clusters);
        const Four depth = fetchFour(job.slot[k].depth, clusters);
        const Depths near(window.owner, own);
        const VS high = Depths(window.far, far).high;
        for (int t = 0; t < count; ++t) {
            const MS same =
                hn::And(hn::Eq(surfaces(id.of[t]), window.owner.surface), near.within(depth.of[t]));
            const MS nearer = hn::Or(hn::Gt(depth.of[t], near.high), hn::Gt(depth.of[t], high));
            keeps.of[t] = hn::IfThenZeroElse(hn::Or(same, nearer), keeps.of[t]);
        }
        if (job.change_age != nullptr && k > 0) {
            dropChanged(job.change_age, k, id, count, keeps);
        }
    }
};

/// One of this frame's samples around an output pixel of each lane.
template <class Keep>
HWY_INLINE void takeFresh(const Job& job, const WayStop& stop, const JitterLanes& jitter,
                          const AxisSite& across, const AxisSite& down, MS wanted, const Keep& keep,
                          OutputTaps& taps) {
    const SlotIn& slot = job.slot[0];
    const MS alive = usable(job, slot, jitter, across.number, down.number, wanted);
    if (!any(alive)) {
        return;
    }
    const VS narrow = hn::ShiftRight<1>(hn::Mul(across.kernel, down.kernel));
    const VS tent = hn::MulHigh(hn::ShiftLeft<3>(across.tent), hn::ShiftLeft<2>(down.tent));
    VS weight = hn::IfThenElseZero(alive, hn::Add(narrow, tent));
    Clusters clusters;
    clusters.count = 0;
    forClusters(hn::Sub(across.number, hn::Iota(DS(), 0)), down.number, alive,
                [&](int x, int y, MS some) {
                    const ptrdiff_t at = y * job.stride + x;
                    clusters.of[clusters.count++] = {at, at, some};
                });
    Four keeps{{hn::VecFromMask(DS(), alive), zero(), zero(), zero()}}, behind = keeps;
    keep(0, stop, clusters, 1, keeps, behind);
    const int n = taps.count++;
    taps.weight[n] = hn::And(weight, keeps.of[0]);
    taps.ex[n] = across.place;
    taps.ey[n] = down.place;
    taps.behind[n] = zero();
    for (int c = 0; c < 3; ++c) {
        taps.colour[c][n] = fetchFour(slot.colour[c], clusters).of[0];
    }
}

/// The four samples of an old frame among which the nearest ones of all of a pixel's output pixels
/// are.
struct OldSamples {
    VS column, row;  ///< of the first
    Four keeps, behind, colour[3];
};

/// False when there are none.
template <class Keep>
HWY_INLINE bool fetchOld(const Job& job, int k, const WayStop& stop, const JitterLanes& jitter,
                         const Keep& keep, OldSamples& samples) {
    const DS d;
    const SlotIn& slot = job.slot[k];
    const VS column = samples.column, row = samples.row, one = set(1);
    const VS out =
        hn::Or(beyond(hn::Add(column, one), job.width), beyond(hn::Add(row, one), job.height));
    const MS lanes = hn::And(stop.alive, hn::Eq(out, zero()));
    if (!any(lanes)) {
        return false;
    }
    Clusters clusters;
    clusters.count = 0;
    bool inner = jitter.alike;
    forClusters(hn::Sub(column, hn::Iota(d, 0)), row, lanes, [&](int x0, int y0, MS some) {
        // Rows outside are not memory: others are read in their stead, and weigh nothing.
        const ptrdiff_t upper = y0 < 0 ? 0 : y0;
        const ptrdiff_t lower = y0 + 1 < job.height ? y0 + 1 : y0;
        clusters.of[clusters.count++] = {upper * job.stride + x0, lower * job.stride + x0, some};
        inner &= x0 >= 0 && x0 + kHalves < job.width && y0 >= 0 && y0 + 1 < job.height;
    });
    for (int t = 0; t < 4; ++t) {
        MS alive = lanes;
        if (!inner) {
            alive = usable(job, slot, jitter, hn::Add(column, set(t & 1)),
                           hn::Add(row, set(t >> 1)), lanes);
        }
        samples.keeps.of[t] = hn::VecFromMask(d, alive);
        samples.behind.of[t] = zero();
    }
    keep(k, stop, clusters, 4, samples.keeps, samples.behind);
    for (int c = 0; c < 3; ++c) {
        samples.colour[c] = fetchFour(slot.colour[c], clusters);
    }
    return true;
}

HWY_INLINE VS pick(MS second, VS first, VS other) {
    return hn::IfThenElse(second, other, first);
}

/// visitSamples() for all output pixels of a block.
template <class Keep>
HWY_NOINLINE void collectOutput(const upscale::Job& job, const OutputBlock& block,
                                const WayOf<kMaxRing>& way, Keep keep, OutputTaps* taps) {
    const Job& frame = job.frame;
    const int rows = block.y1 - block.y0;
    for (int t = 0; t < rows * kMaxUpscale; ++t) {
        taps[t].count = 0;
    }
    for (int k = 0; k < way.frames; ++k, keep.next()) {
        const WayStop& stop = way.stop[k];
        const JitterLanes jitter =
            jitterAt(frame, frame.slot[k], stop.place.column, stop.place.row, stop.alive);
        const VS x = hn::Sub(stop.place.x_fx8, jitter.x_fx8);
        const VS y = hn::Sub(stop.place.y_fx8, jitter.y_fx8);
        if (k == 0) {
            for (int r = 0; r < rows; ++r) {
                const VS part_y = hn::Add(y, set(block.offset_y[r]));
                for (int p = 0; p < block.across; ++p) {
                    const VS part_x = hn::Add(x, load(block.columns.offset[p] + block.i));
                    const MS wanted = hn::And(block.wanted[r][p], stop.alive);
                    for (int t = 0; t < 4; ++t) {
                        takeFresh(frame, stop, jitter,
                                  besideSite(stop.place.column, part_x, t & 1, job.x.ratio_fx8),
                                  besideSite(stop.place.row, part_y, t >> 1, job.y.ratio_fx8),
                                  wanted, keep, taps[r * kMaxUpscale + p]);
                    }
                }
            }
            continue;
        }
        AxisSite across[kMaxUpscale], down[kMaxUpscale];
        for (int p = 0; p < block.across; ++p) {
            across[p] =
                nearestSite(stop.place.column, hn::Add(x, load(block.columns.offset[p] + block.i)),
                            job.x.ratio_fx8);
        }
        for (int r = 0; r < rows; ++r) {
            down[r] =
                nearestSite(stop.place.row, hn::Add(y, set(block.offset_y[r])), job.y.ratio_fx8);
        }
        OldSamples samples;
        samples.column = across[0].number;
        samples.row = down[0].number;
        if (!fetchOld(frame, k, stop, jitter, keep, samples)) {
            continue;
        }
        for (int r = 0; r < rows; ++r) {
            const MS below = hn::Ne(down[r].number, samples.row);
            VS keeps[2], behind[2], colour[3][2];
            for (int i = 0; i < 2; ++i) {
                keeps[i] = pick(below, samples.keeps.of[i], samples.keeps.of[2 + i]);
                behind[i] = pick(below, samples.behind.of[i], samples.behind.of[2 + i]);
                for (int c = 0; c < 3; ++c) {
                    colour[c][i] =
                        pick(below, samples.colour[c].of[i], samples.colour[c].of[2 + i]);
                }
            }
            for (int p = 0; p < block.across; ++p) {
                const MS right = hn::Ne(across[p].number, samples.column);
                OutputTaps& to = taps[r * kMaxUpscale + p];
                const int n = to.count++;
                const VS weight =
                    hn::Add(hn::ShiftRight<1>(hn::Mul(across[p].kernel, down[r].kernel)),
                            set(upscale::kFarWeight));
                to.weight[n] = hn::IfThenElseZero(block.wanted[r][p],
                                                  hn::And(weight, pick(right, keeps[0], keeps[1])));
                to.ex[n] = across[p].place;
                to.ey[n] = down[r].place;
                to.behind[n] = pick(right, behind[0], behind[1]);
                for (int c = 0; c < 3; ++c) {
                    to.colour[c][n] = pick(right, colour[c][0], colour[c][1]);
                }
            }
        }
    }
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
        WayOf<kMaxRing> way;
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
            const int offset_y = job.y.toFrame(job.y.offsetOf(job.y.firstOf(y + 1), y + 1));
            lookAlongFrame(job.frame, tile, y + 1, offset_y, rows[(y + 1) & 1]);
        }
        for (int g = 0; g < count && y >= tile.y0; ++g) {
            OutputBlock block{.columns = columns,
                              .x = tile.x0 + g * kHalves,
                              .y = y,
                              .i = g * kHalves,
                              .across = columns.most,
                              .y0 = 0,
                              .y1 = 0,
                              .offset_y = {},
                              .wanted = {}};
            if (ask(job, y, sums_valid, block)) {
                gatherBlock(job, block, rows[y & 1][g]);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
