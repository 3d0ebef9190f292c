#pragma once
// What Dear ImGui shows: each function declares one panel, or nothing when it is closed. No time
// measured by a clock is shown but by the panel of times and the line of frames per second.

#include "demos/viewer/desk.h"

namespace still::viewer {

/// All of them.
void showPanels(Desk& desk);

void showTaaPanel(Desk& desk);
void showTimesPanel(Desk& desk);
void showStoryPanel(Desk& desk);
void showHelp(Desk& desk);
/// Labels of the panes, name, frame rate, message.
void showLabels(Desk& desk);
void showTimeline(Desk& desk);

}  // namespace still::viewer
