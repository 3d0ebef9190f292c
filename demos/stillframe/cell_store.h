#pragma once
// Measures of a cell, and times of a race, as bytes for the cache, and back.

#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/cell.h"
#include "demos/stillframe/race.h"

namespace still::command {

std::string cellBytes(const std::vector<SegmentMeasures>& segments);

/// Nothing when the bytes are not what cellBytes() wrote.
std::optional<std::vector<SegmentMeasures>> cellFromBytes(const std::string& bytes);

std::string timesBytes(const std::vector<SegmentTimes>& segments);
/// The same for timesBytes().
std::optional<std::vector<SegmentTimes>> timesFromBytes(const std::string& bytes);

}  // namespace still::command
