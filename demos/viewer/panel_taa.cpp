// Panes, their anti-aliasing with all of its settings, overlays, resolution.

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "demos/viewer/panels.h"
#include "engine/hash.h"

namespace still::viewer {
namespace {

using inspect::Mode;
using inspect::PaneSettings;
using inspect::Session;

constexpr float kItemWidth = 170;

/// A combo box over "a|b|c" or over names; true when another one was chosen.
bool choose(const char* title, const std::vector<std::string>& names, int& chosen,
            const std::string& preview) {
    bool changed = false;
    if (ImGui::BeginCombo(title, preview.c_str())) {
        for (int i = 0; i < int(names.size()); ++i) {
            if (ImGui::Selectable(names[size_t(i)].c_str(), i == chosen)) {
                chosen = i;
                changed = true;
            }
        }
        ImGui::EndCombo();
    }
    return changed;
}

std::vector<std::string> splitAtBars(std::string_view text) {
    std::vector<std::string> parts;
    while (true) {
        const size_t bar = std::min(text.find('|'), text.size());
        parts.emplace_back(text.substr(0, bar));
        if (bar == text.size()) {
            return parts;
        }
        text.remove_prefix(bar + 1);
    }
}

/// Settings that the method reads.
bool counts(Method method, std::string_view key) {
    constexpr std::string_view kOfBoth[] = {"method",   "jitter",   "jitter_scale",
                                            "scramble", "mip_bias", "sharpness"};
    if (method == Method::recursive) {
        return key != "ring";
    }
    return key == "ring" ||
           std::find(std::begin(kOfBoth), std::end(kOfBoth), key) != std::end(kOfBoth);
}

void settingOf(TaaPolicy& policy, const TaaPolicyKey& key) {
    const std::string name(key.name);
    int number = policyNumber(policy, key);
    bool changed = false;
    if (key.values == "off|on") {
        bool on = number != 0;
        changed = ImGui::Checkbox(name.c_str(), &on);
        number = int(on);
    } else if (key.unit == 0) {
        const std::vector<std::string> names = splitAtBars(key.values);
        changed = choose(name.c_str(), names, number, names[size_t(number)]);
    } else if (key.unit == 1) {
        changed = ImGui::SliderInt(name.c_str(), &number, key.low, key.high);
    } else {
        const float unit = float(key.unit);
        float value = float(number) / unit;
        changed = ImGui::SliderFloat(name.c_str(), &value, float(key.low) / unit,
                                     float(key.high) / unit, "%.3f");
        number = int(std::lround(value * unit));
    }
    if (changed) {
        setPolicyNumber(policy, key, number);
    }
}

void settingsOf(TaaPolicy& policy) {
    if (!ImGui::TreeNodeEx("settings", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    for (const TaaPolicyKey& key : taaPolicyKeys()) {
        if (counts(policy.method, key.name)) {
            settingOf(policy, key);
        }
    }
    ImGui::TreePop();
}

void modeOf(Mode& mode) {
    const std::vector<std::string> names = inspect::modeNames();
    const std::string current = inspect::nameOf(mode);
    int chosen = int(std::find(names.begin(), names.end(), current) - names.begin());
    if (choose("mode", names, chosen, current)) {
        mode = *inspect::modeNamed(names[size_t(chosen)]);
    }
    if (const TaaPreset* preset = findPreset(current);
        preset != nullptr && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", std::string(preset->about).c_str());
    }
}

void paneSection(Desk& desk, int pane) {
    Session& session = desk.session;
    PaneSettings& settings = session.pane(pane);
    const inspect::PaneReport& report = session.report(pane);
    modeOf(settings.mode);
    if (session.scene().lights.sampled() && settings.mode.anti_aliasing != AntiAliasing::ssaa) {
        bool denoises = settings.mode.denoise == Denoise::svgf;
        ImGui::Checkbox("denoise", &denoises);
        settings.mode.denoise = denoises ? Denoise::svgf : Denoise::off;
    }
    std::vector<std::string> views;
    for (const inspect::ViewInfo& info : inspect::allViews()) {
        views.emplace_back(info.name);
    }
    int view = int(settings.view);
    if (choose("view", views, view, views[size_t(view)])) {
        settings.view = inspect::allViews()[size_t(view)].view;
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", std::string(inspect::allViews()[size_t(view)].about).c_str());
    }
    ImGui::Text("hash %s", hex(session.hash(pane)).c_str());
    ImGui::Text("frame %d%s", report.frames, report.at_rest ? ", at rest" : "");
    if (settings.mode.anti_aliasing == AntiAliasing::ssaa) {
        ImGui::SliderInt("samples", &settings.mode.ssaa_samples, 1, 1024, "%d",
                         ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    } else if (settings.mode.anti_aliasing == AntiAliasing::taa) {
        settingsOf(settings.mode.policy);
    }
}

void overlaySection(inspect::Look& look) {
    ImGui::Checkbox("split (S)", &look.split);
    ImGui::SameLine(kItemWidth);
    ImGui::Checkbox("magnifier (M)", &look.magnifier.on);
    ImGui::Checkbox("grid (G)", &look.overlays.grid);
    ImGui::SameLine(kItemWidth);
    ImGui::Checkbox("axes (X)", &look.overlays.axes);
    ImGui::Checkbox("edges (E)", &look.overlays.edges);
    ImGui::SameLine(kItemWidth);
    ImGui::Checkbox("tiles (T)", &look.overlays.tiles);
    ImGui::Checkbox("arrows (R)", &look.overlays.arrows);
}

void resolutionSection(Desk& desk) {
    Session& session = desk.session;
    ImGui::Checkbox("keep frame rate (D)", &desk.keep_fps);
    ImGui::SliderInt("fps", &desk.wanted_fps, 5, 60, "%d", ImGuiSliderFlags_AlwaysClamp);
    int scale = session.renderScale();
    ImGui::BeginDisabled(desk.keep_fps);
    if (ImGui::SliderInt("scale", &scale, 25, 100, "%d %%", ImGuiSliderFlags_AlwaysClamp)) {
        session.setRenderScale(scale);
    }
    ImGui::EndDisabled();
    ImGui::Checkbox("smooth when scaled up", &session.look().smooth_upscale);
}

void cameraSection(Desk& desk) {
    const auto button = [&](const char* text, Action action) {
        if (ImGui::Button(text)) {
            desk.perform(action);
        }
    };
    button("reset (Enter)", Action::reset_camera);
    ImGui::SameLine();
    button("frame all (F)", Action::frame_all);
    button("save path (Ctrl+S)", Action::save_cameras);
    const auto& views = desk.session.scene().views;
    for (size_t i = 0; i < views.size(); ++i) {
        ImGui::PushID(int(i));
        if (ImGui::Selectable(views[i].name.c_str(), desk.view == int(i))) {
            desk.view = int(i);
            desk.session.showView(i);
        }
        ImGui::PopID();
    }
}

}  // namespace

void showTaaPanel(Desk& desk) {
    if (!desk.shown.taa) {
        return;
    }
    constexpr float kWidth = 330;
    ImGui::SetNextWindowPos({float(desk.width) - kWidth - 8, 30}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({kWidth, std::min(600.0f, float(desk.height) - 90)},
                             ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Anti-aliasing", &desk.shown.taa)) {
        ImGui::PushItemWidth(kItemWidth);
        const bool split = desk.session.look().split;
        for (int pane = 0; pane < (split ? 2 : 1); ++pane) {
            ImGui::PushID(pane);
            const char* title = !split ? "Picture" : pane == 0 ? "Left" : "Right";
            if (ImGui::CollapsingHeader(title, ImGuiTreeNodeFlags_DefaultOpen)) {
                paneSection(desk, pane);
            }
            ImGui::PopID();
        }
        if (ImGui::CollapsingHeader("Overlays")) {
            overlaySection(desk.session.look());
        }
        if (ImGui::CollapsingHeader("Resolution")) {
            resolutionSection(desk);
        }
        if (ImGui::CollapsingHeader("Camera")) {
            cameraSection(desk);
        }
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

}  // namespace still::viewer
