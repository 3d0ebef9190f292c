#include "rasterizer/light_sampler.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/light_setup.h"
#include "rasterizer/internal/screen_occlusion.h"
#include "rasterizer/internal/shading_constants.h"
#include "rasterizer/internal/sun_map.h"

namespace still {

using namespace internal;

namespace {

/// Pixels of a batch lie together, so that their rays take similar ways.
constexpr int kBlock = 8;
static_assert(kBlock * kBlock == kLightBatch && kTileSize % kBlock == 0);

/// One sample of a block of pixels, for the next frame.
struct KeptSample {
    Float3 origin{}, normal{};  ///< of a LitPoint
    uint32_t sample = 0;
    uint16_t x = 0, y = 0;
    uint16_t surface = 0;  ///< 0: none
    uint16_t direct = 0, indirect = 0;
};

struct Rgb16 {
    uint16_t r, g, b;
};

Rgb16 rounded(const Float3& c) {
    return {toFx12(c.x), toFx12(c.y), toFx12(c.z)};
}

/// Rec. 709; the weights are in 1/65536.
uint16_t luminanceOf(const Rgb16& c) {
    return uint16_t(
        roundShift(uint32_t{c.r} * 13933u + uint32_t{c.g} * 46871u + uint32_t{c.b} * 4732u, 16));
}

void addTo(uint16_t& plane, float linear) {
    plane = uint16_t(std::min<uint32_t>(plane + toFx12(linear), 65535));
}

/// Which pixel of a block is kept: another one in each frame.
uint32_t keptPixel(uint32_t block_x, uint32_t block_y, uint32_t sample) {
    uint32_t h = block_x * kHashX ^ block_y * kHashY;
    h ^= h >> 15;
    h *= kHashMix;
    h = (h ^ h >> 12) + sample * kGoldenRatio;
    return uint32_t(uint64_t{h} * (kLightBlock * kLightBlock) >> 32);
}

}  // namespace

void LightImages::resize(int width, int height) {
    for (Image<uint16_t>* plane : {&direct_red, &direct_green, &direct_blue, &indirect_red,
                                   &indirect_green, &indirect_blue}) {
        plane->resize(width, height);
    }
}

void LightChangeImages::resize(int width, int height) {
    for (Image<uint16_t>* plane : {&direct_before, &direct_now, &indirect_before, &indirect_now}) {
        plane->resize((width + kLightBlock - 1) / kLightBlock,
                      (height + kLightBlock - 1) / kLightBlock);
    }
}

struct LightSampler::State {
    /// What a worker needs.
    struct Scratch {
        LightBatch batch, hits;
        uint16_t x[kLightBatch], y[kLightBatch], surface[kLightBatch];
    };

    LightScene scene;
    TreeKeeper trees;
    std::unique_ptr<SunMap> sun_map;
    ScreenOcclusion screen;
    PixelNumbers numbers;
    const FrameView* view = nullptr;
    std::vector<Scratch> scratch;

    // Of the frame that was sampled last.
    int kept_width = 0, kept_height = 0;  ///< 0: nothing was kept
    std::vector<KeptSample> kept;         ///< of each block, row by row
    LightState kept_light;
    std::vector<Carry> carries;

