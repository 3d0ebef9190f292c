// Samples of a slot for a group of pixels: the 2×2 around each place, loaded in as few pieces as
// they lie in, with their weights. Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// Lanes whose 2×2 samples are loaded at once.
struct Cluster {
    ptrdiff_t upper, lower;  ///< index of the upper left and lower left sample of lane 0
    MS lanes;
};
struct Clusters {
    Cluster of[kHalves];
    int count = 0;
};

/// One value for each of the four samples: left and right of the upper row, then of the lower one.
struct Four {
    VS of[4];
};

HWY_INLINE Four fetchFour(const int16_t* plane, const Clusters& clusters) {
    const Cluster& first = clusters.of[0];
    Four four{{load(plane + first.upper), load(plane + first.upper + 1), load(plane + first.lower),
               load(plane + first.lower + 1)}};
    for (int i = 1; i < clusters.count; ++i) {
        const Cluster& c = clusters.of[i];
        four.of[0] = hn::IfThenElse(c.lanes, load(plane + c.upper), four.of[0]);
        four.of[1] = hn::IfThenElse(c.lanes, load(plane + c.upper + 1), four.of[1]);
        four.of[2] = hn::IfThenElse(c.lanes, load(plane + c.lower), four.of[2]);
        four.of[3] = hn::IfThenElse(c.lanes, load(plane + c.lower + 1), four.of[3]);
    }
    return four;
}

/// Places in a frame: whole pixels and 1/256 pixel beyond them, 0 … 255.
struct PlaceLanes {
    VS column, row, x_fx8, y_fx8;
};

HWY_INLINE void moveAxis(VS& whole, VS& part, VS by_fx8) {
    const VS sum = hn::Add(part, hn::And(by_fx8, set(255)));
    whole = hn::Add(whole, hn::Add(hn::ShiftRight<8>(by_fx8), hn::ShiftRight<8>(sum)));
    part = hn::And(sum, set(255));
}

/// Where the samples lie in the tiles that places lie in.
struct JitterLanes {
    VS x_fx8, y_fx8;
    bool alike;  ///< there and around
};

/// The tiles from one pixel above and left of the places to two below and right of them.
struct TileSpan {
    int x0, y0, x1, y1;
};
HWY_INLINE TileSpan spanOf(const Job& job, VS column, VS row, MS lanes) {
    const DS d;
    alignas(64) int16_t values[kHalves];
    const auto extremes = [&](VS v, int last, int& low, int& high) {
        const VS held = hn::Min(hn::Max(v, zero()), set(last));
        hn::Store(hn::IfThenElse(lanes, held, set(last)), d, values);
        int16_t least = values[0];
        for (int i = 1; i < kHalves; ++i) {
            least = std::min(least, values[i]);
        }
        hn::Store(hn::IfThenElseZero(lanes, held), d, values);
        int16_t most = values[0];
        for (int i = 1; i < kHalves; ++i) {
            most = std::max(most, values[i]);
        }
        low = std::max(least - 1, 0) / kTileSize;
        high = std::min(most + 2, last) / kTileSize;
    };
    TileSpan span;
    extremes(column, job.width - 1, span.x0, span.x1);
    extremes(row, job.height - 1, span.y0, span.y1);
    return span;
}

/// jitterOf() in lanes, of places in the span.
HWY_INLINE JitterLanes jitterWithin(const Job& job, const SlotIn& slot, const TileSpan& span,
                                    VS column, VS row) {
    static_assert(kTileSize == 1 << 6);
    const auto tileOf = [](VS v, int last) {
        return hn::ShiftRight<6>(hn::Min(hn::Max(v, zero()), set(last)));
    };
    const VS tile_x = tileOf(column, job.width - 1), tile_y = tileOf(row, job.height - 1);
    JitterLanes jitter{zero(), zero(), false};
    for (int y = span.y0; y <= span.y1; ++y) {
        for (int x = span.x0; x <= span.x1; ++x) {
            const TileJitter& tile = slot.tile_jitter[y * job.tiles_x + x];
            const MS here = hn::And(hn::Eq(tile_x, set(x)), hn::Eq(tile_y, set(y)));
            jitter.x_fx8 = hn::IfThenElse(here, set(tile.x_fx8), jitter.x_fx8);
            jitter.y_fx8 = hn::IfThenElse(here, set(tile.y_fx8), jitter.y_fx8);
        }
    }
    return jitter;
}

