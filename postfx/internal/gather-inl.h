// The gather in lanes, one pixel each; gather_reference.cpp is the truth and names the steps. Two
// passes: the first follows the surfaces back, decides which samples count, and keeps them with
// their weights; the second weighs their colours, once the moments of their places are known.
// Included once per target by taa_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::taa {
namespace HWY_NAMESPACE {

/// tiltOf()
HWY_INLINE void tiltLanes(const Kept& m, VI32& tilt_x, VI32& tilt_y) {
    const DI32 di;
    const VI32 ridge =
        hn::Add(hn::ShiftRight<8>(hn::Mul(m.w, hn::Set(di, kRidge))), hn::Set(di, 16));
    const VI32 a = hn::Add(hn::ShiftRight<8>(m.xx), ridge);
    const VI32 b = hn::ShiftRight<8>(m.xy);
    const VI32 c = hn::Add(hn::ShiftRight<8>(m.yy), ridge);
    const VI32 x = hn::ShiftRight<4>(m.x), y = hn::ShiftRight<4>(m.y);
    VI32 det = hn::Sub(hn::Mul(a, c), hn::Mul(b, b));
    VI32 nx = hn::Sub(hn::Mul(c, x), hn::Mul(b, y));
    VI32 ny = hn::Sub(hn::Mul(a, y), hn::Mul(b, x));
    const auto normalise = [&](auto shift_tag) {
        constexpr int kShift = decltype(shift_tag)::value;
        const auto large = atLeast(det, hn::Set(di, 256 << kShift));
        det = hn::IfThenElse(large, hn::ShiftRight<kShift>(det), det);
        nx = hn::IfThenElse(large, hn::ShiftRight<kShift>(nx), nx);
        ny = hn::IfThenElse(large, hn::ShiftRight<kShift>(ny), ny);
    };
    normalise(std::integral_constant<int, 16>());
    normalise(std::integral_constant<int, 8>());
    normalise(std::integral_constant<int, 4>());
    normalise(std::integral_constant<int, 2>());
    normalise(std::integral_constant<int, 1>());
    const VI32 reciprocal =
        hn::GatherIndex(di, kSmallReciprocals.data(), hn::Sub(det, hn::Set(di, 256)));
    const auto quotient = [&](VI32 n) {
        const VI32 small = hn::Min(hn::Max(n, hn::Set(di, -16384)), hn::Set(di, 16383));
        return hn::ShiftRight<6>(hn::Mul(small, reciprocal));
    };
    tilt_x = quotient(nx);
    tilt_y = quotient(ny);
    for (int i = 0; i < 6; ++i) {
        const auto steep = hn::Gt(hn::Add(hn::Abs(tilt_x), hn::Abs(tilt_y)), hn::Set(di, kMaxTilt));
        if (hn::AllFalse(di, steep)) {
            return;
        }
        tilt_x = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_x), tilt_x);
        tilt_y = hn::IfThenElse(steep, hn::ShiftRight<1>(tilt_y), tilt_y);
    }
}

struct Colour {
    V32 of[3];
};

/// fit(): where it returns false, `colour` stays. `behind` replaces what shows the layer behind.
HWY_INLINE Mask32 fitLanes(const Kept& kept, const Colour* behind, Mask32 separate,
                           Colour& colour) {
    const D32 d;
    const DI32 di;
    VI32 tilt_x, tilt_y;
    tiltLanes(kept, tilt_x, tilt_y);
    V32 total = hn::Zero(d), sum[3] = {total, total, total};
    const VI32 x_step = hn::ShiftLeft<6>(tilt_x), y_step = hn::ShiftLeft<6>(tilt_y);
    const VI32 one = hn::Set(di, 1 << kTiltBits);
    for (int f = 0; f < kept.frames; ++f) {
        const Kept::Frame& frame = kept.frame[f];
        const VI32 corner =
            hn::Sub(one, hn::Add(hn::Mul(tilt_x, frame.ex), hn::Mul(tilt_y, frame.ey)));
        for (int t = 0; t < 4; ++t) {
            VI32 factor = (t & 1) != 0 ? hn::Sub(corner, x_step) : corner;
            factor = (t & 2) != 0 ? hn::Sub(factor, y_step) : factor;
            const V32 weight =
                asUnsigned(roundedShift<kTiltBits>(hn::Mul(asSigned(frame.weight[t]), factor)));
            V32 rgb[3] = {low(frame.red_green[t]), high(frame.red_green[t]), low(frame.blue[t])};
            if (behind != nullptr) {
                const Mask32 back = hn::And(separate, hn::Ne(high(frame.blue[t]), hn::Zero(d)));
                for (int c = 0; c < 3; ++c) {
                    rgb[c] = choose(back, behind->of[c], rgb[c]);
                }
            }
            total = hn::Add(total, weight);
            for (int c = 0; c < 3; ++c) {
                sum[c] = hn::Add(sum[c], hn::Mul(weight, rgb[c]));
            }
        }
    }
    const Mask32 fits = hn::And(maskOf(hn::Gt(kept.w, hn::Set(di, 1))),
                                maskOf(hn::Gt(asSigned(total), hn::Set(di, 1))));
    const V32 reciprocal = hn::GatherIndex(d, kReciprocals.data(), asSigned(total));
    const V32 half = hn::ShiftRight<1>(total);
    for (int c = 0; c < 3; ++c) {
        colour.of[c] = choose(fits, highProduct(hn::Add(sum[c], half), reciprocal), colour.of[c]);
    }
    return fits;
}

