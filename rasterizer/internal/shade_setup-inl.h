// Records of visible triangles for shading, one triangle per lane; see makeShadeTriangle() for the
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
            const uint32_t shown = maskBits(UTag(), hn::Ne(here, nothing)) & valid;
            uint32_t ends = maskBits(UTag(), hn::Ne(here, next)) & valid;
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

/// Narrow triangles that wait for their records, and what is collected of them one by one.
struct alignas(64) ShadeBatch {
    float inv_w[3][kBatch];
    float v[3][kBatch];
    float flip[kBatch];
    float handedness[kBatch];
    int32_t surface[kBatch];
    const float* attributes[3][kBatch];
    uint32_t index[kBatch];
    int count = 0;
};

/// What is computed in double, half a batch after the other.
struct alignas(64) PlaneLanes {
    float value[3][kBatch], dx[3][kBatch], dy[3][kBatch];
};

/// Values and steps of p_k = λ_k / w_k; `e` are the edges opposite to the vertices at the anchor
/// and their steps.
template <class Half>
HWY_INLINE void shadePlanes(Half half, const BVec e[3], const BVec e_dx[3], const BVec e_dy[3],
                            const ShadeBatch& batch, PlaneLanes& out, int at) {
    const BDTag d;
    const hn::Rebind<float, BDTag> df;
    BDVec value[3];
    for (int k = 0; k < 3; ++k) {
        value[k] = toDoubles(d, half(e[k]));
    }
    const BDVec area2 = add(add(value[0], value[1]), value[2]);
    for (int k = 0; k < 3; ++k) {
        const BDVec inv_w = toDoubles(d, hn::Load(df, batch.inv_w[k] + at));
        const BDVec scale = div(inv_w, area2);
        // Adding 0 turns −0 into 0, as the sum over the corners does.
        const auto store = [&](BDVec v, float* to) {
            hn::Store(toFloats(df, add(mul(v, scale), doubles(d, 0.0))), df, to + at);
        };
        store(value[k], out.value[k]);
        store(toDoubles(d, half(e_dx[k])), out.dx[k]);
        store(toDoubles(d, half(e_dy[k])), out.dy[k]);
    }
}

