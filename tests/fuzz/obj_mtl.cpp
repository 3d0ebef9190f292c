// OBJ text, and behind a line "%%MTL" the library that "mtllib a.mtl" names. Models come out that
// can be drawn.

#include <string>

#include "engine/load.h"
#include "engine/timeline.h"
#include "tests/fuzz/draw_scene.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace still;
    const std::string_view text = fuzz::textOf({data, size});
    constexpr std::string_view kMark = "%%MTL\n";
    const size_t mark = text.find(kMark);
    if (mark != text.npos) {
        fuzz::writeScratch("a.mtl", text.substr(mark + kMark.size()));
    }
    const std::string name = (fuzz::scratchFolder() / "fuzz.obj").string();
    const Result<Scene> scene = loadSceneText(std::string(text.substr(0, mark)), name);
    if (scene) {
        fuzz::tryScene(*scene, fuzz::hashOf({data, size}) % 16 == 0);
    }
    return 0;
}
