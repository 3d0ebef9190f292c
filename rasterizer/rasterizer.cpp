#include "rasterizer/rasterizer.h"

#include <vector>

#include "rasterizer/internal/tile.h"

namespace still {

namespace {

constexpr int kVertexGrain = 2048;

/// Transformed vertices of all instances, one after the other. Not initialised between frames.
struct VertexArrays {
    std::vector<int32_t> x_fx8, y_fx8;
    std::vector<float> z, inv_w;
    std::vector<uint8_t> outcode;

    void resize(size_t count) {
        if (x_fx8.size() < count) {
            x_fx8.resize(count);
            y_fx8.resize(count);
            z.resize(count);
            inv_w.resize(count);
            outcode.resize(count);
        }
    }
};

struct VertexChunk {
    uint32_t instance;
    uint32_t begin, end;
};

}  // namespace

struct Rasterizer::State {
    internal::FrameSetup setup;
    RasterSettings settings;
    RasterCounters counters;
    VertexArrays vertices;
    std::vector<VertexChunk> vertex_chunks;
    std::vector<internal::ChunkInput> inputs;
    std::vector<internal::Chunk> chunks;  ///< the first inputs.size() are in use
    std::vector<std::unique_ptr<internal::TileScratch>> scratch;

    void cutVertices(const DrawList& list) {
        vertices.resize(setup.vertex_count);
        vertex_chunks.clear();
        for (uint32_t i = 0; i < list.instances.size(); ++i) {
            const size_t first = setup.first_vertex[i];
            setup.vertex_jobs[i].out = {vertices.x_fx8.data() + first,
                                        vertices.y_fx8.data() + first, vertices.z.data() + first,
                                        vertices.inv_w.data() + first,
                                        vertices.outcode.data() + first};
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
                for (uint32_t done = 0; done < part.triangle_count;
                     done += internal::kChunkTriangles) {
                    inputs.push_back(
                        {&setup.surfaces[surface], surface, part.first_triangle + done,
                         std::min(internal::kChunkTriangles, part.triangle_count - done),
                         setup.vertex_jobs[i]});
                }
                ++surface;
            }
        }
        if (chunks.size() < inputs.size()) {
            chunks.resize(inputs.size());
        }
    }

    uint64_t now() const { return settings.ticks != nullptr ? settings.ticks() : 0; }

    void prepareScratch(int workers) {
        while (scratch.size() < size_t(workers)) {
            scratch.push_back(std::make_unique<internal::TileScratch>());
        }
        for (const auto& each : scratch) {
            each->counters = {};
        }
    }
};

Rasterizer::Rasterizer() : state_(std::make_unique<State>()) {}
Rasterizer::~Rasterizer() = default;

void Rasterizer::transformAndBin(const DrawList& list, const FrameView& view,
                                 const RasterSettings& settings, Workers& workers) {
    State& s = *state_;
    s.settings = settings;
    internal::setUpFrame(list, view, settings, s.setup);
    s.cutVertices(list);
    s.prepareScratch(workers.threads());
    const internal::RasterKernels& kernels = internal::kernelsFor(settings.simd);
    workers.parallelFor(int(s.vertex_chunks.size()), 1, [&](int begin, int end, int worker) {
        const uint64_t start = s.now();
        for (int i = begin; i < end; ++i) {
            const VertexChunk& c = s.vertex_chunks[size_t(i)];
            kernels.transformVertices(s.setup.vertex_jobs[c.instance], int(c.begin), int(c.end));
        }
        s.scratch[size_t(worker)]->counters.ticks.transform += s.now() - start;
    });
    s.cutTriangles(list);
    workers.parallelFor(int(s.inputs.size()), 1, [&](int begin, int end, int worker) {
        const uint64_t start = s.now();
        for (int i = begin; i < end; ++i) {
            internal::binChunk(s.inputs[size_t(i)], view, s.chunks[size_t(i)]);
        }
        s.scratch[size_t(worker)]->counters.ticks.bin += s.now() - start;
    });
    s.counters = {};
    for (size_t i = 0; i < s.inputs.size(); ++i) {
        s.counters += s.chunks[i].counters;
    }
    for (const auto& each : s.scratch) {
        s.counters.ticks += each->counters.ticks;
    }
}

void Rasterizer::rasterize(GBuffer& out, Workers& workers) {
    State& s = *state_;
    const FrameView& view = *s.setup.tables.view;
    out.resize(view.width, view.height, s.settings.planes);
    s.prepareScratch(workers.threads());
    s.counters.tiles = out.tiles.size();
    workers.parallelFor(int(out.tiles.size()), 1, [&](int begin, int end, int worker) {
        for (int i = begin; i < end; ++i) {
            internal::renderTile(s.setup, s.chunks, s.inputs.size(), s.settings, i % out.tiles_x,
                                 i / out.tiles_x, out, *s.scratch[size_t(worker)]);
        }
    });
    for (const auto& each : s.scratch) {
        s.counters += each->counters;
    }
}

const RasterCounters& Rasterizer::counters() const {
    return state_->counters;
}

}  // namespace still