HWY_NOINLINE JitterLanes jitterOfTiles(const Job& job, const SlotIn& slot, VS column, VS row,
                                       MS lanes) {
    const TileSpan span = spanOf(job, column, row, lanes);
    const TileJitter& first = slot.tile_jitter[span.y0 * job.tiles_x + span.x0];
    bool alike = true;
    for (int y = span.y0; y <= span.y1; ++y) {
        for (int x = span.x0; x <= span.x1; ++x) {
            alike &= first.sameAs(slot.tile_jitter[y * job.tiles_x + x]);
        }
    }
    if (alike) {
        return {set(first.x_fx8), set(first.y_fx8), true};
    }
    return jitterWithin(job, slot, span, column, row);
}

HWY_INLINE JitterLanes jitterAt(const Job& job, const SlotIn& slot, VS column, VS row, MS lanes) {
    if (slot.tile_jitter == nullptr) {
        return {set(slot.jitter_x_fx8), set(slot.jitter_y_fx8), true};
    }
    return jitterOfTiles(job, slot, column, row, lanes);
}

/// The samples around the places.
struct Site {
    VS right, lower;  ///< axisWeight()
    VS cx, cy;        ///< places less those of the upper left samples, 1/64 pixel rounded up
    VS weight[4];     ///< 0 outside the picture
    MS lanes;         ///< that have samples
    bool inner;       ///< no sample lies outside
};

HWY_INLINE VS axisWeights(VS part) {
    const VS scaled = hn::Add(hn::Mul(hn::Sub(part, set(51)), set(53)), set(271));
    return hn::Min(hn::Max(hn::ShiftRight<9>(scaled), zero()), set(kAxisWeight));
}

/// Weights of samples outside become 0.
HWY_NOINLINE void cutAtBorder(const Job& job, VS column, VS row, Site& site) {
    const VS one = set(1);
    const MS in[4] = {hn::Eq(beyond(column, job.width - 1), zero()),
                      hn::Eq(beyond(hn::Add(column, one), job.width - 1), zero()),
                      hn::Eq(beyond(row, job.height - 1), zero()),
                      hn::Eq(beyond(hn::Add(row, one), job.height - 1), zero())};
    for (int t = 0; t < 4; ++t) {
        site.weight[t] = hn::IfThenElseZero(hn::And(in[t & 1], in[2 + (t >> 1)]), site.weight[t]);
    }
}

/// Weights of samples that lie otherwise than those of the place's own tile become 0.
HWY_NOINLINE void cutAtSeams(const Job& job, const SlotIn& slot, const JitterLanes& jitter,
                             VS column, VS row, Site& site) {
    const TileSpan span = spanOf(job, column, row, site.lanes);
    for (int t = 0; t < 4; ++t) {
        const JitterLanes there =
            jitterWithin(job, slot, span, hn::Add(column, set(t & 1)), hn::Add(row, set(t >> 1)));
        const MS same =
            hn::And(hn::Eq(there.x_fx8, jitter.x_fx8), hn::Eq(there.y_fx8, jitter.y_fx8));
        site.weight[t] = hn::IfThenElseZero(same, site.weight[t]);
    }
}

