#pragma once
// Measures of a cell as bytes for the cache, and back.

#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/cell.h"

namespace still::command {

std::string cellBytes(const std::vector<SegmentMeasures>& segments);

/// Nothing when the bytes are not what cellBytes() wrote.
std::optional<std::vector<SegmentMeasures>> cellFromBytes(const std::string& bytes);

}  // namespace still::command
