#include "demos/viewer/ui.h"

#include <imgui.h>

#include <algorithm>
#include <optional>

namespace still::viewer {
namespace {

struct KeyPair {
    SDL_Keycode sdl;
    ImGuiKey imgui;
};
// What text fields and navigation ask for.
constexpr std::array kKeys{
    KeyPair{SDLK_TAB, ImGuiKey_Tab},
    KeyPair{SDLK_LEFT, ImGuiKey_LeftArrow},
    KeyPair{SDLK_RIGHT, ImGuiKey_RightArrow},
    KeyPair{SDLK_UP, ImGuiKey_UpArrow},
    KeyPair{SDLK_DOWN, ImGuiKey_DownArrow},
    KeyPair{SDLK_PAGEUP, ImGuiKey_PageUp},
    KeyPair{SDLK_PAGEDOWN, ImGuiKey_PageDown},
    KeyPair{SDLK_HOME, ImGuiKey_Home},
    KeyPair{SDLK_END, ImGuiKey_End},
    KeyPair{SDLK_INSERT, ImGuiKey_Insert},
    KeyPair{SDLK_DELETE, ImGuiKey_Delete},
    KeyPair{SDLK_BACKSPACE, ImGuiKey_Backspace},
    KeyPair{SDLK_SPACE, ImGuiKey_Space},
    KeyPair{SDLK_RETURN, ImGuiKey_Enter},
    KeyPair{SDLK_ESCAPE, ImGuiKey_Escape},
    KeyPair{SDLK_KP_ENTER, ImGuiKey_KeyPadEnter},
    KeyPair{SDLK_a, ImGuiKey_A},
    KeyPair{SDLK_c, ImGuiKey_C},
    KeyPair{SDLK_v, ImGuiKey_V},
    KeyPair{SDLK_x, ImGuiKey_X},
    KeyPair{SDLK_y, ImGuiKey_Y},
    KeyPair{SDLK_z, ImGuiKey_Z},
};

std::optional<size_t> buttonIndex(uint8_t button) {
    switch (button) {
        case SDL_BUTTON_LEFT:
            return 0;
        case SDL_BUTTON_RIGHT:
            return 1;
        case SDL_BUTTON_MIDDLE:
            return 2;
        default:
            return std::nullopt;
    }
}

void handleKey(const SDL_KeyboardEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    const uint16_t held = event.keysym.mod;
    io.KeyCtrl = (held & KMOD_CTRL) != 0;
    io.KeyShift = (held & KMOD_SHIFT) != 0;
    io.KeyAlt = (held & KMOD_ALT) != 0;
    const auto* pair = std::find_if(kKeys.begin(), kKeys.end(), [&](const KeyPair& candidate) {
        return candidate.sdl == event.keysym.sym;
    });
    if (pair != kKeys.end()) {
        io.KeysDown[pair - kKeys.begin()] = event.state == SDL_PRESSED;
    }
}

}  // namespace

void Ui::Destroy::operator()(ImGuiContext* context) const {
    ImGui::DestroyContext(context);
}

Ui::Ui() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // nothing is left behind, and every start looks the same
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    for (size_t i = 0; i < kKeys.size(); ++i) {
        io.KeyMap[kKeys[i].imgui] = int(i);
    }
    // Lines then are triangles of one colour with a fading rim, not pictures of lines.
    io.Fonts->Flags |= ImFontAtlasFlags_NoBakedLines | ImFontAtlasFlags_NoMouseCursors;
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&texels, &width, &height);
    atlas_ = {texels, width, height, width};
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.AntiAliasedLinesUseTex = false;
    style.WindowRounding = 4;
    style.FrameRounding = 2;
    style.Colors[ImGuiCol_WindowBg].w = 0.85f;
}

void Ui::handleButton(const SDL_MouseButtonEvent& event) {
    if (const auto index = buttonIndex(event.button)) {
        button_down_[*index] = event.state == SDL_PRESSED;
        button_pressed_[*index] = button_pressed_[*index] || event.state == SDL_PRESSED;
    }
    ImGui::GetIO().MousePos = {float(event.x), float(event.y)};
}

void Ui::handle(const SDL_Event& event) {
    ImGuiIO& io = ImGui::GetIO();
    switch (event.type) {
        case SDL_MOUSEMOTION:
            io.MousePos = {float(event.motion.x), float(event.motion.y)};
            break;
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP:
            handleButton(event.button);
            break;
        case SDL_MOUSEWHEEL:
            io.MouseWheel += event.wheel.preciseY;
            io.MouseWheelH += event.wheel.preciseX;
            break;
        case SDL_TEXTINPUT:
            io.AddInputCharactersUTF8(event.text.text);
            break;
        case SDL_KEYDOWN:
        case SDL_KEYUP:
            handleKey(event.key);
            break;
        case SDL_WINDOWEVENT:
            if (event.window.event == SDL_WINDOWEVENT_LEAVE) {
                io.MousePos = {-FLT_MAX, -FLT_MAX};
            } else if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) {
                io.AddFocusEvent(false);
            }
            break;
        default:
            break;
    }
}

void Ui::begin(command::Size window, double seconds) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {float(window.width), float(window.height)};
    io.DeltaTime = float(seconds);
    for (size_t i = 0; i < button_down_.size(); ++i) {
        io.MouseDown[i] = button_down_[i] || button_pressed_[i];
        button_pressed_[i] = false;
    }
    ImGui::NewFrame();
}

void Ui::end() {
    ImGui::Render();
}

void Ui::draw(ImageView<Xrgb8> canvas) const {
    drawUi(*ImGui::GetDrawData(), atlas_, canvas);
}

bool Ui::wantsMouse() const {
    return ImGui::GetIO().WantCaptureMouse;
}
bool Ui::wantsKeys() const {
    return ImGui::GetIO().WantTextInput;
}

}  // namespace still::viewer
