// The small ones: labels, timeline, times, help.

#include "demos/viewer/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "demos/stillframe/formatted.h"

namespace still::viewer {
namespace {

constexpr float kMargin = 8;
constexpr ImU32 kErrorColour = IM_COL32(255, 110, 90, 255);
constexpr ImU32 kTextColour = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kShade = IM_COL32(0, 0, 0, 140);

/// Text on a dark ground; `from_right` tells which corner `at` is. Returns its height.
float label(ImVec2 at, const std::string& text, ImU32 colour, bool from_right = false) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float x = from_right ? at.x - size.x - 4 : at.x + 4;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    list->AddRectFilled({x - 4, at.y}, {x + size.x + 4, at.y + size.y + 4}, kShade);
    list->AddText({x, at.y + 2}, colour, text.c_str());
    return size.y + 5;
}

std::string paneText(const Desk& desk, int pane) {
    inspect::Session& session = desk.session;
    const inspect::PaneSettings& settings = session.pane(pane);
    const inspect::PaneReport& report = session.report(pane);
    std::string text = inspect::nameOf(settings.mode);
    if (settings.view != inspect::View::picture) {
        text += " - " + std::string(inspect::allViews()[size_t(settings.view)].name);
    }
    if (settings.mode.anti_aliasing == AntiAliasing::ssaa) {
        text += ", " + std::to_string(report.samples) + " samples";
    } else if (report.at_rest) {
        text += ", at rest";
    }
    if (report.psnr_db) {
        text += ", " + command::formatted("%.1f dB", *report.psnr_db);
    }
    return text;
}

struct Stage {
    const char* name;
    ImU32 colour;
};
constexpr std::array<Stage, TimeHistory::kStages> kStages{{
    {"transform, bin", IM_COL32(120, 170, 255, 255)},
    {"raster", IM_COL32(90, 210, 140, 255)},
    {"light, denoiser", IM_COL32(235, 235, 120, 255)},
    {"taa", IM_COL32(255, 190, 80, 255)},
    {"output", IM_COL32(240, 120, 180, 255)},
    {"views, overlays", IM_COL32(170, 140, 240, 255)},
    {"panels, window", IM_COL32(150, 150, 150, 255)},
}};

/// Columns of stacked stages, newest at the right; the line is the wanted time.
void timesGraph(const TimeHistory& times, double wanted_ms) {
    constexpr float kColumn = 2, kHeight = 90;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = kColumn * float(TimeHistory::kLength);
    float highest_ms = float(wanted_ms) * 1.25f;
    for (size_t i = 0; i < TimeHistory::kLength; ++i) {
        float sum = 0;
        for (const auto& stage : times.stage_ms) {
            sum += stage[i];
        }
        highest_ms = std::max(highest_ms, sum);
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(corner, {corner.x + width, corner.y + kHeight}, kShade);
    for (size_t i = 0; i < TimeHistory::kLength; ++i) {
        const float x = corner.x + kColumn * float(i);
        float below_ms = 0;
        for (size_t stage = 0; stage < TimeHistory::kStages; ++stage) {
            const float above_ms = below_ms + times.stage_ms[stage][i];
            const auto y = [&](float ms) { return corner.y + kHeight * (1 - ms / highest_ms); };
            list->AddRectFilled({x, y(above_ms)}, {x + kColumn, y(below_ms)},
                                kStages[stage].colour);
            below_ms = above_ms;
        }
    }
    const float line = corner.y + kHeight * (1 - float(wanted_ms) / highest_ms);
    list->AddRectFilled({corner.x, line}, {corner.x + width, line + 1}, kTextColour);
    ImGui::Dummy({width, kHeight});
}

}  // namespace

void showLabels(Desk& desk) {
    const auto width = float(desk.width), height = float(desk.height);
    float y = 0;
    if (desk.shown.name) {
        y += label({0, 0}, paneText(desk, 0), kTextColour);
        if (desk.session.look().split) {
            label({width, 0}, paneText(desk, 1), kTextColour, true);
        }
        const Scene& scene = desk.session.scene();
        label({0, y},
              desk.scene_name + ", " + std::to_string(scene.triangleCount()) + " triangles, " +
                  std::to_string(desk.session.renderWidth()) + " x " +
                  std::to_string(desk.session.renderHeight()),
              kTextColour);
    }
    if (desk.shown.fps) {
        const double ms = std::max(desk.times.frame_ms, 1e-3);
        label({width, desk.session.look().split ? 20.0f : 0.0f},
              command::formatted("%.1f fps, %.1f ms", 1000 / ms, ms), kTextColour, true);
    }
    if (!desk.message.empty()) {
        const float above = desk.session.lastSceneFrame() > 0 ? 70.0f : 26.0f;
        label({0, height - above}, desk.message,
              desk.message_is_error ? kErrorColour : kTextColour);
    }
}

void showTimeline(Desk& desk) {
    inspect::Session& session = desk.session;
    const int last = session.lastSceneFrame();
    if (last == 0) {
        return;
    }
    ImGui::SetNextWindowPos({kMargin, float(desk.height) - kMargin}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSize({float(desk.width) - 2 * kMargin, 0});
    if (ImGui::Begin("Time", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_NoSavedSettings)) {
        const auto button = [&](const char* text, float button_width, Action action) {
            if (ImGui::Button(text, {button_width, 0})) {
                desk.perform(action);
            }
            ImGui::SameLine();
        };
        button(session.playing() ? "pause" : "play", 50, Action::play);
        button("<", 0, Action::step_back);
        button(">", 0, Action::step_forward);
        int frame = session.sceneFrame();
        ImGui::SetNextItemWidth(-1);
        if (ImGui::SliderInt("##frame", &frame, 0, last, "frame %d",
                             ImGuiSliderFlags_AlwaysClamp)) {
            session.scrub(frame);
        }
    }
    ImGui::End();
}

void showTimesPanel(Desk& desk) {
    if (!desk.shown.times) {
        return;
    }
    ImGui::SetNextWindowPos({float(desk.width) / 2, 30}, ImGuiCond_FirstUseEver, {0.5f, 0});
    if (ImGui::Begin("Times", &desk.shown.times, ImGuiWindowFlags_AlwaysAutoResize)) {
        const TimeHistory& times = desk.times;
        ImGui::TextUnformatted(command::formatted("%.1f ms from frame to frame, %.1f fps",
                                                  times.frame_ms,
                                                  1000 / std::max(times.frame_ms, 1e-3))
                                   .c_str());
        timesGraph(times, 1000.0 / desk.wanted_fps);
        for (size_t stage = 0; stage < TimeHistory::kStages; ++stage) {
            const std::string value = command::formatted(
                "%7.2f ms  %s", double(times.stage_ms[stage].back()), kStages[stage].name);
            ImGui::PushStyleColor(ImGuiCol_Text, kStages[stage].colour);
            ImGui::TextUnformatted(value.c_str());
            ImGui::PopStyleColor();
        }
    }
    ImGui::End();
}

/// Down the left column, then down the right one.
void showKeys(int columns) {
    const std::span<const KeyBinding> bindings = keyBindings();
    const size_t rows = (bindings.size() + size_t(columns) - 1) / size_t(columns);
    if (!ImGui::BeginTable("keys", 2 * columns)) {
        return;
    }
    for (int column = 0; column < columns; ++column) {
        ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed, 75);
        ImGui::TableSetupColumn("text");
    }
    for (size_t row = 0; row < rows; ++row) {
        for (size_t i = row; i < bindings.size(); i += rows) {
            ImGui::TableNextColumn();
            ImGui::TextColored({1.0f, 0.85f, 0.4f, 1.0f}, "%s", nameOf(bindings[i].key).c_str());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(bindings[i].text.data(),
                                   bindings[i].text.data() + bindings[i].text.size());
        }
        ImGui::TableNextRow();
    }
    ImGui::EndTable();
}

void showHelp(Desk& desk) {
    if (!desk.shown.help) {
        return;
    }
    ImGui::SetNextWindowPos({float(desk.width) / 2, float(desk.height) / 2}, ImGuiCond_Always,
                            {0.5f, 0.5f});
    ImGui::SetNextWindowSize(
        {std::min(860.0f, float(desk.width) - 16), std::min(520.0f, float(desk.height) - 16)});
    if (ImGui::Begin("Keys and mouse", &desk.shown.help,
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse)) {
        for (const MouseHelp& help : mouseHelp()) {
            ImGui::TextColored({1.0f, 0.85f, 0.4f, 1.0f}, "%s", std::string(help.gesture).c_str());
            ImGui::SameLine(170);
            ImGui::TextUnformatted(help.text.data(), help.text.data() + help.text.size());
        }
        ImGui::Separator();
        showKeys(desk.width >= 840 ? 2 : 1);
    }
    ImGui::End();
}

void showPanels(Desk& desk) {
    if (!desk.shown.ui) {
        return;
    }
    showLabels(desk);
    showTimeline(desk);
    showTaaPanel(desk);
    showTimesPanel(desk);
    showStoryPanel(desk);
    showHelp(desk);
}

}  // namespace still::viewer
