// Planes of visible triangles for shading, one triangle per lane; see makeShadeTriangle() for the
// truth. Included once per target by kernels_simd.cpp.

HWY_BEFORE_NAMESPACE();
namespace still::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

void prepareShading(TileContext& tile) {
    referenceKernels().prepareShading(tile);
}

#else

/// Notes in `seen` which triangles have a pixel (from index 1: 0 is for nothing) and counts pixels.
/// Of neighbours that show the same triangle only the last one is looked at.
HWY_INLINE void markSeen(TileContext& tile) {
    constexpr int kLanes = int(hn::MaxLanes(UTag()));
    std::fill_n(tile.seen, tile.triangle_count + 1, uint8_t{0});
    for (int y = 0; y < tile.height; ++y) {
        const uint32_t* row = tile.visible + y * kTileSize;
        for (int x = 0; x < tile.width; x += kLanes) {
            const UVec here = hn::LoadU(UTag(), row + x), next = hn::LoadU(UTag(), row + x + 1);
            const int rest = tile.width - x;
            const uint32_t valid = rest < kLanes ? (1u << rest) - 1u : (1u << kLanes) - 1u;
            const UVec nothing = hn::Set(UTag(), kNothingVisible);
            const uint32_t shown = maskBits(hn::RebindMask(ITag(), hn::Ne(here, nothing))) & valid;
            uint32_t ends = maskBits(hn::RebindMask(ITag(), hn::Ne(here, next))) & valid;
            if (rest <= kLanes) {
                ends |= 1u << (rest - 1);
            }
            tile.pixels_shaded += uint32_t(std::popcount(shown));
            for (; ends != 0; ends &= ends - 1) {
                tile.seen[row[x + std::countr_zero(ends)] + 1u] = 1;
            }
        }
    }
}

/// Narrow triangles that wait for their planes.
struct alignas(64) ShadeBatch {
    const uint32_t* vertex[kBatch];  ///< of the three corners
    float inv_w[3][kBatch];
    int32_t surface[kBatch];
    float flip[kBatch];
    uint32_t index[kBatch];
    int count = 0;
};

/// Values and steps of p_k = λ_k / w_k for half a batch; `e` are the edges opposite to the vertices
/// at the anchor and their steps.
struct PlaneLanes {
    float value[3][kBatch], dx[3][kBatch], dy[3][kBatch];
};

template <class Half>
HWY_INLINE void shadePlanes(Half half, const BVec e[3], const BVec e_dx[3], const BVec e_dy[3],
                            const ShadeBatch& batch, PlaneLanes& out, int at) {
    const BDTag d;
    const hn::Rebind<float, BDTag> df;
    BDVec value[3];
    for (int k = 0; k < 3; ++k) {
        value[k] = hn::PromoteTo(d, half(e[k]));
    }
    const BDVec area2 = hn::Add(hn::Add(value[0], value[1]), value[2]);
    for (int k = 0; k < 3; ++k) {
        const BDVec inv_w = hn::PromoteTo(d, hn::Load(df, batch.inv_w[k] + at));
        const BDVec scale = hn::Div(inv_w, area2);
        // Adding 0 turns −0 into 0, as the sum over the corners does.
        const auto store = [&](BDVec v, float* to) {
            hn::Store(hn::DemoteTo(df, hn::Add(hn::Mul(v, scale), hn::Zero(d))), df, to + at);
        };
        store(value[k], out.value[k]);
        store(hn::PromoteTo(d, half(e_dx[k])), out.dx[k]);
        store(hn::PromoteTo(d, half(e_dy[k])), out.dy[k]);
    }
}

