#include "rasterizer/internal/matrix.h"

namespace still::internal {

Matrix fromGlm(const glm::dmat4& columns) {
    Matrix r;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            r.m[row][column] = columns[column][row];
        }
    }
    return r;
}

Matrix fromAffine(const Affine& affine) {
    Matrix r{};
    for (int i = 0; i < 12; ++i) {
        r.m[i / 4][i % 4] = double(affine[size_t(i)]);
    }
    r.m[3][3] = 1.0;
    return r;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix r;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            r.m[i][j] = (a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j]) +
                        (a.m[i][2] * b.m[2][j] + a.m[i][3] * b.m[3][j]);
        }
    }
    return r;
}

namespace {

/// Determinant of the 3×3 that is left without row `r` and column `c`, with the cofactor's sign.
double cofactor(const Matrix& a, int r, int c) {
    const int r0 = (r + 1) & 3, r1 = (r + 2) & 3, r2 = (r + 3) & 3;
    const int c0 = (c + 1) & 3, c1 = (c + 2) & 3, c2 = (c + 3) & 3;
    const double d = a.m[r0][c0] * (a.m[r1][c1] * a.m[r2][c2] - a.m[r1][c2] * a.m[r2][c1]) -
                     a.m[r0][c1] * (a.m[r1][c0] * a.m[r2][c2] - a.m[r1][c2] * a.m[r2][c0]) +
                     a.m[r0][c2] * (a.m[r1][c0] * a.m[r2][c1] - a.m[r1][c1] * a.m[r2][c0]);
    return ((r + c) & 1) != 0 ? -d : d;
}

}  // namespace

Matrix inverse(const Matrix& a) {
    Matrix r{};
    const double det = (a.m[0][0] * cofactor(a, 0, 0) + a.m[0][1] * cofactor(a, 0, 1)) +
                       (a.m[0][2] * cofactor(a, 0, 2) + a.m[0][3] * cofactor(a, 0, 3));
    if (det == 0.0) {
        return r;
    }
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            r.m[i][j] = cofactor(a, j, i) / det;
        }
    }
    return r;
}

MatrixF toFloat(const Matrix& a) {
    MatrixF r;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            r.m[i][j] = float(a.m[i][j]);
        }
    }
    return r;
}

Matrix reverseDepth(const Matrix& clip) {
    Matrix r = clip;
    for (int j = 0; j < 4; ++j) {
        r.m[2][j] = 0.5 * (clip.m[3][j] - clip.m[2][j]);
    }
    return r;
}

Matrix toPixels(const Matrix& reversed_clip, int width, int height) {
    Matrix r = reversed_clip;
    for (int j = 0; j < 4; ++j) {
        const double w = reversed_clip.m[3][j];
        r.m[0][j] = 0.5 * width * (w + reversed_clip.m[0][j]);
        r.m[1][j] = 0.5 * height * (w - reversed_clip.m[1][j]);
    }
    return r;
}

}  // namespace still::internal
