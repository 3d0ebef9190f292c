#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <utility>
#include <vector>

#include "rasterizer/image.h"

using namespace still;

namespace {

template <class T>
bool isZero(const Image<T>& image) {
    const T* first = image.view().data - kRowPadding;
    const size_t count = image.bytes() / sizeof(T) + 2 * kRowPadding;
    return std::all_of(first, first + count, [](T value) { return value == 0; });
}

template <class T>
void fill(Image<T>& image, T value) {
    T* first = image.view().data - kRowPadding;
    std::fill(first, first + image.bytes() / sizeof(T) + 2 * kRowPadding, value);
}

}  // namespace

TEST_CASE("image: a plane of any size is zero, padding too, and starts at a cache line",
          "[unit][rasterizer]") {
    // Up to 256 KB planes come from operator new, larger ones are mappings.
    for (const auto& [width, height] : std::vector<std::pair<int, int>>{
             {1, 1}, {63, 5}, {256, 255}, {256, 256}, {257, 256}, {1000, 700}, {1920, 1080}}) {
        Image<uint32_t> image(width, height);
        CHECK(isZero(image));
        CHECK(reinterpret_cast<uintptr_t>(image.view().row(0)) % 64 == 0);
        CHECK(reinterpret_cast<uintptr_t>(image.view().row(height - 1)) % 64 == 0);
        fill(image, ~0u);
        image.resize(width, height);
        CHECK(image.at(width - 1, height - 1) == ~0u);
        image.resize(width + 1, height);
        CHECK(isZero(image));
    }
}

TEST_CASE("image: planes may grow and shrink, move and end in any order", "[unit][rasterizer]") {
    std::vector<Image<uint8_t>> images;
    for (int round = 0; round < 40; ++round) {
        images.emplace_back(500 + round, round % 2 == 0 ? 20 : 2000);
        fill(images.back(), uint8_t(round + 1));
    }
    for (int round = 0; round < 40; round += 3) {
        images[size_t(round)].resize(700, round % 2 == 0 ? 3000 : 3);
        CHECK(isZero(images[size_t(round)]));
    }
    std::rotate(images.begin(), images.begin() + 7, images.end());
    images.erase(images.begin() + 5, images.begin() + 20);
    for (const Image<uint8_t>& image : images) {
        CHECK(image.at(0, 0) == image.at(image.width() - 1, image.height() - 1));
    }
    Image<uint8_t> taken = std::move(images[0]);
    images.clear();
    CHECK(taken.view().row(taken.height() - 1)[0] == taken.at(0, 0));
    taken.resize(0, 0);
    CHECK(taken.empty());
}
