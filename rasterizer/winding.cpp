#include "rasterizer/internal/shade_setup.h"

namespace still {

namespace internal {

bool windingAgrees(const float* x, const float* y, const float* z, const float* attributes,
                   const uint32_t index[3]) {
    double p[3][3], n[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
        p[k][0] = double(x[index[k]]);
        p[k][1] = double(y[index[k]]);
        p[k][2] = double(z[index[k]]);
        for (int i = 0; i < 3; ++i) {
            n[i] += double(attributes[size_t(index[k]) * kAttributeStride + size_t(i)]);
        }
    }
    double a[3], b[3];
    for (int i = 0; i < 3; ++i) {
        a[i] = p[1][i] - p[0][i];
        b[i] = p[2][i] - p[0][i];
    }
    const double along = ((a[1] * b[2] - a[2] * b[1]) * n[0] + (a[2] * b[0] - a[0] * b[2]) * n[1]) +
                         (a[0] * b[1] - a[1] * b[0]) * n[2];
    return along >= 0.0;
}

}  // namespace internal

WindingBits windingBits(const Mesh& mesh) {
    WindingBits bits((size_t(mesh.triangleCount()) + 31) / 32);
    for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        const bool agrees = internal::windingAgrees(mesh.x.data(), mesh.y.data(), mesh.z.data(),
                                                    &mesh.attributes.data()->nx,
                                                    mesh.indices.data() + size_t(t) * 3);
        bits[t / 32] |= uint32_t{agrees} << t % 32;
    }
    return bits;
}

}  // namespace still
