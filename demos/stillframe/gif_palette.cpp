#include "demos/stillframe/gif_palette.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace still::command {
namespace {

constexpr int kBits = 5;
constexpr int kCells = 1 << (3 * kBits);
constexpr int kDitherRange = 12;  ///< a pixel is shifted by up to half of it either way

constexpr uint16_t cellOf(int r, int g, int b) {
    constexpr int kShift = 8 - kBits;
    return uint16_t((r >> kShift) << (2 * kBits) | (g >> kShift) << kBits | b >> kShift);
}

constexpr int channel(uint16_t cell, int axis) {
    return cell >> ((2 - axis) * kBits) & ((1 << kBits) - 1);
}

/// What the pixels of a cell, or of a box of cells, add up to.
struct Sums {
    uint64_t count = 0, r = 0, g = 0, b = 0;

    void add(const Sums& s) {
        count += s.count;
        r += s.r;
        g += s.g;
        b += s.b;
    }
    Rgb8 mean() const {
        const auto rounded = [&](uint64_t sum) { return uint8_t((sum + count / 2) / count); };
        return {rounded(r), rounded(g), rounded(b)};
    }
};

using Histogram = std::vector<Sums>;

Histogram histogramOf(ImageView<const Rgb8> image) {
    Histogram histogram(kCells);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Rgb8 c = image.at(x, y);
            histogram[cellOf(c.r, c.g, c.b)].add({1, c.r, c.g, c.b});
        }
    }
    return histogram;
}

/// Some of the used cells, and the axis along which they spread most.
struct Box {
    std::span<uint16_t> cells;
    uint64_t pixels = 0;
    int axis = 0;
    int extent = 0;

    Box(std::span<uint16_t> cells_in, const Histogram& histogram) : cells(cells_in) {
        for (int a = 0; a < 3; ++a) {
            const auto [low, high] = std::minmax_element(
                cells.begin(), cells.end(),
                [a](uint16_t p, uint16_t q) { return channel(p, a) < channel(q, a); });
            const int spread = channel(*high, a) - channel(*low, a);
            if (spread > extent) {
                extent = spread;
                axis = a;
            }
        }
        for (uint16_t cell : cells) {
            pixels += histogram[cell].count;
        }
    }
    /// Boxes that matter most are cut first: many pixels, far apart. Zero for a single cell.
    uint64_t weight() const { return pixels * uint64_t(extent * extent); }
};

/// Sorts the box along its axis (then by the cell number: keys are unique) and returns how many
/// cells make up half of its pixels; both halves get at least one cell.
size_t medianCut(const Box& box, const Histogram& histogram) {
    std::sort(box.cells.begin(), box.cells.end(), [&](uint16_t p, uint16_t q) {
        const int cp = channel(p, box.axis);
        const int cq = channel(q, box.axis);
        return cp != cq ? cp < cq : p < q;
    });
    uint64_t below = 0;
    size_t cut = 0;
    while (cut + 1 < box.cells.size() && (cut == 0 || 2 * below < box.pixels)) {
        below += histogram[box.cells[cut]].count;
        ++cut;
    }
    return cut;
}

/// Offsets 0 … 63 of the 8 × 8 Bayer matrix: the bits of x ^ y and y, interleaved and reversed.
constexpr int bayer(int x, int y) {
    int value = 0;
    for (int bit = 0; bit < 3; ++bit) {
        value |= (((x ^ y) >> bit) & 1) << (5 - 2 * bit);
        value |= ((y >> bit) & 1) << (4 - 2 * bit);
    }
    return value;
}

Rgb8 centreOf(uint16_t cell) {
    constexpr int kStep = 1 << (8 - kBits);
    const auto centre = [&](int axis) { return uint8_t(channel(cell, axis) * kStep + kStep / 2); };
    return {centre(0), centre(1), centre(2)};
}

int nearest(const GifPalette& palette, Rgb8 colour) {
    int best = 0;
    int best_distance = 4 * 256 * 256;
    for (int i = 0; i < palette.count; ++i) {
        const Rgb8 c = palette.colours[size_t(i)];
        const int dr = c.r - colour.r;
        const int dg = c.g - colour.g;
        const int db = c.b - colour.b;
        const int distance = dr * dr + dg * dg + db * db;
        if (distance < best_distance) {
            best_distance = distance;
            best = i;
        }
    }
    return best;
}

/// Colours that the palette has as they are, ascending, with their indices.
class ExactColours {
  public:
    explicit ExactColours(const GifPalette& palette) {
        for (int i = 0; i < palette.count; ++i) {
            entries_.push_back({keyOf(palette.colours[size_t(i)]), i});
        }
        std::sort(entries_.begin(), entries_.end());
    }
    /// -1: has not.
    int find(Rgb8 colour) const {
        const uint32_t key = keyOf(colour);
        const auto at = std::lower_bound(entries_.begin(), entries_.end(), std::pair(key, 0));
        return at != entries_.end() && at->first == key ? at->second : -1;
    }

  private:
    static uint32_t keyOf(Rgb8 c) { return uint32_t(c.r) << 16 | uint32_t(c.g) << 8 | c.b; }

    std::vector<std::pair<uint32_t, int>> entries_;
};

}  // namespace

GifPalette choosePalette(ImageView<const Rgb8> image) {
    const Histogram histogram = histogramOf(image);
    std::vector<uint16_t> cells;
    for (int cell = 0; cell < kCells; ++cell) {
        if (histogram[size_t(cell)].count > 0) {
            cells.push_back(uint16_t(cell));
        }
    }
    GifPalette palette;
    std::vector<Box> boxes{Box(cells, histogram)};
    while (boxes.size() < palette.colours.size()) {
        const auto largest =
            std::max_element(boxes.begin(), boxes.end(),
                             [](const Box& p, const Box& q) { return p.weight() < q.weight(); });
        if (largest->weight() == 0) {
            break;
        }
        const size_t cut = medianCut(*largest, histogram);
        const Box upper(largest->cells.subspan(cut), histogram);
        *largest = Box(largest->cells.first(cut), histogram);
        boxes.push_back(upper);
    }
    for (const Box& box : boxes) {
        Sums sums;
        for (uint16_t cell : box.cells) {
            sums.add(histogram[cell]);
        }
        palette.colours[size_t(palette.count++)] = sums.mean();
    }
    return palette;
}

std::vector<uint8_t> applyPalette(ImageView<const Rgb8> image, const GifPalette& palette) {
    constexpr int16_t kUnknown = -1;
    const ExactColours exact(palette);
    const Histogram histogram = histogramOf(image);
    std::vector<int16_t> index_of(kCells, kUnknown);
    std::vector<uint8_t> indices(size_t(image.width) * size_t(image.height));
    size_t at = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const int shift = (2 * bayer(x & 7, y & 7) - 63) * kDitherRange / 128;
            const auto dithered = [&](int value) { return std::clamp(value + shift, 0, 255); };
            const Rgb8 c = image.at(x, y);
            if (const int index = exact.find(c); index >= 0) {
                indices[at++] = uint8_t(index);
                continue;
            }
            const uint16_t cell = cellOf(dithered(c.r), dithered(c.g), dithered(c.b));
            if (index_of[cell] == kUnknown) {
                const Sums& sums = histogram[cell];
                const Rgb8 meant = sums.count > 0 ? sums.mean() : centreOf(cell);
                index_of[cell] = int16_t(nearest(palette, meant));
            }
            indices[at++] = uint8_t(index_of[cell]);
        }
    }
    return indices;
}

}  // namespace still::command
