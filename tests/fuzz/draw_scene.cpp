#include "tests/fuzz/draw_scene.h"

#include <string>

#include "engine/frame_loop.h"
#include "engine/timeline.h"
#include "rasterizer/draw_list_check.h"
#include "tests/fuzz/fuzz.h"

namespace still::fuzz {

namespace {

constexpr uint64_t kFewTriangles = 2000;
constexpr int kWidth = 16, kHeight = 9;

void checkFrame(const Scene& scene, int number) {
    const FrameState state = frameStateAt(scene, {}, number, kWidth, kHeight);
    const DrawList list{.meshes = scene.meshes,
                        .materials = materialsOf(scene, state),
                        .textures = scene.textures,
                        .alpha_textures = scene.alpha_textures,
                        .instances = state.instances,
                        .lighting = state.lighting,
                        .background = scene.background};
    const char* const flaw = flawOf(list);
    require(flaw == nullptr, flaw == nullptr ? "" : std::string("a loaded scene: ") + flaw);
}

}  // namespace

void tryScene(const Scene& scene, bool draw) {
    for (const int frame : {0, 1, 13}) {
        checkFrame(scene, frame);
    }
    if (!draw || scene.triangleCount() > kFewTriangles) {
        return;
    }
    static Workers workers(1);
    FrameLoop loop(scene, {.width = kWidth, .height = kHeight}, workers);
    for (const int frame : {0, 1}) {
        loop.render(frame);
    }
}

}  // namespace still::fuzz