/// The samples of this frame, whose places are the same in all pixels. False near the picture's
/// border, and near tiles that rest.
HWY_INLINE bool findSiteNow(const Job& job, int x, int y, MS lanes, Site& site,
                            Clusters& clusters) {
    const int sx = x * 256 - job.slot[0].jitter_x_fx8, sy = y * 256 - job.slot[0].jitter_y_fx8;
    const int x0 = sx >> 8, y0 = sy >> 8;
    if (x0 < 0 || x0 + kHalves >= job.width || y0 < 0 || y0 + 1 >= job.height) {
        return false;
    }
    if (job.slot[0].tile_jitter != nullptr) {
        const TileJitter own{int16_t(job.slot[0].jitter_x_fx8), int16_t(job.slot[0].jitter_y_fx8)};
        for (int corner = 0; corner < 4; ++corner) {
            const int column = (corner & 1) != 0 ? x0 + kHalves : x0;
            if (!own.sameAs(jitterOf(job, job.slot[0], column, y0 + (corner >> 1)))) {
                return false;
            }
        }
    }
    const int right = axisWeight(sx & 255), lower = axisWeight(sy & 255);
    site.right = set(right);
    site.lower = set(lower);
    site.cx = set(((sx & 255) + 3) >> 2);
    site.cy = set(((sy & 255) + 3) >> 2);
    const int across[2] = {kAxisWeight - right, right}, down[2] = {kAxisWeight - lower, lower};
    for (int t = 0; t < 4; ++t) {
        site.weight[t] = hn::IfThenElseZero(lanes, set(across[t & 1] * down[t >> 1]));
    }
    site.lanes = lanes;
    site.inner = true;
    const ptrdiff_t at = y0 * job.stride + x0;
    clusters.of[0] = {at, at + job.stride, lanes};
    clusters.count = 1;
    return true;
}

/// False when no lane has samples.
HWY_NOINLINE bool findSite(const Job& job, const SlotIn& slot, const PlaceLanes& place, MS alive,
                           Site& site, Clusters& clusters) {
    const DS d;
    VS column = place.column, row = place.row, x = place.x_fx8, y = place.y_fx8;
    const JitterLanes jitter = jitterAt(job, slot, place.column, place.row, alive);
    moveAxis(column, x, hn::Neg(jitter.x_fx8));
    moveAxis(row, y, hn::Neg(jitter.y_fx8));
    const VS one = set(1);
    const VS out =
        hn::Or(beyond(hn::Add(column, one), job.width), beyond(hn::Add(row, one), job.height));
    site.lanes = hn::And(alive, hn::Eq(out, zero()));
    if (!any(site.lanes)) {
        return false;
    }
    site.right = axisWeights(x);
    site.lower = axisWeights(y);
    site.cx = hn::ShiftRight<2>(hn::Add(x, set(3)));
    site.cy = hn::ShiftRight<2>(hn::Add(y, set(3)));
    const VS full = set(kAxisWeight);
    const VS across[2] = {hn::Sub(full, site.right), site.right};
    const VS down[2] = {hn::IfThenElseZero(site.lanes, hn::Sub(full, site.lower)),
                        hn::IfThenElseZero(site.lanes, site.lower)};
    for (int t = 0; t < 4; ++t) {
        site.weight[t] = hn::Mul(across[t & 1], down[t >> 1]);
    }
    clusters.count = 0;
    site.inner = true;
    forClusters(hn::Sub(column, hn::Iota(d, 0)), row, site.lanes, [&](int x0, int y0, MS lanes) {
        // Rows outside are not memory: others are read in their stead, and weigh nothing.
        const ptrdiff_t upper = y0 < 0 ? 0 : y0;
        const ptrdiff_t lower = y0 + 1 < job.height ? y0 + 1 : y0;
        clusters.of[clusters.count++] = {upper * job.stride + x0, lower * job.stride + x0, lanes};
        site.inner &= x0 >= 0 && x0 + kHalves < job.width && y0 >= 0 && y0 + 1 < job.height;
    });
    if (!site.inner) {
        cutAtBorder(job, column, row, site);
    }
    if (!jitter.alike) {
        cutAtSeams(job, slot, jitter, column, row, site);
        site.inner = false;
    }
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
