#include "engine/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <type_traits>
#include <vector>

namespace still {
namespace {

// Hashes are of numbers as little-endian machines keep them.
constexpr bool kAsKept = std::endian::native == std::endian::little;

template <class T>
T littleEndian(T value) {
    if constexpr (kAsKept || std::is_same_v<T, Rgb8>) {
        return value;
    } else if constexpr (std::is_same_v<T, Motion>) {
        return {littleEndian(value.x_fx8), littleEndian(value.y_fx8)};
    } else {
        static_assert(std::is_integral_v<T>);
        auto bytes = std::bit_cast<std::array<uint8_t, sizeof(T)>>(value);
        std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<T>(bytes);
    }
}

/// Feeds sizes and rows; never the padding between rows.
class PlaneHasher {
  public:
    PlaneHasher() { XXH3_64bits_reset(&state_); }

    template <class T>
    void add(ImageView<const T> plane) {
        static_assert(std::has_unique_object_representations_v<T>, "padding would be hashed");
        const std::array<int32_t, 2> size{plane.width, plane.height};
        addRow(size.data(), size.size());
        for (int y = 0; y < plane.height; ++y) {
            addRow(plane.row(y), size_t(plane.width));
        }
    }
    uint64_t digest() const { return XXH3_64bits_digest(&state_); }

  private:
    template <class T>
    void addRow(const T* row, size_t count) {
        std::vector<T> swapped;
        if constexpr (!kAsKept) {
            std::transform(row, row + count, std::back_inserter(swapped),
                           [](T value) { return littleEndian(value); });
            row = swapped.data();
        }
        XXH3_64bits_update(&state_, row, count * sizeof(T));
    }

    XXH3_state_t state_;
};

}  // namespace

template <class T>
uint64_t hashPlane(ImageView<const T> plane) {
    PlaneHasher hasher;
    hasher.add(plane);
    return hasher.digest();
}

template uint64_t hashPlane(ImageView<const uint8_t>);
template uint64_t hashPlane(ImageView<const uint16_t>);
template uint64_t hashPlane(ImageView<const uint32_t>);
template uint64_t hashPlane(ImageView<const Motion>);
template uint64_t hashPlane(ImageView<const Rgb8>);

FrameHashes hashFrame(ImageView<const Rgb8> output, const GBuffer& gbuffer) {
    PlaneHasher color;
    color.add(gbuffer.red.view());
    color.add(gbuffer.green.view());
    color.add(gbuffer.blue.view());
    FrameHashes hashes{.output = hashPlane(output),
                       .color = color.digest(),
                       .depth = hashPlane(gbuffer.depth.view()),
                       .id = hashPlane(gbuffer.id.view())};
    if (gbuffer.planes.normal) {
        hashes.normal = hashPlane(gbuffer.normal.view());
    }
    if (gbuffer.planes.motion) {
        PlaneHasher motion;
        motion.add(gbuffer.motion.view());
        motion.add(gbuffer.depth_before.view());
        hashes.motion = motion.digest();
    }
    return hashes;
}

uint64_t hashBytes(std::string_view bytes, uint64_t before) {
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), before);
}

std::string hex(uint64_t hash) {
    std::string text(16, '0');
    for (int digit = 15; digit >= 0; --digit, hash >>= 4) {
        text[size_t(digit)] = "0123456789abcdef"[hash & 15];
    }
    return text;
}

}  // namespace still