HWY_INLINE void flush(TileContext& tile, ShadeBatch& batch) {
    const BTag d;
    const BFTag df;
    for (int lane = batch.count; lane < kBatch; ++lane) {
        batch.index[lane] = tile.triangle_count;  // behind the last one
    }
    const int count = batch.count;
    batch.count = 0;
    const int32_t* words = reinterpret_cast<const int32_t*>(tile.triangles);
    BVec word[8];
    loadTransposed([&](int lane) { return words + batch.index[lane] * kTriangleWords; }, word);
    loadTransposed([&](int lane) { return words + batch.index[lane] * kTriangleWords + 4; },
                   word + 4);
    // Back in the order of the mesh. Both the edges and the area change their signs, so that no
    // quotient does.
    const auto swapped = hn::Ne(hn::And(word[7], hn::Set(d, int32_t{kSwapped})), hn::Zero(d));
    const BVec corner[3] = {word[0], hn::IfThenElse(swapped, word[2], word[1]),
                            hn::IfThenElse(swapped, word[1], word[2])};
    BVec x[3], y[3];
    for (int k = 0; k < 3; ++k) {
        x[k] = hn::ShiftRight<16>(hn::ShiftLeft<16>(corner[k]));
        y[k] = hn::ShiftRight<16>(corner[k]);
    }
    const BVec byte = hn::Set(d, 0xFF);
    const BVec anchor_x = hn::And(word[6], byte);
    const BVec anchor_y = hn::And(hn::ShiftRight<8>(word[6]), byte);
    const BVec ax = hn::ShiftLeft<kSubpixelBits>(anchor_x);
    const BVec ay = hn::ShiftLeft<kSubpixelBits>(anchor_y);
    BVec e[3], e_dx[3], e_dy[3];
    for (int k = 0; k < 3; ++k) {
        const int i = k == 2 ? 0 : k + 1;
        const int j = i == 2 ? 0 : i + 1;
        const BVec ex = hn::Sub(x[j], x[i]), ey = hn::Sub(y[j], y[i]);
        e[k] = hn::Sub(hn::Mul(ex, hn::Sub(ay, y[i])), hn::Mul(ey, hn::Sub(ax, x[i])));
        e_dx[k] = hn::Neg(hn::ShiftLeft<kSubpixelBits>(ey));
        e_dy[k] = hn::ShiftLeft<kSubpixelBits>(ex);
    }
    alignas(64) PlaneLanes planes;
    constexpr int kHalf = kBatch / 2;
    shadePlanes([](BVec v) { return hn::LowerHalf(BHalf(), v); }, e, e_dx, e_dy, batch, planes, 0);
    shadePlanes([](BVec v) { return hn::UpperHalf(BHalf(), v); }, e, e_dx, e_dy, batch, planes,
                kHalf);

    const auto plane = [&](const float* from) { return hn::BitCast(d, hn::Load(df, from)); };
    const auto asFloat = [&](BVec v) { return hn::BitCast(d, hn::ConvertTo(df, v)); };
    BVec out[3][4] = {
        {plane(planes.value[0]), plane(planes.value[1]), plane(planes.value[2]), asFloat(anchor_x)},
        {plane(planes.dx[0]), plane(planes.dx[1]), plane(planes.dx[2]), asFloat(anchor_y)},
        {plane(planes.dy[0]), plane(planes.dy[1]), plane(planes.dy[2]), plane(batch.flip)}};
    int32_t* shade = reinterpret_cast<int32_t*>(tile.shade);
    constexpr int kShadeWords = sizeof(ShadeTriangle) / sizeof(int32_t);
    for (int quad = 0; quad < 3; ++quad) {
        storeTransposed(out[quad], [&](int lane) {
            return shade + size_t(batch.index[lane]) * kShadeWords + 4 * quad;
        });
    }
    for (int lane = 0; lane < count; ++lane) {
        ShadeTriangle& triangle = tile.shade[batch.index[lane]];
        triangle.surface = batch.surface[lane];
        copyAttributes(tile.frame->surfaces[batch.surface[lane]], batch.vertex[lane], triangle);
    }
}

void prepareShading(TileContext& tile) {
    markSeen(tile);
    ShadeBatch batch{};
    for (const TileRun* run = tile.runs; run->chunk != nullptr; ++run) {
        const Chunk& chunk = *run->chunk;
        const Surface& s = tile.frame->surfaces[chunk.surface];
        const InstanceSetup& instance = tile.frame->instances[s.instance];
        for (uint32_t i = run[0].begin; i < run[1].begin; ++i) {
            if (tile.seen[i + 1] == 0) {
                continue;
            }
            tile.features |= s.features;
            const uint32_t id = tile.triangles[i].id;
            if (tile.shade_ready[i] != 0 || (id & kWide) != 0) {
                prepareTriangle(tile, chunk, i);
                continue;
            }
            const uint32_t triangle = chunk.first + (id & kTriangleMask);
            const uint32_t* index = s.indices + size_t(triangle) * 3;
            const int lane = batch.count++;
            for (int k = 0; k < 3; ++k) {
                batch.inv_w[k][lane] = chunk.vertices[index[k]].inv_w;
            }
            batch.vertex[lane] = index;
            batch.surface[lane] = chunk.surface;
            batch.flip[lane] = shadingFlip(s, instance, triangle, (id & kSwapped) != 0);
            batch.index[lane] = i;
            if (batch.count == kBatch) {
                flush(tile, batch);
            }
        }
    }
    if (batch.count > 0) {
        flush(tile, batch);
    }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace still::internal
HWY_AFTER_NAMESPACE();