/// lookAround() for the pixels at `at`, whose owners stand in this frame's record.
HWY_INLINE WindowLanes windowOf(const Job& job, ptrdiff_t at, const Owners& seen, const Owners& far,
                                VI32 calm_frames, Mask32 pixels) {
    const D32 d;
    const DI32 di;
    const V32 surface_mask = hn::Set(d, kSurfaceMask);
    const SlotIn& now = job.slot[0];
    const V32 owner = hn::LoadU(d, now.owner + at);
    const Mask32 inferred = hn::Ne(hn::And(owner, hn::Set(d, kInferredBit)), hn::Zero(d));
    WindowLanes w;
    w.owner.surface = hn::And(owner, surface_mask);
    w.owner.depth = asSigned(high(hn::LoadU(d, now.depths + at)));
    w.owner.motion = hn::LoadU(d, now.motion + at);
    w.normal = high(owner);
    const VI32 slope = hn::IfThenZeroElse(
        signedMask(inferred), slopesOf(job, at, w.owner.surface, asUnsigned(w.owner.depth)));
    const VI32 step = hn::Sub(asSigned(seen.expected), w.owner.depth);
    w.owner.step = hn::IfThenZeroElse(signedMask(inferred), step);
    const VI32 tolerance = hn::Set(di, kDepthTolerance);
    const VI32 sloped = hn::Mul(slope, hn::Set(di, kSlopeFactor));
    w.owner.tolerance = hn::Add(tolerance, sloped);
    const Mask32 moved = hn::Ne(hn::And(seen.id, hn::Set(d, kMovedBit)), hn::Zero(d));
    w.moved = hn::And(hn::AndNot(inferred, moved), pixels);
    w.far.surface = hn::And(far.id, surface_mask);
    w.far.depth = asSigned(clampedLogDepth(far.depth));
    w.far.step = hn::Sub(asSigned(far.expected), w.far.depth);
    w.far.tolerance = tolerance;
    w.far.motion = far.motion;
    const VI32 height = hn::Sub(w.owner.depth, w.far.depth);
    w.layered = maskOf(hn::Gt(height, hn::Add(tolerance, hn::Add(sloped, sloped))));
    w.frames = choose(hn::Or(w.layered, inferred), hn::Set(di, kMaxRing), calm_frames);
    w.flat = maskOf(hn::Eq(w.frames, hn::Set(di, kFlatFrames)));
    const VI32 speed =
        hn::Max(hn::Abs(lowSigned(w.owner.motion)), hn::Abs(highSigned(w.owner.motion)));
    w.frames = choose(maskOf(hn::Gt(speed, hn::Set(di, kFast))),
                      hn::Min(w.frames, hn::Set(di, kFastFrames)), w.frames);
    if (job.turning != nullptr) {
        const V32 turning = hn::GatherIndex(d, job.turning, asSigned(w.owner.surface));
        const VI32 fewer = hn::Min(w.frames, hn::Set(di, kTurningFrames));
        w.frames = choose(hn::Ne(turning, hn::Zero(d)), fewer, w.frames);
    }
    w.slide = slideOf(w.owner.motion, w.far.motion);
    const VI32 none = hn::Set(di, kNoHistory);
    const Mask32 known = hn::Not(maskOf(
        hn::Or(hn::Eq(lowSigned(w.owner.motion), none), hn::Eq(lowSigned(w.far.motion), none))));
    w.apart = hn::And(hn::And(hn::And(w.layered, known), pixels),
                      maskOf(hn::Gt(w.slide, hn::Set(di, kApart))));
    return w;
}

