#pragma once
// stillframe chart

#include "demos/stillframe/atlas_options.h"
#include "demos/stillframe/interruption.h"

namespace still::command {

/// Measures time against error and writes chart.json, chart.csv and, for each scene and number of
/// threads, SCENE-N-threads.svg and .png into the output folder.
Outcome<void> chart(const ChartOptions& options, Interruption& interruption);

}  // namespace still::command
