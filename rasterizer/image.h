#pragma once
// Pixel planes: one owning type and one view. Everything that touches pixels takes views.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

namespace still {

/// A window onto a plane of pixels it does not own. Row 0 is the top row, x grows to the right.
/// `stride` counts elements, not bytes. `const` in T shows the direction of data.
template <class T>
struct ImageView {
    T* data = nullptr;
    int width = 0;
    int height = 0;
    ptrdiff_t stride = 0;

    T* row(int y) const { return data + ptrdiff_t{y} * stride; }
    T& at(int x, int y) const {
        assert(x >= 0 && x < width && y >= 0 && y < height);
        return row(y)[x];
    }
    bool empty() const { return width == 0 || height == 0; }
    operator ImageView<const T>() const { return {data, width, height, stride}; }
};

/// Rows are padded to a multiple of this many elements, so a kernel may read and write whole
/// vectors, and whole tiles, past the right edge. What stands in the padding is unspecified.
#if STILL_BOARD
constexpr int kRowPadding = 8;  // only SIMD kernels take whole vectors
#else
constexpr int kRowPadding = 64;
#endif

/// Elements that a row takes, its padding included.
constexpr ptrdiff_t rowStride(int width) {
    return (ptrdiff_t{width} + kRowPadding - 1) / kRowPadding * kRowPadding;
}
/// Elements that a plane takes.
constexpr size_t planeElements(int width, int height) {
    return size_t(rowStride(width)) * size_t(height) + 2 * kRowPadding;
}
constexpr size_t kPlaneAlignment = 64;  ///< a cache line

/// Memory for a plane, from the start of a cache line.
struct PlaneMemory {
    void* data = nullptr;
    size_t mapped_bytes = 0;  ///< 0: it comes from operator new
};
/// Zeros. Large planes get the system's own zero pages, which cost neither time nor memory before
/// they are touched.
PlaneMemory allocateZeros(size_t bytes);
void freePlane(PlaneMemory memory);

/// Owns one plane. Elements before the first row and after the last one (kRowPadding each) may be
/// read, so that a 3×3 window may be loaded without a test and masked afterwards.
template <class T>
class Image {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Image() = default;
    Image(int width, int height) { resize(width, height); }

    /// Sets the size; the contents become zero when the size changes and stay when it does not.
    void resize(int width, int height) {
        assert(width >= 0 && height >= 0);
        if (width == width_ && height == height_) {
            return;
        }
        *this = Image();  // first, so that there are never two planes
        const PlaneMemory memory = allocateZeros(planeElements(width, height) * sizeof(T));
        memory_ = Memory(static_cast<T*>(memory.data), {memory.mapped_bytes});
        stride_ = rowStride(width);
        width_ = width;
        height_ = height;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    bool empty() const { return width_ == 0 || height_ == 0; }
    size_t bytes() const { return size_t(stride_) * size_t(height_) * sizeof(T); }
    ImageView<T> view() { return {memory_.get() + kRowPadding, width_, height_, stride_}; }
    ImageView<const T> view() const {
        return {memory_.get() + kRowPadding, width_, height_, stride_};
    }
    T& at(int x, int y) { return view().at(x, y); }
    const T& at(int x, int y) const { return view().at(x, y); }

  private:
    struct Free {
        size_t mapped_bytes = 0;
        void operator()(T* p) const { freePlane({static_cast<void*>(p), mapped_bytes}); }
    };
    using Memory = std::unique_ptr<T, Free>;
    Memory memory_;
    int width_ = 0;
    int height_ = 0;
    ptrdiff_t stride_ = 0;
};

/// One output pixel, sRGB-encoded, 8 bits a channel, no padding between pixels.
struct Rgb8 {
    uint8_t r = 0, g = 0, b = 0;
    friend bool operator==(const Rgb8&, const Rgb8&) = default;
};
static_assert(sizeof(Rgb8) == 3);

}  // namespace still
