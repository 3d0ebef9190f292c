#pragma once
// stillframe render

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/options.h"

namespace still::command {

/// Checks the options, loads, renders, writes, reports; with --watch again and again. The value is
/// ExitCode::differs when a frame differs from its reference.
Outcome<ExitCode> render(const RenderOptions& options, Interruption& interruption);

}  // namespace still::command