    int blocksAcross() const { return (kept_width + kLightBlock - 1) / kLightBlock; }
    void draw(LightBatch& batch, int i, int x, int y, const PixelNumbers::Tile& tile) const;
    void collect(const GBuffer& gbuffer, const PixelRays& pixels, const PixelNumbers::Tile& tile,
                 int x0, int y0, Scratch& s) const;
    void store(GBuffer& gbuffer, LightImages& out, int x0, int y0, bool keep, const Scratch& s);
    KeptSample* keptAt(int x, int y);
    void clearBlock(LightImages& out, int x0, int y0, int x1, int y1, bool keep);
    void keepSample(const Scratch& s, int i, const Rgb16& direct, const Rgb16& indirect);
    void traceAgain(int begin, int end, LightChangeImages& out, Scratch& s) const;
    void forgetKept(Workers& workers);
    LitPoint carried(const KeptSample& sample) const;
};

LightSampler::LightSampler() : state_(std::make_unique<State>()) {}
LightSampler::~LightSampler() = default;
LightSampler::LightSampler(LightSampler&&) noexcept = default;
LightSampler& LightSampler::operator=(LightSampler&&) noexcept = default;

void LightSampler::setUp(const DrawList& list, const FrameView& view, SimdTarget simd,
                         Workers& workers) {
    State& s = *state_;
    s.view = &view;
    setUpLights(list, s.scene);
    s.scene.trace = traceFor(simd);
    if (traces(list.lighting.sampled)) {
        s.trees.update(list, s.scene.tree, workers);
    }
    if (list.lighting.sampled.sun_shadow == SunShadow::mapped) {
        if (s.sun_map == nullptr) {
            s.sun_map = std::make_unique<SunMap>();
        }
        s.sun_map->update(list, std::max(view.width, view.height), simd, workers);
        s.scene.sun_map = s.sun_map.get();
    }
    s.scratch.resize(size_t(workers.threads()));
}

// ---- sampling --------------------------------------------------------------------------------

void LightSampler::State::draw(LightBatch& batch, int i, int x, int y,
                               const PixelNumbers::Tile& tile) const {
    for (uint32_t uses = scene.random_uses; uses != 0; uses &= uses - 1) {
        const int use = std::countr_zero(uses);
        batch.random[use][i] = tile.at(x, y, RandomUse(use));
    }
}

/// The surface points of a block's pixels, of each quarter together: then their rays are, too.
void LightSampler::State::collect(const GBuffer& gbuffer, const PixelRays& pixels,
                                  const PixelNumbers::Tile& tile, int x0, int y0,
                                  Scratch& s) const {
    LightBatch& batch = s.batch;
    batch.count = 0;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const int qx = x0 + quarter % 2 * kBlock / 2, qy = y0 + quarter / 2 * kBlock / 2;
        for (int i = 0; i < kLightBatch / 4; ++i) {
            const int x = qx + i % (kBlock / 2), y = qy + i / (kBlock / 2);
            if (x >= gbuffer.width() || y >= gbuffer.height()) {
                continue;
            }
            const uint16_t surface = gbuffer.id.at(x, y) & kSurfaceMask;
            if (surface == 0) {
                continue;
            }
            const int p = batch.count++;
            s.x[p] = uint16_t(x);
            s.y[p] = uint16_t(y);
            s.surface[p] = surface;
            const NormalVector n = decodeOctahedral(gbuffer.normal.at(x, y));
            batch.points[p] = pixels.pointAt(x, y, std::bit_cast<float>(gbuffer.depth.at(x, y)),
                                             normalized({n.x, n.y, n.z}));
            batch.points[p].shininess = scene.surfaces[surface].shininess;
            draw(batch, p, x, y, tile);
        }
    }
}

/// Where the kept sample of a pixel's block belongs; null if it is another pixel's.
KeptSample* LightSampler::State::keptAt(int x, int y) {
    const int block_x = x / kLightBlock, block_y = y / kLightBlock;
    const int in_block = y % kLightBlock * kLightBlock + x % kLightBlock;
    return uint32_t(in_block) == keptPixel(uint32_t(block_x), uint32_t(block_y), view->sample)
               ? &kept[size_t(block_y) * size_t(blocksAcross()) + size_t(block_x)]
               : nullptr;
}

void LightSampler::State::keepSample(const Scratch& s, int i, const Rgb16& direct,
                                     const Rgb16& indirect) {
    if (KeptSample* to = keptAt(s.x[i], s.y[i]); to != nullptr) {
        *to = {.origin = s.batch.points[i].origin,
               .normal = s.batch.points[i].normal,
               .sample = view->sample,
               .x = s.x[i],
               .y = s.y[i],
               .surface = s.surface[i],
               .direct = luminanceOf(direct),
               .indirect = luminanceOf(indirect)};
    }
}

