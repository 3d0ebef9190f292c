#pragma once
// stillframe compare

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/options.h"

namespace still::command {

/// Compares two pictures, or two frame patterns over the frames that exist in the first one, and
/// prints the result. The value is ExitCode::ok when all are identical, else ExitCode::differs.
Outcome<ExitCode> compare(const CompareOptions& options, Interruption& interruption);

}  // namespace still::command
