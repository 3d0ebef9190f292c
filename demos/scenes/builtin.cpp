#include "demos/scenes/builtin.h"

#include "demos/scenes/scenes.h"

namespace still {
namespace {

struct Entry {
    const char* name;
    Scene (*make)();
};

constexpr Entry kScenes[] = {
    {"courtyard", scenes::makeCourtyard},
    {"triangle", scenes::makeTriangle},
    {"cubes", scenes::makeCubes},
    {"checker", scenes::makeChecker},
    {"wires", scenes::makeWires},
    {"fence", scenes::makeFence},
    {"glass", scenes::makeGlass},
    {"lights", scenes::makeLights},
    {"depth", scenes::makeDepth},
    {"zoo", scenes::makeZoo},
    {"pan", scenes::makePan},
};

}  // namespace

std::vector<std::string> builtinSceneNames() {
    std::vector<std::string> names;
    for (const Entry& entry : kScenes) {
        names.emplace_back(entry.name);
    }
    return names;
}

Result<Scene> builtinScene(const std::string& name) {
    std::string known;
    for (const Entry& entry : kScenes) {
        if (name == entry.name) {
            return entry.make();
        }
        known += (known.empty() ? "" : ", ") + std::string(entry.name);
    }
    return fail("builtin:" + name + ": unknown scene, expected one of " + known);
}

}  // namespace still
