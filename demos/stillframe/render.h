#pragma once
// stillframe render

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/options.h"

namespace still::command {

/// Checks the options, loads, renders, writes, reports.
Outcome<void> render(const RenderOptions& options, Interruption& interruption);

}  // namespace still::command
