#include "demos/viewer/window.h"

#define SDL_MAIN_HANDLED  // main() stays ours
#include <SDL.h>

namespace still::viewer {
namespace {

struct FreeSurface {
    void operator()(SDL_Surface* surface) const { SDL_FreeSurface(surface); }
};

}  // namespace

Window::Video::~Video() {
    SDL_Quit();
}
void Window::Destroy::operator()(SDL_Window* window) const {
    SDL_DestroyWindow(window);
}

command::Outcome<Window> Window::open(const std::string& title, command::Size size) {
    SDL_SetMainReady();
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // they are Interruption's
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    if (SDL_Init(SDL_INIT_VIDEO) != 0) {
        return command::fileError(std::string("cannot open a window: ") + SDL_GetError() +
                                  "; SDL_VIDEODRIVER=dummy does without a screen");
    }
    Window window;
    window.video_ = std::make_unique<Video>();
    // SDL falls back to a window that nobody sees, by itself.
    if (SDL_GetHint(SDL_HINT_VIDEODRIVER) == nullptr &&
        SDL_GetCurrentVideoDriver() == std::string("offscreen")) {
        return command::fileError(
            "cannot open a window: there is no screen; SDL_VIDEODRIVER=dummy does without, for "
            "--script");
    }
    window.window_.reset(SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_UNDEFINED,
                                          SDL_WINDOWPOS_UNDEFINED, size.width, size.height,
                                          SDL_WINDOW_RESIZABLE));
    if (window.window_ == nullptr) {
        return command::fileError(std::string("cannot open a window: ") + SDL_GetError());
    }
    return window;
}

void Window::setTitle(const std::string& title) {
    SDL_SetWindowTitle(window_.get(), title.c_str());
}

void Window::setSize(command::Size size) {
    SDL_SetWindowSize(window_.get(), size.width, size.height);
}

command::Size Window::size() const {
    command::Size size;
    SDL_GetWindowSize(window_.get(), &size.width, &size.height);
    return size;
}

void Window::show(ImageView<const Xrgb8> picture) {
    SDL_Surface* target = SDL_GetWindowSurface(window_.get());
    if (target == nullptr) {
        return;  // it is being resized, or the screen is gone
    }
    // SDL asks for a pointer it may write to, and does not write.
    const std::unique_ptr<SDL_Surface, FreeSurface> source(SDL_CreateRGBSurfaceWithFormatFrom(
        const_cast<Xrgb8*>(picture.data), picture.width, picture.height, 32,
        int(picture.stride * ptrdiff_t{sizeof(Xrgb8)}), SDL_PIXELFORMAT_XRGB8888));
    if (source != nullptr) {
        SDL_SetSurfaceBlendMode(source.get(), SDL_BLENDMODE_NONE);
        SDL_BlitSurface(source.get(), nullptr, target, nullptr);
    }
    SDL_UpdateWindowSurface(window_.get());
}

void Window::holdMouse(bool on) {
    SDL_SetRelativeMouseMode(on ? SDL_TRUE : SDL_FALSE);
}

}  // namespace still::viewer