/// mixSpatial() for the few lanes that need it.
HWY_INLINE void mixSpatialLanes(const Job& job, int x, int y, VI32 old_weight, Mask32 lanes,
                                Colour& colour) {
    const D32 d;
    const DI32 di;
    alignas(64) uint32_t rgb[3][kMaxLanes], wanted[kMaxLanes];
    alignas(64) int32_t weight[kMaxLanes];
    for (int c = 0; c < 3; ++c) {
        hn::StoreU(colour.of[c], d, rgb[c]);
    }
    hn::StoreU(old_weight, di, weight);
    hn::StoreU(hn::IfThenElseZero(lanes, hn::Set(d, 1)), d, wanted);
    for (int i = 0; i < int(hn::Lanes(d)); ++i) {
        if (wanted[i] != 0) {
            int pixel[3] = {int(rgb[0][i]), int(rgb[1][i]), int(rgb[2][i])};
            mixSpatial(job, x + i, y, weight[i], pixel);
            for (int c = 0; c < 3; ++c) {
                rgb[c][i] = uint32_t(pixel[c]);
            }
        }
    }
    for (int c = 0; c < 3; ++c) {
        colour.of[c] = hn::LoadU(d, rgb[c]);
    }
}

/// A group of pixels of a row.
struct Group {
    WindowLanes window;
    Walker walker;
    Way way;     ///< of the window's owner
    V32 pixels;  ///< all ones in the lanes that are asked for
    bool wanted;
};

HWY_INLINE void gatherGroup(const Job& job, int x, int y, const Group& group) {
    const D32 d;
    const DI32 di;
    const ptrdiff_t at = y * job.stride + x;
    const WindowLanes& window = group.window;
    const Mask32 pixels = hn::MaskFromVec(group.pixels);
    Colour colour;
    for (int c = 0; c < 3; ++c) {
        colour.of[c] = load16(job.now.colour[c] + at);
    }
    Kept kept;
    Colour behind = colour;
    Mask32 separate = hn::MaskFromVec(hn::Zero(d));
    const bool any_apart = !hn::AllFalse(d, window.apart);
    if (any_apart) {
        Walker walker = startWay(x, y, window.far, window.apart);
        const int frames = std::min(kFarFrames, job.frames);
        Way way;
        for (int k = 0; k < frames; ++k) {
            stepWay(job, k, k + 1 == frames, window.far, hn::Set(di, kMaxRing), walker, way);
        }
        collect(job, x, way, FarRule{job, window}, kept);
        separate = hn::And(fitLanes(kept, nullptr, separate, behind), window.apart);
    }
    const bool any_moved = !hn::AllFalse(d, window.moved);
    const auto collectOwn = [&](auto behind_tag) {
        const OwnRule<decltype(behind_tag)::value> rule{job, window, decodeNormals(window.normal),
                                                        any_moved};
        collect(job, x, group.way, rule, kept);
    };
    if (any_apart) {
        collectOwn(std::true_type());
    } else {
        collectOwn(std::false_type());
    }
    fitLanes(kept, any_apart ? &behind : nullptr, separate, colour);
    const Mask32 lone = hn::And(hn::AndNot(window.flat, pixels),
                                maskOf(hn::Lt(kept.old_weight, hn::Set(di, kFrameWeight))));
    if (!hn::AllFalse(d, lone)) {
        mixSpatialLanes(job, x, y, kept.old_weight, lone, colour);
    }
    for (int c = 0; c < 3; ++c) {
        const V32 shown = load16(job.shown[c] + at);
        store16(choose(pixels, colour.of[c], shown), job.shown[c] + at);
    }
    const V32 count = asUnsigned(roundedShift<8>(kept.w));
    store8(choose(pixels, count, load8(job.shown_count + at)), job.shown_count + at);
}

/// Smallest and largest of each column of three, by channel; columns as in OwnerStrip.
struct ContrastStrip {
    alignas(64) uint16_t low[3][OwnerStrip::kWidth], high[3][OwnerStrip::kWidth];
};

