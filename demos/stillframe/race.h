#pragma once
// What frames cost, held against each other: the ways of anti-aliasing take turns frame by frame on
// one thread, so that whatever else the machine does falls on all of them.

#include <optional>
#include <vector>

#include "demos/stillframe/cell.h"

namespace still::command {

/// Processor time of one mode's frames.
struct RaceTime {
    double ms = 0;     ///< median
    double share = 1;  ///< of the base's time for the same frame, median
};

/// One per mode; nothing for a segment of one frame, whose time is that of first allocations.
using SegmentTimes = std::optional<std::vector<RaceTime>>;

/// One per segment. `base` is one of the modes; pictures have `size`.
std::vector<SegmentTimes> race(const AtlasCase& atlas, const Scene& scene,
                               const std::vector<Mode>& modes, size_t base, Size size);

}  // namespace still::command
