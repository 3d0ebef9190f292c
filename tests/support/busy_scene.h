#pragma once
// Random pictures that use everything at once: all material kinds, textures with mip levels,
// lights, moving objects, a moving camera, triangles of every size, clipped ones.

#include "tests/support/test_scene.h"

namespace still::test {

/// An odd size, a jitter and a moving camera.
FrameView busyView(uint64_t seed);
TestScene busyScene(uint64_t seed);

/// A full mip chain whose levels have one colour each: fx10 codes r, g, b of `colours[level]`, the
/// last one repeated.
Texture levelTexture(uint32_t size, const std::vector<std::array<uint32_t, 3>>& colours, Wrap wrap);
/// A full mip chain of one value.
AlphaTexture constantAlpha(uint32_t size, uint8_t value);

}  // namespace still::test
