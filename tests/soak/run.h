#pragma once
// Runs lives and watches them: two loops side by side, memory, repetition.

#include <cstdint>
#include <string>

#include "tests/soak/script.h"

namespace still::soak {

/// Something that is wrong on purpose, so that it is seen that the run would tell.
enum class Control {
    none,
    sample,  ///< the second loop's samples lie one further in the sequence
    drift,   ///< from cycle to cycle the scene's time goes on by one
    leak,    ///< some bytes in each cycle
};

struct Totals {
    int64_t lives = 0, frames = 0;
    int64_t restarts = 0, moves = 0, resizes = 0, cuts = 0;
    int64_t still_segments = 0;   ///< watched until their pictures were periodic …
    int64_t still_frames = 0;     ///< … and frames that were compared with those a period before
    int64_t repeated_cycles = 0;  ///< compared with the first one of their life
    int64_t live_bytes = 0;       ///< after the last life
    int64_t most_live_bytes = 0;
    int64_t resident_bytes = 0;  ///< after the last life
    uint64_t hash = 0;           ///< of all stages of all frames: the same for any engines
};

/// Adds what happened to `totals`. Empty, or the first thing that is wrong: in which frame, and if
/// it can be said, stage and tile.
std::string runLife(const Life& life, Control control, Totals& totals);

}  // namespace still::soak
