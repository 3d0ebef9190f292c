#pragma once
// The atlas as one page for people: nothing is loaded from anywhere else.

#include <string>

#include "demos/stillframe/atlas_report.h"

namespace still::command {

/// A heat map of cases × ways of anti-aliasing with any measure; touching a cell shows where it is
/// worst, at 400 %, and its error frame by frame.
std::string atlasPage(const AtlasReport& report);

}  // namespace still::command
