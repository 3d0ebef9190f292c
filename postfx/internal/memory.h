#pragma once
// What the gather remembers between frames beside the picture: a slot of the ring, and of each tile
// how far it has come.

#include <array>
#include <vector>

#include "postfx/internal/ring.h"
#include "rasterizer/image.h"

namespace still::taa {

struct SlotPlanes {
    enum Plane { red, green, blue, id, depth, owner_depth, owner, motion_x, motion_y, normal };
    std::array<Image<int16_t>, normal + 1> planes;
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;
    std::vector<TileJitter> tile_jitter;
    bool apart = false;  ///< some tiles' samples lie otherwise: they rested

    void resize(int width, int height) {
        for (Image<int16_t>& plane : planes) {
            plane.resize(width, height);
        }
    }
    /// As a SlotOut or a SlotIn.
    template <class Pointers>
    Pointers pointers() {
        const auto of = [&](Plane plane) { return planes[plane].view().data; };
        return {.colour = {of(red), of(green), of(blue)},
                .id = of(id),
                .depth = of(depth),
                .owner_depth = of(owner_depth),
                .owner = of(owner),
                .motion = {of(motion_x), of(motion_y)},
                .normal = of(normal),
                .jitter_x_fx8 = jitter_x_fx8,
                .jitter_y_fx8 = jitter_y_fx8,
                .tile_jitter = apart ? tile_jitter.data() : nullptr};
    }
};

/// What is remembered of a tile between frames.
struct TileMemory {
    bool summed = false;    ///< its sums are of the present view
    bool finished = false;  ///< … and complete
    bool settled = false;   ///< … and all shown
    bool changed = true;    ///< the last frame changed the picture
    bool tested = true;     ///< something moved or changed here in this frame
    bool young = false;     ///< light has not been as it is for as long as the past goes back
    bool keeps = true;      ///< this frame's samples go into the ring
    bool adds = false;      ///< … and were added to its sums
    int quiet = 0;          ///< frames kept since it was tested, up to the ring's length
};

}  // namespace still::taa