/// A block with pixels that no surface is in: no light, and nothing to be kept.
void LightSampler::State::clearBlock(LightImages& out, int x0, int y0, int x1, int y1, bool keep) {
    for (Image<uint16_t>* plane : {&out.direct_red, &out.direct_green, &out.direct_blue,
                                   &out.indirect_red, &out.indirect_green, &out.indirect_blue}) {
        for (int y = y0; y < y1; ++y) {
            std::fill(&plane->at(x0, y), &plane->at(x0, y) + (x1 - x0), uint16_t{0});
        }
    }
    for (int y = y0; y < y1 && keep; ++y) {
        for (int x = x0; x < x1; ++x) {
            if (KeptSample* sample = keptAt(x, y); sample != nullptr) {
                sample->surface = 0;
            }
        }
    }
}

void LightSampler::State::store(GBuffer& gbuffer, LightImages& out, int x0, int y0, bool keep,
                                const Scratch& s) {
    const int x1 = std::min(x0 + kBlock, gbuffer.width());
    const int y1 = std::min(y0 + kBlock, gbuffer.height());
    if (s.batch.count < (x1 - x0) * (y1 - y0)) {
        clearBlock(out, x0, y0, x1, y1, keep);
    }
    const bool on_screen = scene.list->lighting.sampled.ambient == AmbientLight::screen_occlusion;
    for (int i = 0; i < s.batch.count; ++i) {
        const int x = s.x[i], y = s.y[i];
        const Rgb16 direct = rounded(s.batch.direct[i]);
        const Float3 ambient = s.batch.indirect[i];
        const Rgb16 indirect =
            rounded(on_screen ? scale(ambient, screen.openAt(gbuffer, x, y)) : ambient);
        out.direct_red.at(x, y) = direct.r;
        out.direct_green.at(x, y) = direct.g;
        out.direct_blue.at(x, y) = direct.b;
        out.indirect_red.at(x, y) = indirect.r;
        out.indirect_green.at(x, y) = indirect.g;
        out.indirect_blue.at(x, y) = indirect.b;
        if (s.batch.points[i].shininess > 0) {
            const Float3& specular = scene.surfaces[s.surface[i]].specular;
            addTo(gbuffer.red.at(x, y), specular.x * s.batch.highlight[i].x);
            addTo(gbuffer.green.at(x, y), specular.y * s.batch.highlight[i].y);
            addTo(gbuffer.blue.at(x, y), specular.z * s.batch.highlight[i].z);
        }
        if (keep) {
            // What is seen where nothing else was is not known of another frame.
            keepSample(s, i, direct, on_screen ? rounded(ambient) : indirect);
        }
    }
}

/// Of a block that the picture's border cuts, the pixel to be kept may lie outside, and what was
/// kept before would stay.
void LightSampler::State::forgetKept(Workers& workers) {
    workers.parallelFor(int(kept.size()), 8192, [&](int begin, int end, int) {
        for (size_t i = size_t(begin); i < size_t(end); ++i) {
            kept[i].surface = 0;
        }
    });
}

