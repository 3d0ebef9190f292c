#pragma once
// Textures painted by code, all of them tileable. Colours are sRGB-encoded, as in an image file.

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/texture.h"

namespace still::scenes {

/// Courses of blocks in running bond over one tile of texture.
struct Bond {
    int columns = 5, rows = 16;     ///< rows even, so that the tile repeats
    double joint = 0.1;             ///< width of the joints as a share of a row's height
    double aspect = 3.2;            ///< a block's length : height on the surface
    glm::dvec3 block{150, 84, 62};  ///< colour
    glm::dvec3 mortar{176, 166, 150};
    double variation = 0.18;  ///< brightness from block to block, ±
    double relief = 1.0;      ///< slope of the joints in the normal map
    uint32_t seed = 1;
};
Texture paintBond(const Bond& bond, int size);
/// Normal map that fits paintBond() of the same bond.
Texture paintBondRelief(const Bond& bond, int size);
/// Height map that fits it: blocks at the top, joints at the bottom.
AlphaTexture paintBondHeight(const Bond& bond, int size);

/// `cells` × `cells` polished slabs, light and dark in turn, each with its own veins.
struct Checker {
    int cells = 8;
    glm::dvec3 light{226, 216, 198}, dark{104, 92, 88};
    uint32_t seed = 1;
};
Texture paintChecker(const Checker& checker, int size);

/// Cloudy surface: plaster, stone, clay, grass. `amount` is how far colours go from a to b.
struct Mottle {
    glm::dvec3 a{200, 190, 170}, b{180, 165, 140};
    int cells = 4;
    int octaves = 5;
    uint32_t seed = 1;
};
Texture paintMottle(const Mottle& mottle, int size);

/// Vertical boards with grain.
Texture paintBoards(int boards, const glm::dvec3& colour, uint32_t seed, int size);

/// Stripes along u between two colours.
Texture paintStripes(int stripes, const glm::dvec3& a, const glm::dvec3& b, int size);

/// Ripples of water as a normal map; slopes up to about `slope`.
Texture paintRipples(double slope, uint32_t seed, int size);

/// Sky over a half dome: u once around, v from the horizon to the zenith. Blue that fades into
/// haze, with clouds on a level sheet overhead.
Texture paintSky(uint32_t seed, int width, int height);

/// Chain link: wires along both diagonals, `cells` × `cells` meshes; `wire` is a wire's width as a
/// share of a mesh's diagonal. The chain of levels ends while a wire is still wider than a texel:
/// an alpha test on anything coarser would show all or nothing instead of a share of the samples.
AlphaTexture paintChainLink(int cells, double wire, int size);

/// 2 × 2 clusters of pointed leaves. Colour and alpha belong together.
Texture paintLeafColours(const glm::dvec3& young, const glm::dvec3& old, uint32_t seed, int size);
AlphaTexture paintLeafShapes(uint32_t seed, int size);

}  // namespace still::scenes
