#pragma once
// 4×4 matrices in double with a written order of operations. GLM's products and inverses are not
// used where they reach pixels: their order may change with its version.

#include <array>
#include <glm/mat4x4.hpp>

#include "rasterizer/draw_list.h"

namespace still::internal {

/// Row-major: m[row][column], column vectors.
struct Matrix {
    double m[4][4];
};

/// The same with floats, as kernels take it.
struct MatrixF {
    float m[4][4];
};

Matrix fromGlm(const glm::dmat4& columns);
Matrix fromAffine(const Affine& affine);
Matrix operator*(const Matrix& a, const Matrix& b);
/// By cofactors. A singular matrix gives all zeros.
Matrix inverse(const Matrix& a);
/// Each element rounded to nearest.
MatrixF toFloat(const Matrix& a);

/// OpenGL clip rows (x, y, z, w) → (x, y, z', w) with z' = (w − z) / 2: z' / w is reversed Z, 1 on
/// the near plane and 0 on the far one. Taken here, in double, the difference loses nothing.
Matrix reverseDepth(const Matrix& clip);

/// Reversed-depth clip rows → (x_px · w, y_px · w, z', w), pixel coordinates from the top left.
Matrix toPixels(const Matrix& reversed_clip, int width, int height);

}  // namespace still::internal