HWY_INLINE void flush(TileContext& tile, ShadeBatch& batch) {
    const BTag d;
    const BFTag df;
    for (int lane = batch.count; lane < kBatch; ++lane) {
        batch.index[lane] = tile.triangle_count;  // behind the last one
    }
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
    BVec normal[3][3], u[3];
    for (int k = 0; k < 3; ++k) {
        BVec attribute[4];
        loadTransposed(
            [&](int lane) { return reinterpret_cast<const int32_t*>(batch.attributes[k][lane]); },
            attribute);
        for (int i = 0; i < 3; ++i) {
            normal[i][k] = attribute[i];
        }
        u[k] = attribute[3];
    }
    PlaneLanes planes;
    const auto low = [](BVec v) { return hn::LowerHalf(BHalf(), v); };
    const auto high = [](BVec v) { return hn::UpperHalf(BHalf(), v); };
    shadePlanes(low, e, e_dx, e_dy, batch, planes, 0);
    shadePlanes(high, e, e_dx, e_dy, batch, planes, kBatch / 2);

    int32_t* shade = reinterpret_cast<int32_t*>(tile.shade);
    constexpr int kWords = sizeof(ShadeTriangle) / sizeof(int32_t);
    const auto storeQuad = [&](int quad, BVec w0, BVec w1, BVec w2, BVec w3) {
        BVec words_of_lanes[4] = {w0, w1, w2, w3};
        storeTransposed(words_of_lanes, [&](int lane) {
            return shade + size_t(batch.index[lane]) * kWords + quad * 4;
        });
    };
    const auto load = [&](const float* from) { return hn::BitCast(d, hn::Load(df, from)); };
    const auto asFloat = [&](BVec v) { return hn::BitCast(d, hn::ConvertTo(df, v)); };
    const auto sum3 = [&](const BVec f[3], const float(*slope)[kBatch]) {
        const auto term = [&](int k) {
            return hn::Mul(hn::BitCast(df, f[k]), hn::Load(df, slope[k]));
        };
        return hn::BitCast(d, hn::Add(hn::Add(term(0), term(1)), term(2)));
    };
    const auto sum = [&](const float(*slope)[kBatch]) {
        return hn::BitCast(d, hn::Add(hn::Add(hn::Load(df, slope[0]), hn::Load(df, slope[1])),
                                      hn::Load(df, slope[2])));
    };
    const BVec v[3] = {load(batch.v[0]), load(batch.v[1]), load(batch.v[2])};
    const auto& p = planes;
    storeQuad(shading::kQuadP, load(p.value[0]), load(p.value[1]), load(p.value[2]),
              asFloat(anchor_x));
    storeQuad(shading::kQuadDx, load(p.dx[0]), load(p.dx[1]), load(p.dx[2]), asFloat(anchor_y));
    storeQuad(shading::kQuadDy, load(p.dy[0]), load(p.dy[1]), load(p.dy[2]), load(batch.flip));
    storeQuad(shading::kQuadU, u[0], u[1], u[2], sum(p.dx));
    storeQuad(shading::kQuadV, v[0], v[1], v[2], sum(p.dy));
    storeQuad(shading::kQuadSlopes, sum3(u, p.dx), sum3(u, p.dy), sum3(v, p.dx), sum3(v, p.dy));
    storeQuad(shading::kQuadNormal, normal[0][0], normal[0][1], normal[0][2],
              load(batch.handedness));
    storeQuad(shading::kQuadNormal + 1, normal[1][0], normal[1][1], normal[1][2],
              hn::Load(d, batch.surface));
    storeQuad(shading::kQuadNormal + 2, normal[2][0], normal[2][1], normal[2][2], hn::Zero(d));
}

/// Takes note of triangle `i` of the tile, which is `triangle` in its mesh.
HWY_INLINE void collect(TileContext& tile, const Chunk& chunk, const Surface& s, uint32_t i,
                        uint32_t triangle, ShadeBatch& batch) {
    const uint32_t* index = s.indices + size_t(triangle) * 3;
    const int lane = batch.count++;
    for (int k = 0; k < 3; ++k) {
        const float* attributes = s.attributes + size_t(index[k]) * kAttributeStride;
        batch.attributes[k][lane] = attributes;
        batch.v[k][lane] = attributes[4];
        batch.inv_w[k][lane] = chunk.vertices[index[k]].inv_w;
    }
    batch.flip[lane] = shadingFlip(s, tile.frame->instances[s.instance], triangle,
                                   (tile.triangles[i].id & kSwapped) != 0);
    batch.handedness[lane] = handednessOf(s, index);
    batch.surface[lane] = chunk.surface;
    batch.index[lane] = i;
    copyExtras(s, index, tile.shade[i]);
    if (batch.count == kBatch) {
        flush(tile, batch);
    }
}

void prepareShading(TileContext& tile) {
    markSeen(tile);
    ShadeBatch batch{};
    static constexpr float kNone[kAttributeStride] = {};
    for (auto& attributes : batch.attributes) {
        std::fill_n(attributes, kBatch, kNone);
    }
    for (const TileRun* run = tile.runs; run->chunk != nullptr; ++run) {
        const Chunk& chunk = *run->chunk;
        const Surface& s = tile.frame->surfaces[chunk.surface];
        for (uint32_t i = run[0].begin; i < run[1].begin; ++i) {
            if (tile.seen[i + 1] == 0) {
                continue;
            }
            tile.features |= s.features;
            const uint32_t id = tile.triangles[i].id;
            if (tile.shade_ready[i] != 0 || (id & kWide) != 0) {
                prepareTriangle(tile, chunk, i);
            } else {
                collect(tile, chunk, s, i, chunk.first + (id & kTriangleMask), batch);
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
