#pragma once
// Triangles of every difficult kind, for comparison with the oracle.

#include <array>

#include "tests/support/test_scene.h"

namespace still::test {

/// In pixels: for views whose view_projection is the identity (w = 1 everywhere).
enum class FlatKind {
    ordinary,    ///< about as large as the picture
    sliver,      ///< much longer than wide, down to nothing
    sub_pixel,   ///< smaller than two pixels
    huge,        ///< corners anywhere in the guard band
    on_samples,  ///< corners on pixel centres and pixel corners
    degenerate,  ///< no area, or next to none
    guard_left,  ///< a corner beyond the guard band, on each side
    guard_right,
    guard_top,
    guard_bottom,
};
inline constexpr std::array kFlatKinds{
    FlatKind::ordinary,   FlatKind::sliver,      FlatKind::sub_pixel,  FlatKind::huge,
    FlatKind::on_samples, FlatKind::degenerate,  FlatKind::guard_left, FlatKind::guard_right,
    FlatKind::guard_top,  FlatKind::guard_bottom};

/// In space: for deepView().
enum class DeepKind {
    in_front,  ///< all corners before the camera
    near,      ///< about the near plane, some corners behind it
    across,    ///< from far behind the camera to far before it
    behind,    ///< nothing is visible
    vast,      ///< from a hair's breadth to far beyond the far plane, in all directions
};
inline constexpr std::array kDeepKinds{DeepKind::in_front, DeepKind::near, DeepKind::across,
                                       DeepKind::behind, DeepKind::vast};

/// Width × height with the identity as projection, and a random jitter.
FrameView flatView(int width, int height, Random& random);
/// The same with a perspective of near 0.1 and far 1000.
FrameView deepView(int width, int height, Random& random);

void addFlat(TestScene& scene, const FrameView& view, FlatKind kind, Random& random);
void addDeep(TestScene& scene, DeepKind kind, Random& random);

}  // namespace still::test
