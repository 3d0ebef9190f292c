// Mip-mapped textures from 8-bit pixels.
//
// Sources: IEC 61966-2-1 (sRGB transfer curve); E. Bjorke, "Box filtering of non-power-of-two
// textures" (area weights for odd sizes, level by level); I. Castaño, "Computing Alpha Mipmaps",
// 2010 (each level keeps the coverage of level 0).
//
// All averages are doubles in a written order: the only operations are + × ÷ √ and floor.

#include "engine/texture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "engine/det_math.h"
#include "rasterizer/texture_layout.h"

namespace still {

namespace {

using ByteTable = std::array<double, 256>;

/// Of values ≥ 0, where cutting off the fraction is floor().
uint32_t roundHalfUp(double value) {
    return uint32_t(int64_t(value + 0.5));
}

const ByteTable& srgbToLinear() {
    static const ByteTable table = [] {
        ByteTable t{};
        for (int c = 0; c < 256; ++c) {
            const double x = c / 255.0;
            t[size_t(c)] = x <= 0.04045 ? x / 12.92 : det::pow((x + 0.055) / 1.055, 2.4);
        }
        return t;
    }();
    return table;
}

const ByteTable& byteToUnit() {
    static const ByteTable table = [] {
        ByteTable t{};
        for (int c = 0; c < 256; ++c) {
            t[size_t(c)] = c / 255.0;
        }
        return t;
    }();
    return table;
}

// Objects and not functions, so that loops are compiled for each.

/// Linear light → 10 bits, gamma 2.0.
constexpr auto encodeGamma2 = [](double linear) { return roundHalfUp(1023.0 * std::sqrt(linear)); };

/// (component + 1) / 2 → 10 bits.
constexpr auto encodeUnit = [](double unit) { return roundHalfUp(1023.0 * unit); };

/// Source texels under one texel of the next level, along one axis: two of equal weight when the
/// size is even, three when it is odd (the outer ones are cut), one when it is already 1.
///
///   5 texels → 2:  |  0  |  1  |  2  |  3  |  4  |
///                  |       0      |      1       |    weights ⅖ ⅖ ⅕ and ⅕ ⅖ ⅖
struct Taps {
    uint32_t first = 0, count = 1;
    std::array<double, 3> weight{1.0, 0.0, 0.0};
};

std::vector<Taps> tapsOf(uint32_t size) {
    const uint32_t half = std::max(size / 2, 1u);
    std::vector<Taps> taps(half);
    for (uint32_t i = 0; size > 1 && i < half; ++i) {
        const double whole = double(size);
        taps[i].first = 2 * i;
        if (size % 2 == 0) {
            taps[i].count = 2;
            taps[i].weight = {0.5, 0.5, 0.0};
        } else {
            taps[i].count = 3;
            taps[i].weight = {double(half - i) / whole, double(half) / whole,
                              double(i + 1) / whole};
        }
    }
    return taps;
}

/// One mip level in full precision.
template <size_t N>
struct Plane {
    uint32_t width = 0, height = 0;
    std::vector<std::array<double, N>> texels;
    const std::array<double, N>& operator()(uint32_t x, uint32_t y) const {
        return texels[size_t(y) * width + x];
    }
};

/// shrink() of even sizes: weights of ½ and ¼ are exact, so one multiplication at the end gives the
/// same bits.
template <size_t N, class Fetch>
Plane<N> halve(uint32_t width, uint32_t height, const Fetch& fetch) {
    Plane<N> out{width / 2, height / 2, {}};
    out.texels.resize(size_t(out.width) * out.height);
    std::array<double, N>* to = out.texels.data();
    for (uint32_t y = 0; y < height; y += 2) {
        for (uint32_t x = 0; x < width; x += 2, ++to) {
            const std::array<double, N> a = fetch(x, y), b = fetch(x + 1, y);
            const std::array<double, N> c = fetch(x, y + 1), d = fetch(x + 1, y + 1);
            for (size_t i = 0; i < N; ++i) {
                (*to)[i] = ((a[i] + b[i]) + (c[i] + d[i])) * 0.25;
            }
        }
    }
    return out;
}

/// The next level of a width × height level that `fetch(x, y)` reads.
template <size_t N, class Fetch>
Plane<N> shrink(uint32_t width, uint32_t height, const Fetch& fetch) {
    if (width % 2 == 0 && height % 2 == 0) {
        return halve<N>(width, height, fetch);
    }
    const std::vector<Taps> columns = tapsOf(width), rows = tapsOf(height);
    Plane<N> out{uint32_t(columns.size()), uint32_t(rows.size()), {}};
    out.texels.reserve(columns.size() * rows.size());
    for (const Taps& row : rows) {
        for (const Taps& column : columns) {
            std::array<double, N> sum{};
            for (uint32_t j = 0; j < row.count; ++j) {
                std::array<double, N> line{};
                for (uint32_t i = 0; i < column.count; ++i) {
                    const std::array<double, N> texel = fetch(column.first + i, row.first + j);
                    for (size_t c = 0; c < N; ++c) {
                        line[c] += column.weight[i] * texel[c];
                    }
                }
                for (size_t c = 0; c < N; ++c) {
                    sum[c] += row.weight[j] * line[c];
                }
            }
            out.texels.push_back(sum);
        }
    }
    return out;
}

/// Sizes of the whole chain, and offsets while the texture is made: without borders, until
/// layOut().
std::vector<TextureLevel> levelsOf(uint32_t width, uint32_t height) {
    std::vector<TextureLevel> levels;
    uint32_t offset = 0;
    while (true) {
        levels.push_back({width, height, offset});
        if (width == 1 && height == 1) {
            return levels;
        }
        offset += width * height;
        width = std::max(width / 2, 1u);
        height = std::max(height / 2, 1u);
    }
}

uint32_t pack(uint32_t r, uint32_t g, uint32_t b) {
    return r | g << 10 | b << 20;
}

/// Calls store(level, plane) for the levels from 1 on; `level0(x, y)` reads level 0.
template <size_t N, class Fetch, class Store>
void forEachMip(const std::vector<TextureLevel>& levels, const Fetch& level0, const Store& store) {
    Plane<N> plane;
    for (size_t k = 1; k < levels.size(); ++k) {
        const TextureLevel& above = levels[k - 1];
        plane = k == 1 ? shrink<N>(above.width, above.height, level0)
                       : shrink<N>(above.width, above.height, plane);
        store(levels[k], plane);
    }
}

/// Levels from 1 on of a texture of three channels.
template <class Fetch, class Encode>
void addMips(Texture& texture, const Fetch& level0, const Encode& encode) {
    forEachMip<3>(texture.levels, level0, [&](const TextureLevel& level, const Plane<3>& plane) {
        uint32_t* out = texture.texels.data() + level.offset;
        for (const std::array<double, 3>& t : plane.texels) {
            *out++ = pack(encode(t[0]), encode(t[1]), encode(t[2]));
        }
    });
}

Texture emptyTexture(ImageView<const Rgba8> image, Wrap wrap) {
    assert(!image.empty());
    Texture texture;
    texture.wrap = wrap;
    texture.levels = levelsOf(uint32_t(image.width), uint32_t(image.height));
    texture.texels.resize(size_t{texture.levels.back().offset} + 1);
    return texture;
}

/// A texture whose channels are read through `decode` and written by `encode`.
template <class Encode>
Texture makeFromBytes(ImageView<const Rgba8> image, Wrap wrap, const ByteTable& decode,
                      const Encode& encode) {
    std::array<uint32_t, 256> code;
    for (size_t c = 0; c < 256; ++c) {
        code[c] = encode(decode[c]);
    }
    Texture texture = emptyTexture(image, wrap);
    uint32_t* out = texture.texels.data();
    for (int y = 0; y < image.height; ++y) {
        const Rgba8* row = image.row(y);
        for (int x = 0; x < image.width; ++x) {
            *out++ = pack(code[row[x].r], code[row[x].g], code[row[x].b]);
        }
    }
    const auto fetch = [&](uint32_t x, uint32_t y) {
        const Rgba8& p = image.row(int(y))[x];
        return std::array<double, 3>{decode[p.r], decode[p.g], decode[p.b]};
    };
    addMips(texture, fetch, encode);
    layOut(texture);
    return texture;
}

/// Neighbour `i + step`, wrapped or clamped to [0, size).
int neighbour(int i, int step, int size, Wrap wrap) {
    const int n = i + step;
    if (wrap == Wrap::clamp) {
        return std::clamp(n, 0, size - 1);
    }
    return (n + size) % size;
}

/// Unit normals of a height field, as (component + 1) / 2.
Plane<3> normalsOfHeights(ImageView<const Rgba8> image, Wrap wrap, double scale) {
    Plane<3> plane{uint32_t(image.width), uint32_t(image.height), {}};
    plane.texels.reserve(size_t(image.width) * size_t(image.height));
    const double per_texel = scale / (2.0 * 255.0);
    for (int y = 0; y < image.height; ++y) {
        const Rgba8* row = image.row(y);
        const Rgba8* up = image.row(neighbour(y, -1, image.height, wrap));
        const Rgba8* down = image.row(neighbour(y, 1, image.height, wrap));
        for (int x = 0; x < image.width; ++x) {
            const int left = row[neighbour(x, -1, image.width, wrap)].r;
            const int right = row[neighbour(x, 1, image.width, wrap)].r;
            const double slope_x = double(right - left) * per_texel;
            const double slope_y = double(int(up[x].r) - int(down[x].r)) * per_texel;
            const double length = std::sqrt((slope_x * slope_x + slope_y * slope_y) + 1.0);
            plane.texels.push_back({(1.0 - slope_x / length) * 0.5, (1.0 - slope_y / length) * 0.5,
                                    (1.0 + 1.0 / length) * 0.5});
        }
    }
    return plane;
}

/// Alpha at and above which a texel counts as covered.
constexpr int kAlphaHalf = 128;

/// The value T in 1 … 256 for which the number of bytes ≥ T comes nearest to `wanted`; among equals
/// the one that covers more, then the one nearest to kAlphaHalf (least change).
int coverageThreshold(const std::vector<uint8_t>& alpha, double wanted) {
    std::array<uint32_t, 257> covered{};
    for (const uint8_t a : alpha) {
        ++covered[a];
    }
    for (int t = 255; t >= 0; --t) {
        covered[size_t(t)] += covered[size_t(t) + 1];
    }
    int best = kAlphaHalf;
    const auto better = [&](int a, int b) {
        const double miss_a = std::abs(double(covered[size_t(a)]) - wanted);
        const double miss_b = std::abs(double(covered[size_t(b)]) - wanted);
        if (miss_a != miss_b) {
            return miss_a < miss_b;
        }
        if (covered[size_t(a)] != covered[size_t(b)]) {
            return covered[size_t(a)] > covered[size_t(b)];
        }
        return std::abs(a - kAlphaHalf) < std::abs(b - kAlphaHalf);
    };
    for (int t = 1; t <= 256; ++t) {
        best = better(t, best) ? t : best;
    }
    return best;
}

/// Share of the area whose bilinearly filtered alpha is at least one half, by four points a texel.
double filteredCoverage(const uint8_t* alpha, const TextureLevel& level, Wrap wrap) {
    const int width = int(level.width), height = int(level.height);
    size_t covered = 0;
    for (int y = 0; y < height; ++y) {
        const uint8_t* rows[3];
        for (int dy = -1; dy <= 1; ++dy) {
            rows[dy + 1] = alpha + size_t(neighbour(y, dy, height, wrap)) * level.width;
        }
        for (int x = 0; x < width; ++x) {
            const int left = neighbour(x, -1, width, wrap), right = neighbour(x, 1, width, wrap);
            for (const uint8_t* other : {rows[0], rows[2]}) {
                for (const int beside : {left, right}) {
                    const int sum =
                        9 * rows[1][x] + 3 * (rows[1][beside] + other[x]) + other[beside];
                    covered += 2 * sum >= 16 * 255 ? 1 : 0;
                }
            }
        }
    }
    return double(covered) / (4.0 * width * height);
}

/// Whether a level may stand for the first one: neither its covered nor its open share is off by
/// more than a tenth. Beyond that a chain-link fence would vanish, or turn into a wall.
bool keepsCoverage(double coverage, double wanted) {
    return std::abs(coverage - wanted) <= 0.1 * std::min(wanted, 1.0 - wanted) + 0.005;
}

/// Scales so that bytes ≥ `threshold`, and only those, become ≥ kAlphaHalf: rounds a · 128 / T.
void scaleAlpha(std::vector<uint8_t>& alpha, int threshold) {
    for (uint8_t& a : alpha) {
        const int scaled = (2 * kAlphaHalf * int(a) + threshold) / (2 * threshold);
        a = uint8_t(std::min(scaled, 255));
    }
}

}  // namespace

Texture makeColourTexture(ImageView<const Rgba8> image, Wrap wrap) {
    return makeFromBytes(image, wrap, srgbToLinear(), encodeGamma2);
}

Texture makeNormalTexture(ImageView<const Rgba8> image, Wrap wrap) {
    return makeFromBytes(image, wrap, byteToUnit(), encodeUnit);
}

Texture makeNormalTextureFromHeight(ImageView<const Rgba8> image, Wrap wrap, float bump_scale) {
    assert(std::isfinite(bump_scale));
    Texture texture = emptyTexture(image, wrap);
    const Plane<3> normals = normalsOfHeights(image, wrap, bump_scale);
    uint32_t* out = texture.texels.data();
    for (const std::array<double, 3>& n : normals.texels) {
        *out++ = pack(encodeUnit(n[0]), encodeUnit(n[1]), encodeUnit(n[2]));
    }
    addMips(texture, normals, encodeUnit);
    layOut(texture);
    return texture;
}

uint8_t luminance(const Rgba8& pixel) {
    return uint8_t((54 * pixel.r + 183 * pixel.g + 19 * pixel.b + 128) >> 8);
}

AlphaTexture makeHeightTexture(ImageView<const Rgba8> image, Wrap wrap) {
    Image<Rgba8> heights(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        const Rgba8* row = image.row(y);
        std::transform(row, row + image.width, heights.view().row(y), [](const Rgba8& pixel) {
            return Rgba8{pixel.r, pixel.g, pixel.b, luminance(pixel)};
        });
    }
    return makeAlphaTexture(heights.view(), wrap, false);
}

AlphaTexture makeAlphaTexture(ImageView<const Rgba8> image, Wrap wrap, bool preserve_coverage) {
    assert(!image.empty());
    AlphaTexture texture;
    texture.wrap = wrap;
    texture.levels = levelsOf(uint32_t(image.width), uint32_t(image.height));
    texture.texels.resize(size_t{texture.levels.back().offset} + 1);
    const size_t count = size_t(image.width) * size_t(image.height);
    size_t covered = 0;
    uint8_t* out = texture.texels.data();
    for (int y = 0; y < image.height; ++y) {
        const Rgba8* row = image.row(y);
        for (int x = 0; x < image.width; ++x) {
            *out++ = row[x].a;
            covered += row[x].a >= kAlphaHalf;
        }
    }
    const auto fetch = [&](uint32_t x, uint32_t y) {
        return std::array<double, 1>{double(image.row(int(y))[x].a)};
    };
    // Averages go on from the unscaled values, so that the scales of the levels do not pile up.
    std::vector<uint8_t> bytes;
    const double first_coverage = filteredCoverage(texture.texels.data(), texture.levels[0], wrap);
    size_t kept = 1;
    bool ended = false;
    forEachMip<1>(texture.levels, fetch, [&](const TextureLevel& level, const Plane<1>& plane) {
        if (ended) {
            return;
        }
        bytes.clear();
        for (const std::array<double, 1>& t : plane.texels) {
            bytes.push_back(uint8_t(roundHalfUp(t[0])));
        }
        if (preserve_coverage) {
            const double wanted = double(covered) * double(bytes.size()) / double(count);
            scaleAlpha(bytes, coverageThreshold(bytes, wanted));
            ended = !keepsCoverage(filteredCoverage(bytes.data(), level, wrap), first_coverage);
            if (ended) {
                return;
            }
        }
        ++kept;
        std::copy(bytes.begin(), bytes.end(), texture.texels.begin() + level.offset);
    });
    texture.levels.resize(kept);
    layOut(texture);
    return texture;
}

}  // namespace still
