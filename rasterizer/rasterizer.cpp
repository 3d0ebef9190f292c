#include "rasterizer/rasterizer.h"

#include <cassert>
#include <vector>

#include "rasterizer/internal/overdraw.h"
#include "rasterizer/internal/tile.h"

namespace still {

namespace {

constexpr int kVertexGrain = int(internal::kVertexChunkVertices);

struct VertexChunk {
    uint32_t instance;
    uint32_t begin, end;
};

// rasterizerBytes() does not see these types.
static_assert(sizeof(internal::Surface) <= internal::kSurfaceBytes);
static_assert(sizeof(internal::InstanceSetup) <= internal::kInstanceBytes);
static_assert(sizeof(internal::VertexJob) <= internal::kVertexJobBytes);
static_assert(sizeof(internal::ScreenVertex) == internal::kVertexBytes);
static_assert(sizeof(VertexChunk) == internal::kVertexChunkBytes);
static_assert(sizeof(internal::ChunkInput) <= internal::kChunkInputBytes);
static_assert(sizeof(internal::Chunk) <= internal::kChunkBytes);
static_assert(sizeof(internal::TileRect) == internal::kChunkRectBytes);
static_assert(sizeof(internal::TileTriangle) == internal::kRecordBytes);
static_assert(sizeof(internal::SetupTriangle) == internal::kWideBytes);
static_assert(sizeof(internal::ClipBarycentrics) == internal::kClipBytes);
static_assert(sizeof(internal::BinScratch::Entry) == internal::kEntryBytes);
static_assert(sizeof(internal::PixelBox) == internal::kWideBoxBytes);
static_assert(sizeof(internal::BinScratch) <= internal::kBinScratchBytes);
static_assert(sizeof(internal::TileScratch) <= internal::kTileScratchBytes);
static_assert(sizeof(internal::TileRun) <= internal::kTileRunBytes);
static_assert(sizeof(internal::ShadeTriangle) == internal::kShadeBytes);
static_assert(internal::kMaxBatch == internal::kSpareRecords);

}  // namespace

struct Rasterizer::State {
    internal::FrameSetup setup;
    RasterSettings settings;
    RasterCounters counters;
    internal::Buffer<internal::ScreenVertex> vertices;  ///< of all instances, one after the other
    std::vector<VertexChunk> vertex_chunks;
    std::vector<internal::ChunkInput> inputs;
    internal::FrameBins bins;
    std::vector<std::unique_ptr<internal::BinScratch>> bin_scratch;
    std::vector<std::unique_ptr<internal::TileScratch>> scratch;

    void cutVertices(const DrawList& list) {
        internal::ScreenVertex* const out = vertices.reserve(setup.vertex_count);
        vertex_chunks.clear();
        for (uint32_t i = 0; i < list.instances.size(); ++i) {
            setup.vertex_jobs[i].out = out + setup.first_vertex[i];
            const uint32_t count = list.meshes[list.instances[i].mesh].vertexCount();
            for (uint32_t begin = 0; begin < count; begin += kVertexGrain) {
                vertex_chunks.push_back({i, begin, std::min(begin + kVertexGrain, count)});
            }
        }
    }

    void cutTriangles(const DrawList& list) {
        inputs.clear();
        for (uint32_t i = 0; i < list.instances.size(); ++i) {
            const Instance& instance = list.instances[i];
            uint16_t surface = instance.first_surface;
            for (const MeshPart& part : list.meshes[instance.mesh].parts) {
                for (uint32_t done = 0; done < part.triangle_count; done += kChunkTriangles) {
                    inputs.push_back({&setup.surfaces[surface], &setup.vertex_jobs[i],
                                      part.first_triangle + done,
                                      std::min(kChunkTriangles, part.triangle_count - done),
                                      surface});
                }
                ++surface;
            }
        }
        bins.count = inputs.size();
        if (bins.chunks.size() < bins.count) {
            bins.chunks.resize(bins.count);
        }
        bins.rects.resize(bins.count);
    }

    void reserve(const RasterLimits& limits);

    uint64_t now() const { return settings.ticks != nullptr ? settings.ticks() : 0; }

    /// One for each worker, its counters at 0.
    template <class Scratch>
    static void prepare(std::vector<std::unique_ptr<Scratch>>& scratch, int workers) {
        while (scratch.size() < size_t(workers)) {
            scratch.push_back(std::make_unique<Scratch>());
        }
        for (const auto& each : scratch) {
            each->counters = {};
        }
    }

    void transform(const internal::GeometryKernels& kernels, Workers& workers) {
        workers.parallelFor(int(vertex_chunks.size()), 1, [&](int begin, int end, int worker) {
            const uint64_t start = now();
            for (int i = begin; i < end; ++i) {
                const VertexChunk& c = vertex_chunks[size_t(i)];
                kernels.transformVertices(setup.vertex_jobs[c.instance], int(c.begin), int(c.end));
            }
            bin_scratch[size_t(worker)]->counters.ticks.transform += now() - start;
        });
    }

