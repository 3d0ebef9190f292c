#include "spinner.h"

#include <algorithm>
#include <cmath>

#include "rasterizer/texture_layout.h"

namespace spin {
namespace {

/// `count` points of a circle, a power of 2 from 4 on: cosine and sine. By bisection, for libraries
/// disagree on sin and cos but not on √.
void fillCircle(double (*points)[2], int count) {
    const double quarters[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int k = 0; k < 4; ++k) {
        std::copy_n(quarters[k], 2, points[k * (count / 4)]);
    }
    for (int step = count / 8; step > 0; step /= 2) {
        for (int i = step; i < count; i += 2 * step) {
            const double* a = points[i - step];
            const double* b = points[(i + step) % count];
            const double x = a[0] + b[0], y = a[1] + b[1];
            const double length = std::sqrt(x * x + y * y);
            points[i][0] = x / length;
            points[i][1] = y / length;
        }
    }
}

void reserve(still::Mesh& mesh, size_t vertices, size_t triangles) {
    for (std::vector<float>* axis : {&mesh.x, &mesh.y, &mesh.z}) {
        axis->reserve(vertices);
    }
    mesh.attributes.reserve(vertices);
    mesh.indices.reserve(triangles * 3);
}

void addVertex(still::Mesh& mesh, const double (&position)[3],
               const still::VertexAttributes& attributes) {
    mesh.x.push_back(float(position[0]));
    mesh.y.push_back(float(position[1]));
    mesh.z.push_back(float(position[2]));
    mesh.attributes.push_back(attributes);
}

void addQuad(still::Mesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    for (const uint32_t index : {a, b, c, a, c, d}) {
        mesh.indices.push_back(index);
    }
}

void makeRing(still::Mesh& mesh) {
    constexpr double kRadius = 1.0, kTubeRadius = 0.42;
    double around[kRingSides][2], tube[kTubeSides][2];
    fillCircle(around, kRingSides);
    fillCircle(tube, kTubeSides);
    reserve(mesh, kRingVertices, kRingTriangles);
    for (int i = 0; i <= kRingSides; ++i) {
        const double* u = around[i % kRingSides];
        for (int j = 0; j <= kTubeSides; ++j) {
            const double* v = tube[j % kTubeSides];
            const double from_axis = kRadius + kTubeRadius * v[0];
            addVertex(mesh, {u[0] * from_axis, u[1] * from_axis, kTubeRadius * v[1]},
                      {.nx = float(u[0] * v[0]),
                       .ny = float(u[1] * v[0]),
                       .nz = float(v[1]),
                       .u = float(i) / 4.0f,
                       .v = float(j) / 4.0f});
        }
    }
    for (uint32_t i = 0; i < uint32_t(kRingSides); ++i) {
        for (uint32_t j = 0; j < uint32_t(kTubeSides); ++j) {
            const uint32_t first = i * (kTubeSides + 1) + j, next = first + kTubeSides + 1;
            addQuad(mesh, first, next, next + 1, first + 1);
        }
    }
    mesh.parts = {{.first_triangle = 0, .triangle_count = kRingTriangles, .material = 0}};
}

void makeFloor(still::Mesh& mesh) {
    constexpr float kRepeats = 8;
    reserve(mesh, kFloorVertices, kFloorTriangles);
    for (const double z : {1.5, -6.0}) {
        for (const double x : {-1.0, 1.0}) {
            addVertex(
                mesh, {x * 4.5, -1.5, z},
                {.nx = 0, .ny = 1, .nz = 0, .u = x > 0 ? kRepeats : 0, .v = z > 0 ? 0 : kRepeats});
        }
    }
    addQuad(mesh, 0, 1, 3, 2);
    mesh.parts = {{.first_triangle = 0, .triangle_count = kFloorTriangles, .material = 1}};
}

/// Two by two squares, and all coarser levels.
void makeChequers(still::Texture& texture) {
    constexpr uint32_t kDark = 300 | 310 << 10 | 340 << 20, kLight = 1000 | 960 << 10 | 900 << 20;
    constexpr uint32_t kMean = 738 | 713 << 10 | 680 << 20;  // of their light: √((a² + b²) / 2)
    texture.levels.reserve(5);
    for (uint32_t size = kTextureSize; size > 0; size /= 2) {
        still::addLevel(texture.levels, size, size);
        for (uint32_t i = 0; i < size * size; ++i) {
            const uint32_t half = size / 2, x = i % size, y = i / size;
            const bool light = size > 1 && (x >= half) != (y >= half);
            texture.texels.push_back(size == 1 ? kMean : light ? kLight : kDark);
        }
    }
    still::layOut(texture);
}

/// Fraction `index` of the Halton sequence to a base, less ½, in 1/256, rounded half up.
constexpr int halton_fx8(int index, int base) {
    int numerator = 0, denominator = 1;
    for (int rest = index + 1; rest > 0; rest /= base) {
        numerator = numerator * base + rest % base;
        denominator *= base;
    }
    return (512 * numerator + denominator) / (2 * denominator) - 128;
}
constexpr int kJitterPeriod = 16;

class Hash {
  public:
    template <class T>
    void add(still::ImageView<const T> plane) {
        for (int y = 0; y < plane.height; ++y) {
            for (int x = 0; x < plane.width; ++x) {
                addBytes(plane.row(y)[x], sizeof(T));
            }
        }
    }
    void add(still::ImageView<const still::Motion> plane) {
        for (int y = 0; y < plane.height; ++y) {
            for (int x = 0; x < plane.width; ++x) {
                addBytes(uint16_t(plane.row(y)[x].x_fx8), 2);
                addBytes(uint16_t(plane.row(y)[x].y_fx8), 2);
            }
        }
    }
    uint64_t value() const { return value_; }

