// The resolve in lanes, a row of a tile at a time; lab_reference.cpp is the truth. Each function is
// compiled for every source of a policy: for a preset, all questions about it are answered by the
// compiler; the generic one asks for every vector of pixels.

HWY_BEFORE_NAMESPACE();
namespace still::lab {
namespace HWY_NAMESPACE {

template <size_t kIndex>
struct Preset {
    static constexpr TaaPolicy kPolicy = resolvePart(kRecipes[kIndex].policy);
    static constexpr const TaaPolicy& of(const ResolveJob&) { return kPolicy; }
};
struct AnyPolicy {
    static const TaaPolicy& of(const ResolveJob& job) { return job.policy; }
};

struct Shares {
    VI32 alpha_q15, count, memory, confidence;
};

/// trustOf(): history's weight after the tests, 256 = full.
HWY_INLINE VI32 trustOf(const TaaPolicy& p, MaskI found, VI32 failed) {
    if (!p.partial) {
        return hn::IfThenElseZero(hn::And(found, hn::Eq(failed, zero())), all(256));
    }
    VI32 trust = hn::IfThenElseZero(found, all(256));
    for (int k = 1; k <= kTests; ++k) {
        trust = choose(hn::Lt(failed, all(k)), trust, hn::ShiftRight<1>(trust));
    }
    return trust;
}

HWY_INLINE VI32 lessTrust(VI32 alpha_q15, VI32 weight_q8) {
    const VI32 one = all(kAlphaOne);
    return hn::Sub(one, hn::ShiftRight<8>(hn::Mul(hn::Sub(one, alpha_q15), weight_q8)));
}

template <class Source>
STILL_LAB_PHASE Shares shareOf(const ResolveJob& job, VI32 memory, VI32 trust_q8, VI32 speed_fx8) {
    const TaaPolicy& p = Source::of(job);
    Shares s{all(p.alpha_q15), zero(), zero(), hn::Min(trust_q8, all(255))};
    switch (p.blend) {
        case Blend::fixed:
            s.alpha_q15 = lessTrust(s.alpha_q15, trust_q8);
            break;
        case Blend::velocity: {
            const VI32 more = hn::Mul(speed_fx8, all(p.velocity_alpha_q15));
            s.alpha_q15 = hn::Min(hn::Add(s.alpha_q15, hn::ShiftRight<8>(more)), all(kAlphaOne));
            s.alpha_q15 = lessTrust(s.alpha_q15, trust_q8);
            break;
        }
        case Blend::confidence: {
            const VI32 grown = hn::Min(hn::Add(memory, all(kConfidenceStep)), all(255));
            s.memory = hn::ShiftRight<8>(hn::Mul(grown, trust_q8));
            const VI32 rest =
                hn::Mul(hn::Sub(all(255), s.memory), all((kAlphaOne - p.alpha_q15) * 257));
            s.alpha_q15 = hn::Add(s.alpha_q15, shiftUnsigned<16>(hn::Add(rest, all(32768))));
            s.confidence = s.memory;
            break;
        }
        case Blend::mean: {
            const VI32 known = hn::ShiftRight<8>(hn::Mul(memory, trust_q8));
            s.count = hn::Min(known, all(p.count_cap - 1));
            s.memory = hn::Add(s.count, all(1));
            const VI32 share = hn::Mul(s.count, all(int32_t(job.constants.count_share_q16)));
            s.confidence = hn::Min(shiftUnsigned<16>(share), all(255));
            if (p.anti_flicker != AntiFlicker::none) {
                s.alpha_q15 = lookUpAlike(kMeanAlphas.of, s.memory);
            }
            break;
        }
    }
    return s;
}

HWY_INLINE VI32 steadyAlpha(const TaaPolicy& p, VI32 alpha_q15, VI32 luma, VI32 history_luma) {
    const VI32 high = hn::Max(luma, history_luma), low = hn::Min(luma, history_luma);
    const VI32 scale = hn::Max(high, all(steadyLuma(p.tone)));
    const VI32 alike = hn::Sub(all(256), quotient<8>(hn::Sub(high, low), scale));
    const VI32 square = hn::ShiftRight<8>(hn::Mul(alike, alike));
    const VI32 less = hn::ShiftRight<8>(hn::Mul(square, all(kAlphaOne - p.steady_share_q15)));
    return hn::Sub(alpha_q15, hn::ShiftRight<15>(hn::Mul(alpha_q15, less)));
}

HWY_INLINE VI32 inverseWeight(const TaaPolicy& p, VI32 luma) {
    const bool linear = p.tone == Tone::linear;
    if (p.anti_flicker == AntiFlicker::inverse_log) {
        return lookUp(kLogs.of, linear ? hn::ShiftRight<6>(luma) : hn::ShiftRight<9>(luma));
    }
    return hn::ShiftRight<2>(hn::Add(luma, all(linear ? 4096 : 32768)));
}

STILL_LAB_PHASE VI32 steadied(const TaaPolicy& p, VI32 alpha_q15, VI32 luma, VI32 history_luma) {
    if (p.anti_flicker == AntiFlicker::none) {
        return alpha_q15;
    }
    VI32 result;
    if (p.anti_flicker == AntiFlicker::luma_difference) {
        result = steadyAlpha(p, alpha_q15, luma, history_luma);
    } else {
        const VI32 share = hn::Mul(alpha_q15, inverseWeight(p, history_luma));
        const VI32 rest = hn::Mul(hn::Sub(all(kAlphaOne), alpha_q15), inverseWeight(p, luma));
        result = quotient<15>(share, hn::Add(share, rest));
    }
    return choose(hn::Eq(alpha_q15, all(kAlphaOne)), alpha_q15, result);
}

template <class Source>
STILL_LAB_PHASE Colours blend(const ResolveJob& job, const Shares& share,
                              const Colours& history_w24, const Colours& sample_w24) {
    const TaaPolicy& p = Source::of(job);
    Colours result;
    if (p.blend != Blend::mean || p.anti_flicker != AntiFlicker::none) {
        for (int c = 0; c < 3; ++c) {
            result.v[c] = blended(history_w24.v[c], sample_w24.v[c], share.alpha_q15);
        }
        return result;
    }
    const MaskI first = hn::Eq(share.count, zero());
    const Growth growth = growthOf(hn::Max(share.count, all(1)));
    for (int c = 0; c < 3; ++c) {
        const VI32 mean =
            extendedMean(history_w24.v[c], sample_w24.v[c], growth, p.sample == SampleFilter::box);
        result.v[c] = choose(first, sample_w24.v[c], mean);
    }
    return result;
}

template <class Source>
STILL_LAB_PHASE void storeGroup(const ResolveJob& job, const Guides& guides,
                                const Colours& colour_w24, const Shares& share, int x, int y) {
    const TaaPolicy& p = Source::of(job);
    const ptrdiff_t at = y * job.history_stride + x, shown_at = y * job.stride + x;
    const Colours working = rounded(colour_w24);
    const Colours shown = p.tone == Tone::reinhard ? toneOut(working) : working;
    for (int c = 0; c < 3; ++c) {
        store(colour_w24.v[c], job.next.colour_w24[c] + at);
        store(shown.v[c], job.shown[c] + shown_at);
    }
    store(share.confidence, job.confidence + shown_at);
    if (needsMemory(p)) {
        store(share.memory, job.next.memory + at);
    }
    if (needsDepth(p)) {
        store(guides.depth, job.next.depth + at);
    }
    if (p.id_reject) {
        store(guides.surface, job.next.surface + at);
    }
    if (needsNormal(p)) {
        store(guides.normal, job.next.normal + at);
    }
    if (needsMotion(p)) {
        store(guides.motion, job.next.motion + at);
    }
}

HWY_INLINE bool needsSpeed(const TaaPolicy& p) {
    return p.blend == Blend::velocity || (usesStatistics(p) && p.sigma_still_fx8 != 0);
}

template <class Source>
STILL_LAB_PHASE void resolveGroup(const ResolveJob& job, const TileRect& tile, const Rows& rows,
                                  const GuideStrip& strip, int x, int y) {
    const TaaPolicy& p = Source::of(job);
    const int i = kMaxLanes + x - tile.x0;
    const MaskI pixels = hn::Lt(hn::Iota(DI32(), x), all(tile.x1));
    const Colours sample_w24 = filteredSample_w24<Source>(job, rows, i);
    const Guides guides = findGuide<Source>(job, tile, strip, x, y);
    Pasts past = findPast<Source>(job, guides, pixels, x, y);
    Colours history = rounded(past.colour_w24);
    const VI32 luma = lumaOf(rounded(sample_w24));
    if (p.luma_reject_q15 > 0) {
        const MaskI other = differentLumas(luma, lumaOf(history), p.luma_reject_q15);
        past.failed = hn::Add(past.failed, oneWhere(other));
    }
    const VI32 speed_fx8 =
        needsSpeed(p) ? speedOf(motionX(guides.motion), motionY(guides.motion)) : zero();
    const MaskI changed = rectify<Source>(job, rows, i, speed_fx8, history);
    for (int c = 0; c < 3; ++c) {
        past.colour_w24.v[c] =
            choose(changed, hn::ShiftLeft<kFractionBits>(history.v[c]), past.colour_w24.v[c]);
    }
    const VI32 trust_q8 = trustOf(p, past.found, past.failed);
    Shares share = shareOf<Source>(job, past.memory, trust_q8, speed_fx8);
    share.alpha_q15 = steadied(p, share.alpha_q15, luma, lumaOf(history));
    storeGroup<Source>(job, guides, blend<Source>(job, share, past.colour_w24, sample_w24), share,
                       x, y);
}

template <class Source>
HWY_ATTR void resolveTile(const ResolveJob& job, const TileRect& tile) noexcept {
    const int lanes = int(hn::Lanes(D32()));
    ColourStrip colours[3] = {};
    GuideStrip guides = {};
    fillColours<Source>(job, tile, tile.y0 - 1, colours[0]);
    fillColours<Source>(job, tile, tile.y0, colours[1]);
    for (int y = tile.y0; y < tile.y1; ++y) {
        const int k = y - tile.y0;
        fillColours<Source>(job, tile, y + 1, colours[(k + 2) % 3]);
        if (Source::of(job).dilation != Dilation::centre) {
            fillGuides<Source>(job, tile, y, guides);
        }
        const Rows rows{{&colours[k % 3], &colours[(k + 1) % 3], &colours[(k + 2) % 3]}};
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            resolveGroup<Source>(job, tile, rows, guides, x, y);
        }
    }
    fillMargin(job, tile);
}

template <size_t... kIndices>
TileKernel presetKernel(const TaaPolicy& policy, std::index_sequence<kIndices...>) {
    TileKernel kernel = resolveTile<AnyPolicy>;
    ((kernel = policy == Preset<kIndices>::kPolicy ? resolveTile<Preset<kIndices>> : kernel), ...);
    return kernel;
}

TileKernel kernelHere(const TaaPolicy& policy) {
    return presetKernel(policy, std::make_index_sequence<kCompiledPresets>());
}

}  // namespace HWY_NAMESPACE
}  // namespace still::lab
HWY_AFTER_NAMESPACE();