HWY_INLINE void fillContrast(const Job& job, const TileRect& tile, int y, ContrastStrip& strip) {
    const hn::ScalableTag<uint16_t> d;
    const int lanes = int(hn::Lanes(d));
    const ptrdiff_t up = y > 0 ? -job.stride : 0;
    const ptrdiff_t down = y + 1 < job.height ? job.stride : 0;
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < OwnerStrip::kWidth; i += lanes) {
            const uint16_t* at = job.now.colour[c] + y * job.stride + tile.x0 - kMaxLanes + i;
            const auto a = hn::LoadU(d, at + up), b = hn::LoadU(d, at), e = hn::LoadU(d, at + down);
            hn::StoreU(hn::Min(hn::Min(a, b), e), d, strip.low[c] + i);
            hn::StoreU(hn::Max(hn::Max(a, b), e), d, strip.high[c] + i);
        }
        if (tile.x0 == 0) {
            strip.low[c][kMaxLanes - 1] = strip.low[c][kMaxLanes];
            strip.high[c][kMaxLanes - 1] = strip.high[c][kMaxLanes];
        }
        if (tile.x1 == job.width) {
            const int last = kMaxLanes + tile.x1 - tile.x0 - 1;
            strip.low[c][last + 1] = strip.low[c][last];
            strip.high[c][last + 1] = strip.high[c][last];
        }
    }
}

/// Frames to follow by the window's contrast alone: see lookAround().
HWY_INLINE VI32 calmFrames(const ContrastStrip& strip, int x_in_tile) {
    const DI32 di;
    const int i = kMaxLanes + x_in_tile;
    Mask32 flat = hn::Not(hn::MaskFromVec(hn::Zero(D32())));
    Mask32 calm = flat;
    for (int c = 0; c < 3; ++c) {
        const uint16_t* l = strip.low[c] + i;
        const uint16_t* h = strip.high[c] + i;
        const V32 low = hn::Min(hn::Min(load16(l - 1), load16(l)), load16(l + 1));
        const VI32 high = asSigned(hn::Max(hn::Max(load16(h - 1), load16(h)), load16(h + 1)));
        const VI32 span = hn::Sub(hn::Sub(high, asSigned(low)), hn::Set(di, 4));
        flat = hn::And(flat, maskOf(atMost(span, hn::ShiftRight<kFlatShift>(high))));
        calm = hn::And(calm, maskOf(atMost(span, hn::ShiftRight<kCalmShift>(high))));
    }
    return choose(flat, hn::Set(di, kFlatFrames),
                  choose(calm, hn::Set(di, kCalmFrames), hn::Set(di, kMaxRing)));
}

HWY_ATTR void gatherTile(const Job& job, const TileRect& tile, bool sums_valid) noexcept {
    const D32 d;
    const DI32 di;
    constexpr int kLanes = int(hn::MaxLanes(d));
    OwnerStrip near_strip, far_strip;
    ContrastStrip contrast;
    Group groups[kTileSize / kLanes];
    const int count = (tile.x1 - tile.x0 + kLanes - 1) / kLanes;
    for (int y = tile.y0; y < tile.y1; ++y) {
        fillStrip<Nearest, kIdDepth>(job, tile, y, near_strip);
        fillStrip<Farthest, kWithMotion>(job, tile, y, far_strip);
        fillContrast(job, tile, y, contrast);
        for (int i = 0; i < count; ++i) {
            const int x = tile.x0 + i * kLanes;
            const ptrdiff_t at = y * job.stride + x;
            Group& group = groups[i];
            Mask32 pixels = lanesBefore(tile.x1 - x);
            if (sums_valid) {
                const VI32 samples = asSigned(load8(job.sums.count + at));
                pixels = hn::And(pixels, maskOf(hn::Lt(samples, hn::Set(di, job.settled))));
            }
            group.wanted = !hn::AllFalse(d, pixels);
            group.pixels = hn::VecFromMask(d, pixels);
            Owners seen = ownersOf<Nearest, kIdDepth>(near_strip, i * kLanes);
            preferCentre<kIdDepth>(job, at, seen);
            group.window =
                windowOf(job, at, seen, ownersOf<Farthest, kWithMotion>(far_strip, i * kLanes),
                         calmFrames(contrast, i * kLanes), pixels);
            group.walker = startWay(x, y, group.window.owner, pixels);
            group.way.frames = 0;
        }
        // Each step of a way waits for the one before: all groups of the row wait at once.
        for (int k = 0; k < job.frames; ++k) {
            for (int i = 0; i < count; ++i) {
                Group& group = groups[i];
                stepWay(job, k, k + 1 == job.frames, group.window.owner, group.window.frames,
                        group.walker, group.way);
            }
        }
        for (int i = 0; i < count; ++i) {
            if (groups[i].wanted) {
                gatherGroup(job, tile.x0 + i * kLanes, y, groups[i]);
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace still::taa
HWY_AFTER_NAMESPACE();
