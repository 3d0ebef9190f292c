// The text of a scene file. It may name quad.obj, tile.png and cameras.json.

#include <string>

#include "engine/internal/scene_file.h"
#include "tests/fuzz/draw_scene.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace still;
    const std::string text(fuzz::textOf({data, size}));
    const Result<Scene> scene = parseSceneFile(text, fuzz::scratchFolder() / "fuzz.json");
    if (scene) {
        fuzz::tryScene(*scene, fuzz::hashOf({data, size}) % 16 == 0);
    }
    return 0;
}
