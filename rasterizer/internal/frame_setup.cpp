#include "rasterizer/internal/frame_setup.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "rasterizer/fixed.h"

namespace still::internal {

namespace {

Surface makeSurface(const DrawList& list, const Instance& instance, uint32_t instance_index,
                    const MeshPart& part) {
    const Mesh& mesh = list.meshes[instance.mesh];
    const Material& material = list.materials[part.material];
    Surface s;
    s.attributes = mesh.attributes.empty() ? nullptr : &mesh.attributes.data()->nx;
    s.tangents = mesh.tangents.empty() ? nullptr : &mesh.tangents.data()->x;
    s.x = mesh.x.data();
    s.y = mesh.y.data();
    s.z = mesh.z.data();
    s.indices = mesh.indices.data();
    s.windings = list.windings.empty() ? nullptr : list.windings[instance.mesh].data();
    s.material = &material;
    s.instance = instance_index;
    if (material.colour_texture != kNoTexture) {
        s.colour = &list.textures[size_t(material.colour_texture)];
        s.features |= kShadeTexture;
    }
    if (material.normal_texture != kNoTexture && s.tangents != nullptr) {
        s.normal = &list.textures[size_t(material.normal_texture)];
        s.features |= kShadeNormalMap;
    }
    s.normal_like_colour = s.colour != nullptr && s.normal != nullptr &&
                           s.colour->wrap == s.normal->wrap && s.colour->levels == s.normal->levels;
    if (material.height_texture != kNoTexture && s.tangents != nullptr) {
        s.height = &list.alpha_textures[size_t(material.height_texture)];
        s.features |= kShadeHeightMap;
    }
    if (material.alpha_texture != kNoTexture) {
        s.alpha = &list.alpha_textures[size_t(material.alpha_texture)];
    }
    const auto& ks = material.specular;
    if (ks[0] > 0.0f || ks[1] > 0.0f || ks[2] > 0.0f) {
        s.shininess =
            std::clamp<int>(roundToInt(std::clamp(material.shininess, 1.0f, 1024.0f)), 1, 1024);
    }
    if (s.shininess > 0 || !list.lighting.points.empty()) {
        s.features |= kShadePosition;
    }
    if (instance.moved) {
        s.features |= kShadeMoved;
    }
    return s;
}

bool isFinite(const Affine& a) {
    return std::all_of(a.begin(), a.end(), [](float v) { return v - v == 0.0f; });
}

/// Inverse transpose of the 3×3 up to a positive factor: the cofactors, signed by the determinant.
/// Returns whether the determinant is negative.
bool normalMatrix(const Affine& a, float out[9]) {
    double m[3][3];
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c) {
            m[r][c] = double(a[r * 4 + c]);
        }
    }
    double cof[3][3];
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            cof[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
    }
    const double det = m[0][0] * cof[0][0] + m[0][1] * cof[0][1] + m[0][2] * cof[0][2];
    for (int i = 0; i < 9; ++i) {
        out[i] = float(det < 0.0 ? -cof[i / 3][i % 3] : cof[i / 3][i % 3]);
    }
    return det < 0.0;
}

VertexJob makeVertexJob(const Mesh& mesh, const InstanceSetup& instance, const FrameView& view) {
    VertexJob job{};
    job.x = mesh.x.data();
    job.y = mesh.y.data();
    job.z = mesh.z.data();
    job.clip = instance.clip;
    job.scale_x_fx8 = float(kSubpixelHalf * view.width);
    job.scale_y_fx8 = -float(kSubpixelHalf * view.height);
    job.centre_x_fx8 = kSubpixelHalf * view.width;
    job.centre_y_fx8 = kSubpixelHalf * view.height;
    job.frustum_x = 1.0f + 2.0f / float(view.width);
    job.frustum_y = 1.0f + 2.0f / float(view.height);
    job.guard_fx8 = kGuardBandPx * float(kSubpixelOne);
    return job;
}

/// Marks the tiles under the projected bounding box, two pixels wider for jitter and neighbours.
class MovedTiles {
  public:
    MovedTiles(FrameSetup& setup, const FrameView& view) : setup_(setup), view_(view) {}

    void mark(const PositionBox& bounds, const Matrix& to_pixels) {
        double box[4] = {1e30, 1e30, -1e30, -1e30};
        for (int corner = 0; corner < 8; ++corner) {
            double p[3];
            for (int axis = 0; axis < 3; ++axis) {
                const bool high = (corner >> axis & 1) != 0;
                p[axis] = double(high ? bounds.high[axis] : bounds.low[axis]);
            }
            double q[4];
            for (int r = 0; r < 4; ++r) {
                const double* m = to_pixels.m[r];
                q[r] = (m[0] * p[0] + m[1] * p[1]) + (m[2] * p[2] + m[3]);
            }
            if (!(q[3] > 1e-20) || q[2] > q[3]) {  // reaches behind the near plane
                markBox(0, 0, view_.width, view_.height);
                return;
            }
            box[0] = std::min(box[0], q[0] / q[3]);
            box[1] = std::min(box[1], q[1] / q[3]);
            box[2] = std::max(box[2], q[0] / q[3]);
            box[3] = std::max(box[3], q[1] / q[3]);
        }
        markBox(box[0] - 2.0, box[1] - 2.0, box[2] + 2.0, box[3] + 2.0);
    }

  private:
    static int tileOf(double pixel, int tiles) {
        return int(std::clamp(std::floor(pixel / kTileSize), -1.0, double(tiles)));
    }

