// The story of the picked pixel: lines with the colours they are about, and the plot.

#include <imgui.h>

#include "demos/inspect/story_text.h"
#include "demos/viewer/panels.h"

namespace still::viewer {
namespace {

void storyLine(const inspect::StoryLine& line) {
    if (line.heading) {
        ImGui::Spacing();
        ImGui::TextColored({1.0f, 0.85f, 0.4f, 1.0f}, "%s", line.text.c_str());
        return;
    }
    if (line.swatch) {
        const float side = ImGui::GetTextLineHeight();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled(
            at, {at.x + side, at.y + side},
            IM_COL32(line.swatch->r, line.swatch->g, line.swatch->b, 255));
        ImGui::Dummy({side, side});
        ImGui::SameLine();
    }
    ImGui::TextUnformatted(line.text.c_str());
}

}  // namespace

void showStoryPanel(Desk& desk) {
    if (!desk.shown.story) {
        return;
    }
    ImGui::SetNextWindowPos({8, 60}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({desk.width >= 1280 ? 620.0f : 470.0f, 520}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Pixel", &desk.shown.story, ImGuiWindowFlags_HorizontalScrollbar)) {
        const std::optional<inspect::PickedStory> story = desk.session.pickedStory();
        if (!story) {
            ImGui::TextUnformatted("Click a pixel.");
        } else {
            for (const inspect::StoryLine& line : inspect::storyLines(*story)) {
                storyLine(line);
            }
            if (story->taa) {
                constexpr int kSide = 220;
                desk.plot = inspect::storyPlot(*story, kSide);
                desk.plot_view = desk.plot.view();
                ImGui::Image(&desk.plot_view, {2.0f * kSide, kSide});
            }
        }
    }
    ImGui::End();
}

}  // namespace still::viewer