    void bin(const internal::GeometryKernels& kernels, const FrameView& view, Workers& workers) {
        workers.parallelFor(int(inputs.size()), 1, [&](int begin, int end, int worker) {
            const uint64_t start = now();
            internal::BinScratch& mine = *bin_scratch[size_t(worker)];
            for (int i = begin; i < end; ++i) {
                internal::Chunk& chunk = bins.chunks[size_t(i)];
                internal::binChunk(inputs[size_t(i)], view, kernels, mine, chunk);
                bins.rects[size_t(i)] = chunk.rect;
            }
            mine.counters.ticks.bin += now() - start;
        });
    }
};

Rasterizer::Rasterizer() : state_(std::make_unique<State>()) {}
Rasterizer::~Rasterizer() = default;
Rasterizer::Rasterizer(Rasterizer&&) noexcept = default;
Rasterizer& Rasterizer::operator=(Rasterizer&&) noexcept = default;

// What rasterizerBytes() counts, in its order.
void Rasterizer::State::reserve(const RasterLimits& l) {
    const size_t tiles = internal::tileCount(l.width, l.height);
    setup.surfaces.reserve(l.surfaces + 1);
    setup.instances.reserve(l.instances);
    setup.vertex_jobs.reserve(l.instances);
    setup.first_vertex.reserve(l.instances);
    setup.facts.reserve(tiles);
    vertices.reserveExactly(l.vertices);
    vertex_chunks.reserve(l.instances + l.vertices / kVertexGrain);
    inputs.reserve(l.chunks);
    bins.chunks.resize(l.chunks);
    bins.rects.reserve(l.chunks);
    for (internal::Chunk& chunk : bins.chunks) {
        chunk.offsets.reserve(tiles + 1);
        chunk.records.reserveExactly(l.chunk_records);
        chunk.wide.reserve(l.chunk_wide);
        chunk.clips.reserve(l.chunk_wide);
    }
    bin_scratch.reserve(size_t(l.threads));
    scratch.reserve(size_t(l.threads));
    prepare(bin_scratch, l.threads);
    prepare(scratch, l.threads);
    for (const auto& each : bin_scratch) {
        each->entries.reserve(l.chunk_records);
        each->special.reserve(l.chunk_records);
        each->wide_boxes.reserve(l.chunk_wide);
        each->wide_ends.reserve(l.chunk_wide);
    }
    for (const auto& each : scratch) {
        each->runs.reserve(l.chunks + 1);
        each->triangles.reserveExactly(l.tile_triangles + internal::kMaxBatch);
        each->shade.reserveExactly(l.tile_triangles + 1);
        each->shade_ready.reserveExactly(l.tile_triangles);
        each->seen.reserveExactly(l.tile_triangles + 1);
    }
}

void Rasterizer::reserve(const RasterLimits& limits) {
    static_assert(sizeof(State) <= internal::kRasterizerBytes);
    state_->reserve(limits);
}

std::span<const TileFacts> Rasterizer::setUp(const DrawList& list, const FrameView& view,
                                             const RasterSettings& settings) {
    State& s = *state_;
    s.settings = settings;
    internal::setUpFrame(list, view, settings, s.setup);
    return s.setup.facts;
}

void Rasterizer::transformAndBin(const DrawList& list, const FrameView& view,
                                 const RasterSettings& settings, Workers& workers) {
    setUp(list, view, settings);
    transformAndBin(workers);
}

void Rasterizer::transformAndBin(Workers& workers) {
    State& s = *state_;
    const DrawList& list = *s.setup.tables.list;
    s.cutVertices(list);
    s.cutTriangles(list);
    s.prepare(s.bin_scratch, workers.threads());
    const internal::GeometryKernels& kernels = internal::geometryFor(s.settings.simd);
    s.transform(kernels, workers);
    s.bin(kernels, *s.setup.tables.view, workers);
    s.counters = {};
    for (const auto& each : s.bin_scratch) {
        s.counters += each->counters;
    }
}

void Rasterizer::rasterize(GBuffer& out, Workers& workers, std::span<const uint8_t> wanted) {
    State& s = *state_;
    const FrameView& view = *s.setup.tables.view;
    out.resize(view.width, view.height, s.settings.planes);
    s.prepare(s.scratch, workers.threads());
    assert(wanted.empty() || wanted.size() == out.tiles.size());
    out.tiles = s.setup.facts;
    const auto left_out = [&](int tile) { return !wanted.empty() && wanted[size_t(tile)] == 0; };
    workers.parallelFor(int(out.tiles.size()), 1, [&](int begin, int end, int worker) {
        for (int i = begin; i < end; ++i) {
            if (left_out(i)) {
                continue;
            }
            internal::renderTile(s.setup, s.bins, s.settings, i % out.tiles_x, i / out.tiles_x, out,
                                 *s.scratch[size_t(worker)]);
        }
    });
    for (const auto& each : s.scratch) {
        s.counters += each->counters;
    }
}

void Rasterizer::overdraw(ImageView<uint16_t> out, Workers& workers) const {
    const int tiles_x = (out.width + kTileSize - 1) / kTileSize;
    const int tiles_y = (out.height + kTileSize - 1) / kTileSize;
    workers.parallelFor(tiles_x * tiles_y, 1, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            internal::countOverdraw(state_->bins, i % tiles_x, i / tiles_x, out);
        }
    });
}

const RasterCounters& Rasterizer::counters() const {
    return state_->counters;
}

std::vector<SurfaceWork> Rasterizer::surfaceWork() const {
    std::vector<SurfaceWork> works;
    const auto& surfaces = state_->setup.surfaces;
    for (size_t i = 1; i < surfaces.size(); ++i) {
        const internal::Surface& s = surfaces[i];
        const auto has = [&](internal::ShadeFeature feature) {
            return (s.features & feature) != 0;
        };
        works.push_back({.textured = has(internal::kShadeTexture),
                         .normal_mapped = has(internal::kShadeNormalMap),
                         .parallax = has(internal::kShadeHeightMap),
                         .positioned = has(internal::kShadePosition),
                         .alpha_tested = s.material->alpha_mode == AlphaMode::test,
                         .stochastic = s.material->alpha_mode == AlphaMode::stochastic,
                         .kernel = internal::shadeLevel(s.features)});
    }
    return works;
}

}  // namespace still