    void markBox(double x0, double y0, double x1, double y1) {
        const int tx0 = std::max(0, tileOf(x0, setup_.tiles_x));
        const int tx1 = std::min(setup_.tiles_x - 1, tileOf(x1, setup_.tiles_x));
        const int ty0 = std::max(0, tileOf(y0, setup_.tiles_y));
        const int ty1 = std::min(setup_.tiles_y - 1, tileOf(y1, setup_.tiles_y));
        for (int ty = ty0; ty <= ty1; ++ty) {
            for (int tx = tx0; tx <= tx1; ++tx) {
                setup_.facts[size_t(ty) * size_t(setup_.tiles_x) + size_t(tx)].moved = true;
            }
        }
    }

    FrameSetup& setup_;
    const FrameView& view_;
};

void setUpInstance(const DrawList& list, const FrameView& view, const RasterSettings& settings,
                   const Matrix& clip_now, const Matrix& clip_before, uint32_t index,
                   FrameSetup& out) {
    const Instance& instance = list.instances[index];
    const Mesh& mesh = list.meshes[instance.mesh];
    assert(instance.first_surface == out.surfaces.size());
    InstanceSetup s;
    s.world = instance.transform;
    s.identity = instance.identity;
    s.moved = instance.moved;
    s.own_motion = instance.moved && !settings.camera_motion_only;
    const Matrix now = clip_now * fromAffine(instance.transform);
    // What is not a number has no place: all of its vertices lie behind the camera.
    s.clip = isFinite(instance.transform) ? toFloat(now) : MatrixF{};
    s.mirrored = normalMatrix(instance.transform, s.normal);
    if (instance.moved) {
        const Matrix before = clip_before * fromAffine(instance.transform_before);
        const Matrix pixels_now = toPixels(now, view.width, view.height);
        const Matrix pixels_before = toPixels(before, view.width, view.height);
        s.pixels_now = toFloat(pixels_now);
        s.pixels_before = toFloat(pixels_before);
        if (mesh.vertexCount() > 0) {
            const PositionBox bounds =
                geometryFor(settings.simd)
                    .boundVertices(mesh.x.data(), mesh.y.data(), mesh.z.data(), mesh.x.size());
            MovedTiles marker(out, view);
            marker.mark(bounds, pixels_now);
            marker.mark(bounds, pixels_before);
        }
    }
    out.instances.push_back(s);
    out.vertex_jobs.push_back(makeVertexJob(mesh, s, view));
    out.first_vertex.push_back(out.vertex_count);
    out.vertex_count += mesh.vertexCount();
    for (const MeshPart& part : mesh.parts) {
        out.surfaces.push_back(makeSurface(list, instance, index, part));
        out.surfaces.back().mip_bias_fx8 = settings.mip_bias_fx8;
    }
}

/// Highlights of a sampled sun and of sampled lights go with their light.
PlainLight plainLight(const Lighting& lighting) {
    PlainLight light{lighting.ambient, lighting.sun, lighting.points};
    if (lighting.sampled.sun_shadow != SunShadow::none) {
        light.sun.colour = {};
    }
    if (lighting.sampled.ambient != AmbientLight::plain) {
        light.ambient = {};
    }
    return light;
}

}  // namespace

void setUpFrame(const DrawList& list, const FrameView& view, const RasterSettings& settings,
                FrameSetup& out) {
    assert(view.width >= 1 && view.width <= kMaxTargetSize);
    assert(view.height >= 1 && view.height <= kMaxTargetSize);
    assert(settings.mip_bias_fx8 >= -4096 && settings.mip_bias_fx8 <= 4096);
    out.tiles_x = (view.width + kTileSize - 1) / kTileSize;
    out.tiles_y = (view.height + kTileSize - 1) / kTileSize;
    const bool camera_moved = view.view_projection != view.view_projection_before;
    out.facts.assign(size_t(out.tiles_x) * size_t(out.tiles_y),
                     {.moved = false, .camera_moved = camera_moved});
    out.surfaces.assign(1, Surface{});
    out.instances.clear();
    out.vertex_jobs.clear();
    out.first_vertex.clear();
    out.vertex_count = 0;

    const Matrix clip_now = reverseDepth(fromGlm(view.view_projection));
    const Matrix clip_before = reverseDepth(fromGlm(view.view_projection_before));
    for (uint32_t i = 0; i < list.instances.size(); ++i) {
        setUpInstance(list, view, settings, clip_now, clip_before, i, out);
    }
    assert(out.surfaces.size() <= kMaxSurfaces + 1);

    FrameTables& t = out.tables;
    t.list = &list;
    t.view = &view;
    t.light = plainLight(list.lighting);
    t.planes = settings.planes;
    t.camera_moved = camera_moved;
    // Of a camera that stands still exactly the identity, so that its motion is exactly zero.
    t.reproject = fromAffine(kIdentity);
    if (t.camera_moved) {
        t.reproject = toPixels(clip_before, view.width, view.height) *
                      inverse(toPixels(clip_now, view.width, view.height));
    }
    t.surfaces = out.surfaces.data();
    t.instances = out.instances.data();
}

MatrixF tileReprojection(const FrameTables& tables, int tile_x0, int tile_y0) {
    // Tile-local x, y stand for the unjittered position of a pixel's sample.
    const double x = tile_x0 + (kSubpixelHalf + tables.view->jitter_x_fx8) / double(kSubpixelOne);
    const double y = tile_y0 + (kSubpixelHalf + tables.view->jitter_y_fx8) / double(kSubpixelOne);
    Matrix r = tables.reproject;
    for (int i = 0; i < 4; ++i) {
        r.m[i][3] = (r.m[i][0] * x + r.m[i][1] * y) + r.m[i][3];
    }
    for (int j = 0; j < 4; ++j) {
        r.m[0][j] -= x * r.m[3][j];
        r.m[1][j] -= y * r.m[3][j];
    }
    return toFloat(r);
}

}  // namespace still::internal
