#include "tests/stability/bounds.h"

namespace still::test {

const std::vector<StillBound>& stillBounds() {
    static const std::vector<StillBound> bounds{
        {.scene = "wires-still", .rival = "basic", .lead_db = 6, .first_lead_db = 2.1},
        {.scene = "fence-still", .rival = "basic", .lead_db = 6},
        {.scene = "zone-plate-still", .rival = "basic", .lead_db = 6, .flicker = 0.0037},
        {.scene = "leaves-still", .rival = "basic"},
        {.scene = "checker-still", .rival = "variance", .flicker = 0.0034, .first_lead_db = 2.5},
        {.scene = "sparkle-still",
         .rival = "ema-consistent",
         .flicker = 0.0042,
         .first_lead_db = 0.7},
        {.scene = "parallax-still", .rival = "basic", .first_lead_db = 2.5},
        {.scene = "glass-still", .rival = "variance"},
        {.scene = "dither-still", .rival = "basic"},
        {.scene = "hdr-still", .rival = "basic", .first_lead_db = 1.9},
        {.scene = "slivers-still", .rival = "inside", .first_lead_db = 2.7},
    };
    return bounds;
}

const std::vector<MovingBound>& movingBounds() {
    static const std::vector<MovingBound> bounds{
        {.scene = "disocclusion", .rival = "ema-consistent"},
        {.scene = "wires-sway", .rival = "variance", .sharpness_min = 0.71},
        {.scene = "wires-pan", .rival = "variance", .sharpness_min = 0.87},
        {.scene = "fence-pan", .rival = "intel", .sharpness_min = 0.86},
        {.scene = "leaves-turn", .rival = "variance"},
        {.scene = "zone-plate-slow", .rival = "ema-consistent", .sharpness_min = 0.81},
        {.scene = "zone-plate-half", .rival = "filament", .sharpness_min = 0.77},
        {.scene = "checker-slow", .rival = "variance"},
        {.scene = "checker-half", .rival = "filament"},
        {.scene = "sparkle-pan", .rival = "ema-consistent", .sharpness_max = 1.35},
        {.scene = "parallax-pan", .rival = "variance", .flip_above_raw = 0.001},
        {.scene = "rotate", .rival = "variance", .flip_above_raw = 0.004},
        {.scene = "roll", .rival = "filament", .sharpness_min = 0.87},
        {.scene = "zoom", .rival = "filament"},
        {.scene = "fast-pan", .rival = "intel", .flip_above_raw = 0.012},
        {.scene = "light-flicker",
         .rival = "filament",
         .sharpness_min = 0.72,
         .flip_above_raw = 0.002},
        {.scene = "glass-move", .rival = "inside", .sharpness_max = 1.3},
        {.scene = "dither-pan", .rival = "variance", .sharpness_min = 0.81},
        {.scene = "texture-scroll", .rival = "variance", .flip_above_raw = 0.003},
        {.scene = "screen", .rival = "variance"},
        {.scene = "moving-shadow", .rival = "variance", .flip_above_raw = 0.006},
        {.scene = "noise", .rival = "variance", .sharpness_min = 0.84, .flip_above_raw = 0.005},
        {.scene = "low-resolution", .rival = "variance"},
        {.scene = "screen-edges", .rival = "intel"},
        {.scene = "depth-pan", .rival = "variance"},
        {.scene = "hdr-move", .rival = "godot"},
        {.scene = "slivers-turn", .rival = "basic", .lead_db = -9.7, .sharpness_max = 1.3},
        {.scene = "courtyard-still", .rival = "variance"},
        {.scene = "courtyard-pan", .rival = "variance"},
        {.scene = "courtyard-orbit", .rival = "variance"},
    };
    return bounds;
}

const std::vector<EventBound>& eventBounds() {
    static const std::vector<EventBound> bounds{
        {.scene = "light-on", .flip_above_raw = 0.001},
        {.scene = "light-off", .flip_above_raw = 0.001},
        {.scene = "material-swap", .flip_above_raw = 0.002},
        {.scene = "cut", .first_lead_db = 2.5},
        {.scene = "resize", .first_lead_db = 2.3},
    };
    return bounds;
}

}  // namespace still::test