void LightSampler::sample(GBuffer& gbuffer, LightImages& out, bool keep, Workers& workers) {
    State& state = *state_;
    const FrameView& view = *state.view;
    assert(gbuffer.planes.normal && gbuffer.width() == view.width);
    out.resize(view.width, view.height);
    const bool same_size = state.kept_width == view.width && state.kept_height == view.height;
    state.kept_width = keep ? view.width : 0;
    state.kept_height = keep ? view.height : 0;
    if (keep) {
        state.kept_light.take(*state.scene.list);
        const size_t rows = size_t((view.height + kLightBlock - 1) / kLightBlock);
        if (!same_size) {
            state.kept.assign(rows * size_t(state.blocksAcross()), {});
        }
        state.forgetKept(workers);
    }
    const SampledLight& sampled = state.scene.list->lighting.sampled;
    if (sampled.ambient == AmbientLight::screen_occlusion) {
        state.screen.find(gbuffer, view, sampled.occlusion_distance, state.numbers, workers);
    }
    const PixelRays pixels(view);
    const SampleNumbers sample = numbersOfSample(view.sample);
    const int tiles_x = (view.width + kTileSize - 1) / kTileSize;
    const int tiles_y = (view.height + kTileSize - 1) / kTileSize;
    workers.parallelFor(tiles_x * tiles_y, 1, [&](int begin, int end, int worker) {
        State::Scratch& scratch = state.scratch[size_t(worker)];
        for (int tile = begin; tile < end; ++tile) {
            const int x0 = tile % tiles_x * kTileSize, y0 = tile / tiles_x * kTileSize;
            const PixelNumbers::Tile random = state.numbers.tileOf(x0, y0, sample);
            for (int y = y0; y < std::min(y0 + kTileSize, view.height); y += kBlock) {
                for (int x = x0; x < std::min(x0 + kTileSize, view.width); x += kBlock) {
                    state.collect(gbuffer, pixels, random, x, y, scratch);
                    lightBatch(state.scene, scratch.batch, scratch.hits);
                    state.store(gbuffer, out, x, y, keep, scratch);
                }
            }
        }
    });
}

// ---- change ----------------------------------------------------------------------------------

/// Where the sample's surface is now.
LitPoint LightSampler::State::carried(const KeptSample& sample) const {
    LitPoint point{.origin = sample.origin, .normal = sample.normal};
    const Carry& carry = carries[scene.surfaces[sample.surface].instance];
    if (carry.moved) {
        point.origin = transformPoint(carry.points, point.origin);
        point.normal = normalized(rotate(carry.normals, point.normal));
    }
    return point;
}

void LightSampler::State::traceAgain(int begin, int end, LightChangeImages& out, Scratch& s) const {
    LightBatch& batch = s.batch;
    batch.count = 0;
    int block[kLightBatch];
    const int across = blocksAcross();
    SampleNumbers numbers_then;
    uint32_t numbers_of = 0;
    for (int b = begin; b < end; ++b) {
        const KeptSample& sample = kept[size_t(b)];
        const int x = b % across, y = b / across;
        out.direct_before.at(x, y) = out.direct_now.at(x, y) = 0;
        out.indirect_before.at(x, y) = out.indirect_now.at(x, y) = 0;
        if (sample.surface == 0) {
            continue;
        }
        if (batch.count == 0 || numbers_of != sample.sample) {
            numbers_then = numbersOfSample(sample.sample);
            numbers_of = sample.sample;
        }
        block[batch.count] = b;
        batch.points[batch.count] = carried(sample);
        draw(batch, batch.count++, sample.x, sample.y,
             numbers.tileOf(sample.x, sample.y, numbers_then));
    }
    lightBatch(scene, batch, s.hits);
    for (int i = 0; i < batch.count; ++i) {
        const KeptSample& sample = kept[size_t(block[i])];
        const int x = block[i] % across, y = block[i] / across;
        out.direct_before.at(x, y) = sample.direct;
        out.indirect_before.at(x, y) = sample.indirect;
        out.direct_now.at(x, y) = luminanceOf(rounded(batch.direct[i]));
        out.indirect_now.at(x, y) = luminanceOf(rounded(batch.indirect[i]));
    }
}

bool LightSampler::changes(LightChangeImages& out, Workers& workers) {
    State& state = *state_;
    const DrawList& list = *state.scene.list;
    const bool moved = std::any_of(list.instances.begin(), list.instances.end(),
                                   [](const Instance& instance) { return instance.moved; });
    if (state.kept_width == 0 || (!moved && state.kept_light.same(list))) {
        return false;
    }
    state.carries.clear();
    for (const Instance& instance : list.instances) {
        state.carries.push_back(carryOf(instance));
    }
    out.resize(state.kept_width, state.kept_height);
    workers.parallelFor(int(state.kept.size()), kLightBatch, [&](int begin, int end, int worker) {
        state.traceAgain(begin, end, out, state.scratch[size_t(worker)]);
    });
    return true;
}

}  // namespace still
