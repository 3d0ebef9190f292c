#pragma once
// Once per frame: matrices, surface and instance tables, vertex jobs, and the tiles that moving
// instances touch now or touched before.

#include <vector>

#include "rasterizer/internal/kernels.h"
#include "rasterizer/rasterizer.h"

namespace still::internal {

/// Owns what FrameTables points to.
struct FrameSetup {
    FrameTables tables;
    std::vector<Surface> surfaces;
    std::vector<InstanceSetup> instances;
    std::vector<VertexJob> vertex_jobs;  ///< one per instance; `out` is filled by the caller
    std::vector<size_t> first_vertex;    ///< of each instance in the frame's vertex arrays
    size_t vertex_count = 0;
    int tiles_x = 0, tiles_y = 0;
    std::vector<TileFacts> facts;  ///< row by row
};

void setUpFrame(const DrawList& list, const FrameView& view, const RasterSettings& settings,
                FrameSetup& out);

/// FrameTables::reproject for one tile: from and to pixel coordinates relative to the tile.
MatrixF tileReprojection(const FrameTables& tables, int tile_x0, int tile_y0);

}  // namespace still::internal