  private:
    /// The lowest byte first, whatever the CPU's order.
    void addBytes(uint32_t word, size_t bytes) {
        for (size_t i = 0; i < bytes; ++i) {
            value_ = (value_ ^ ((word >> (8 * i)) & 0xFF)) * 0x100000001B3u;
        }
    }
    uint64_t value_ = 0xCBF29CE484222325u;
};

}  // namespace

Spinner::Spinner(still::SimdTarget simd, still::Workers& workers) : workers_(workers) {
    settings_.simd = simd;
    settings_.planes = kPlanes;
    makeRing(meshes_[0]);
    makeFloor(meshes_[1]);
    makeChequers(texture_);
    fillCircle(turn_, kTurnFrames);
    materials_[0] = {.diffuse = {1.0f, 0.55f, 0.2f}, .colour_texture = 0};
    materials_[1] = {.diffuse = {0.5f, 0.6f, 0.7f}, .colour_texture = 0};
    instances_[0] = {.mesh = 0, .object = 1, .first_surface = 1, .identity = false};
    instances_[1] = {.mesh = 1, .object = 2, .first_surface = 2};
    list_.meshes = meshes_;
    list_.materials = materials_;
    list_.textures = {&texture_, 1};
    list_.instances = instances_;
    list_.lighting.ambient = {0.25f, 0.28f, 0.33f};
    list_.lighting.sun = {.direction = {0.48f, -0.64f, -0.6f}, .colour = {0.8f, 0.77f, 0.7f}};
    list_.background = {0.3f, 0.45f, 0.7f};
    rasterizer_.reserve(kLimits);
    gbuffer_.resize(kWidth, kHeight, kPlanes);
    taa_.reserve(kWidth, kHeight, kPolicy);
}

still::FrameView Spinner::viewOf(int frame) const {
    constexpr double kFocal = 2.0, kNear = 0.5, kFar = 20.0, kDistance = 4.0;
    still::FrameView view;
    view.width = kWidth;
    view.height = kHeight;
    glm::dmat4& m = view.view_projection;  // columns
    m = glm::dmat4(0.0);
    m[0][0] = kFocal * kHeight / kWidth;
    m[1][1] = kFocal;
    m[2][2] = -(kFar + kNear) / (kFar - kNear);
    m[2][3] = -1.0;
    m[3][2] = kDistance * (kFar + kNear) / (kFar - kNear) - 2.0 * kFar * kNear / (kFar - kNear);
    m[3][3] = kDistance;
    view.view_projection_before = view.view_projection;
    view.eye = {0.0f, 0.0f, float(kDistance)};
    view.jitter_x_fx8 = halton_fx8(frame % kJitterPeriod, 2);
    view.jitter_y_fx8 = halton_fx8(frame % kJitterPeriod, 3);
    view.sample = uint32_t(frame);
    return view;
}

/// The ring leans back by the angle of the triangle 3, 4, 5 and turns around the vertical axis. It
/// stands where four tiles meet: what a tile needs to be shaded goes by its triangles.
void Spinner::place(int frame) {
    const auto placed = [&](int at) {
        const double* turn = turn_[at % kTurnFrames];
        const float c = float(turn[0]), s = float(turn[1]);
        constexpr float x = -0.53f, y = -0.13f;
        return still::Affine{c,     s * 0.6f, s * 0.8f, x,        0,        0.8f,
                             -0.6f, y,        -s,       c * 0.6f, c * 0.8f, 0};
    };
    instances_[0].transform = placed(frame);
    instances_[0].transform_before = placed(std::max(frame - 1, 0));
    instances_[0].moved = instances_[0].transform != instances_[0].transform_before;
}

FrameHashes Spinner::render(int frame) {
    place(frame);
    const still::FrameView view = viewOf(frame);
    rasterizer_.transformAndBin(list_, view, settings_, workers_);
    rasterizer_.rasterize(gbuffer_, workers_);
    taa_.resolve(
        gbuffer_,
        {.reset = frame == 0, .jitter_x_fx8 = view.jitter_x_fx8, .jitter_y_fx8 = view.jitter_y_fx8},
        kPolicy, settings_.simd, workers_);
    const still::GBuffer& g = gbuffer_;
    Hash samples, image;
    for (const still::Image<uint16_t>* plane :
         {&g.red, &g.green, &g.blue, &g.id, &g.depth_before}) {
        samples.add(plane->view());
    }
    samples.add(g.depth.view());
    samples.add(g.motion.view());
    const still::ColourPlanes colour = taa_.colour();
    for (const still::ImageView<const uint16_t>& plane : {colour.red, colour.green, colour.blue}) {
        image.add(plane);
    }
    return {samples.value(), image.value()};
}

}  // namespace spin
