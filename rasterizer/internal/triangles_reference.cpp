// Which triangles of a chunk are worth a record, and the records; triangles-inl.h repeats it lane
// by lane.

#include "rasterizer/internal/triangles_reference.h"

#include <algorithm>
#include <utility>

#include "rasterizer/fixed.h"
#include "rasterizer/internal/vertex_reference.h"

namespace still::internal {

int outcodeOf(const ScreenVertex& v, int width, int height) {
    if (!v.placed()) {
        return v.y_fx8;
    }
    int code = v.x_fx8 < -kSubpixelOne ? kOutLeft : 0;
    code |= v.x_fx8 > (width + 1) * kSubpixelOne ? kOutRight : 0;
    code |= v.y_fx8 < -kSubpixelOne ? kOutTop : 0;
    code |= v.y_fx8 > (height + 1) * kSubpixelOne ? kOutBottom : 0;
    return code | (v.z < 0.0f ? kOutFar : 0);
}

namespace {

class BatchBuilder {
  public:
    BatchBuilder(const TriangleJob& job, TriangleBatch& batch) : job_(job), batch_(batch) {
        batch.count = 0;
        batch.flags = 0;
        batch.tile_x0 = batch.tile_y0 = INT32_MAX;
        batch.tile_x1 = batch.tile_y1 = -1;
    }

    void add(uint32_t triangle) {
        ScreenVertex v[3];
        int all = 0xFF, any = 0;
        bool placed = true;
        for (int k = 0; k < 3; ++k) {
            v[k] = job_.vertices[job_.indices[triangle * 3 + uint32_t(k)]];
            const int code = outcodeOf(v[k], job_.width, job_.height);
            all &= code;
            any |= code;
            placed &= v[k].placed();
        }
        if ((all & kOutFrustum) != 0 || (any & kOutInvalid) != 0) {
            return;
        }
        if (placed) {
            addPlaced(v, triangle);
        } else {
            addWide(triangle);
        }
    }

  private:
    void addPlaced(ScreenVertex v[3], uint32_t triangle) {
        for (int k = 0; k < 3; ++k) {
            v[k].x_fx8 -= job_.sample_x_fx8;
            v[k].y_fx8 -= job_.sample_y_fx8;
        }
        const auto [min_x, max_x] = std::minmax({v[0].x_fx8, v[1].x_fx8, v[2].x_fx8});
        const auto [min_y, max_y] = std::minmax({v[0].y_fx8, v[1].y_fx8, v[2].y_fx8});
        constexpr int kRoundUp = kSubpixelOne - 1;
        const int x0 = std::max<int>(0, (min_x + kRoundUp) >> kSubpixelBits);
        const int y0 = std::max<int>(0, (min_y + kRoundUp) >> kSubpixelBits);
        const int x1 = std::min<int>(job_.width - 1, max_x >> kSubpixelBits);
        const int y1 = std::min<int>(job_.height - 1, max_y >> kSubpixelBits);
        if (x1 < x0 || y1 < y0) {
            return;
        }
        if (max_x - min_x > kCompactExtentFx8 || max_y - min_y > kCompactExtentFx8) {
            addWide(triangle);
            return;
        }
        const int32_t area2 = (v[1].x_fx8 - v[0].x_fx8) * (v[2].y_fx8 - v[0].y_fx8) -
                              (v[2].x_fx8 - v[0].x_fx8) * (v[1].y_fx8 - v[0].y_fx8);
        if (area2 == 0) {
            return;
        }
        uint32_t id = triangle;
        if (area2 < 0) {
            std::swap(v[1], v[2]);
            id |= kSwapped;
        }
        const int tx = x0 >> kTileShift, ty = y0 >> kTileShift;
        const int tx1 = x1 >> kTileShift, ty1 = y1 >> kTileShift;
        TileTriangle record{};
        for (int k = 0; k < 3; ++k) {
            record.corner[k] = {int16_t(v[k].x_fx8 - tx * kTileSize * kSubpixelOne),
                                int16_t(v[k].y_fx8 - ty * kTileSize * kSubpixelOne)};
            record.z[k] = v[k].z;
        }
        record.x0 = uint8_t(x0 - tx * kTileSize);
        record.y0 = uint8_t(y0 - ty * kTileSize);
        record.x1 = uint8_t(x1 - tx * kTileSize);
        record.y1 = uint8_t(y1 - ty * kTileSize);
        record.id = id;
        const bool several = tx1 != tx || ty1 != ty;
        addRecord(record, uint32_t(tx | ty << 8) | (several ? TriangleBatch::kSeveralTiles : 0));
        batch_.tile_x0 = std::min<int>(batch_.tile_x0, tx);
        batch_.tile_y0 = std::min<int>(batch_.tile_y0, ty);
        batch_.tile_x1 = std::max<int>(batch_.tile_x1, tx1);
        batch_.tile_y1 = std::max<int>(batch_.tile_y1, ty1);
    }

    void addWide(uint32_t triangle) {
        TileTriangle record{};
        record.id = triangle | kWide;
        addRecord(record, TriangleBatch::kWidePlace);
    }

    void addRecord(const TileTriangle& record, uint32_t place) {
        batch_.records[batch_.count] = record;
        batch_.place[batch_.count] = place;
        ++batch_.count;
        batch_.flags |= place & ~0xFFFFu;
    }

    const TriangleJob& job_;
    TriangleBatch& batch_;
};

}  // namespace

void cullTrianglesReference(const TriangleJob& job, TriangleBatch& batch) {
    BatchBuilder builder(job, batch);
    for (uint32_t i = 0; i < job.count; ++i) {
        builder.add(i);
    }
}

const GeometryKernels& referenceGeometry() {
    static constexpr GeometryKernels kKernels{transformVerticesReference, boundVerticesReference,
                                              cullTrianglesReference};
    return kKernels;
}

}  // namespace still::internal
