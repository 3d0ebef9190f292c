#include "tests/support/random_triangles.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace still::test {
namespace {

VertexAttributes randomAttributes(Random& random) {
    glm::dvec3 n(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    n.z += n.z < 0 ? -0.5 : 0.5;  // never near zero length
    n = glm::normalize(n);
    return {float(n.x), float(n.y), float(n.z), float(random.real(0.2, 0.8)),
            float(random.real(0.2, 0.8))};
}

glm::dvec2 inPicture(const FrameView& view, Random& random) {
    return {random.real(-0.2, 1.2) * view.width, random.real(-0.2, 1.2) * view.height};
}

using Corners = std::array<glm::dvec2, 3>;

Corners sliver(const FrameView& view, Random& random) {
    const glm::dvec2 a = inPicture(view, random);
    const glm::dvec2 b = inPicture(view, random);
    const double width_px = std::exp2(random.real(-9, 2));
    const glm::dvec2 c = a + random.real(0, 1) * (b - a);
    return {a, b, c + glm::dvec2(random.real(-1, 1), random.real(-1, 1)) * width_px};
}

Corners subPixel(const FrameView& view, Random& random) {
    const glm::dvec2 a = inPicture(view, random);
    const double size_px = std::exp2(random.real(-8, 1));
    Corners c{a, a, a};
    for (glm::dvec2& p : c) {
        p += glm::dvec2(random.real(-1, 1), random.real(-1, 1)) * size_px;
    }
    return c;
}

Corners onSamples(const FrameView& view, Random& random) {
    Corners c;
    for (glm::dvec2& p : c) {
        p = {random.integer(-4, 2 * view.width + 4) * 0.5 + view.jitter_x_fx8 / 256.0,
             random.integer(-4, 2 * view.height + 4) * 0.5 + view.jitter_y_fx8 / 256.0};
    }
    return c;
}

Corners degenerate(const FrameView& view, Random& random) {
    Corners c = onSamples(view, random);
    switch (random.integer(0, 3)) {
        case 0:
            c[2] = c[1];
            break;
        case 1:
            c[2] = c[1] = c[0];
            break;
        case 2:
            c[2] = 2.0 * c[1] - c[0];
            break;
        default:
            c[2] = c[1] + glm::dvec2(1 / 256.0, 0);
            break;
    }
    return c;
}

Corners beyondGuard(const FrameView& view, glm::dvec2 side, Random& random) {
    Corners c{inPicture(view, random), inPicture(view, random), inPicture(view, random)};
    const int far_corners = random.integer(1, 2);
    for (int k = 0; k < far_corners; ++k) {
        const double far_px = std::exp2(random.real(14.1, 18));
        c[size_t(k)] += side * far_px + glm::dvec2(side.y, side.x) * random.real(-9000, 9000);
    }
    return c;
}

Corners flatCorners(const FrameView& view, FlatKind kind, Random& random) {
    switch (kind) {
        case FlatKind::sliver:
            return sliver(view, random);
        case FlatKind::sub_pixel:
            return subPixel(view, random);
        case FlatKind::on_samples:
            return onSamples(view, random);
        case FlatKind::degenerate:
            return degenerate(view, random);
        case FlatKind::guard_left:
            return beyondGuard(view, {-1, 0}, random);
        case FlatKind::guard_right:
            return beyondGuard(view, {1, 0}, random);
        case FlatKind::guard_top:
            return beyondGuard(view, {0, -1}, random);
        case FlatKind::guard_bottom:
            return beyondGuard(view, {0, 1}, random);
        default:
            break;
    }
    Corners c;
    for (glm::dvec2& p : c) {
        p = kind == FlatKind::ordinary
                ? inPicture(view, random)
                : glm::dvec2(random.real(-16000, 16000), random.real(-16000, 16000));
    }
    return c;
}

double deepZ(DeepKind kind, Random& random) {
    switch (kind) {
        case DeepKind::in_front:
            return -std::exp2(random.real(-3, 8));
        case DeepKind::near:
            return random.real(-0.4, 0.1);
        case DeepKind::across:
            return random.real(-60, 40);
        case DeepKind::vast:
            return random.real(-1, 1) * std::exp2(random.real(-4, 14));
        default:
            return random.real(0.01, 50);
    }
}

}  // namespace

FrameView flatView(int width, int height, Random& random) {
    FrameView view;
    view.width = width;
    view.height = height;
    view.jitter_x_fx8 = random.integer(-128, 127);
    view.jitter_y_fx8 = random.integer(-128, 127);
    return view;
}

FrameView deepView(int width, int height, Random& random) {
    FrameView view = flatView(width, height, random);
    view.view_projection = perspective(1.5, double(width) / height, 0.1, 1000);
    view.view_projection_before = view.view_projection;
    return view;
}

void addFlat(TestScene& scene, const FrameView& view, FlatKind kind, Random& random) {
    const Corners c = flatCorners(view, kind, random);
    std::array<TestVertex, 3> v;
    for (size_t k = 0; k < 3; ++k) {
        v[k] = atPixel(view, c[k].x, c[k].y, random.real(0.05, 0.95));
        v[k].attributes = randomAttributes(random);
    }
    scene.addTriangle(v[0], v[1], v[2]);
}

void addDeep(TestScene& scene, DeepKind kind, Random& random) {
    std::array<TestVertex, 3> v;
    for (TestVertex& p : v) {
        const double z = deepZ(kind, random);
        const double spread = 0.1 + std::abs(z);
        p = {float(random.real(-1, 1) * spread), float(random.real(-1, 1) * spread), float(z),
             randomAttributes(random)};
    }
    scene.addTriangle(v[0], v[1], v[2]);
}

}  // namespace still::test
