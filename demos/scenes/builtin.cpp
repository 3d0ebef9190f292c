#include "demos/scenes/builtin.h"

#include "demos/scenes/atlas.h"
#include "demos/scenes/bench_content.h"
#include "demos/scenes/bench_scenes.h"
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
    {"cornell", scenes::makeCornell},
    {"penumbra", scenes::makePenumbra},
    {"moving-light", scenes::makeMovingLight},
    {"contact", scenes::makeContact},
    {"switch-off", scenes::makeSwitchOff},
};

/// Made for measuring, listed by benchSceneNames().
constexpr Entry kBenchScenes[] = {
    {"bench-tiny", scenes::makeBenchTiny},
    {"bench-mid", scenes::makeBenchMid},
    {"bench-fill-back", scenes::makeBenchFillBack},
    {"bench-fill-front", scenes::makeBenchFillFront},
};

const std::string kAtlasPrefix = "atlas-";

/// A scene of the failure atlas. There are many, so only those who ask for one get their list.
Result<Scene> atlasScene(const std::string& name) {
    if (const AtlasCase* found = findAtlasCase(name.substr(kAtlasPrefix.size()))) {
        return found->make();
    }
    std::string known;
    for (const AtlasCase& each : atlasCases()) {
        known += (known.empty() ? "" : ", ") + kAtlasPrefix + each.name;
    }
    return fail("builtin:" + name + ": unknown scene, expected one of " + known);
}

}  // namespace

std::vector<std::string> builtinSceneNames() {
    std::vector<std::string> names;
    for (const Entry& entry : kScenes) {
        names.emplace_back(entry.name);
    }
    return names;
}

std::vector<std::string> benchSceneNames() {
    std::vector<std::string> names{"courtyard"};
    for (const Entry& entry : kBenchScenes) {
        names.emplace_back(entry.name);
    }
    return names;
}

Result<Scene> builtinScene(const std::string& name) {
    if (name.starts_with(kAtlasPrefix)) {
        return atlasScene(name);
    }
    for (const Entry& entry : kBenchScenes) {
        if (name == entry.name) {
            return entry.make();
        }
    }
    std::string known;
    for (const Entry& entry : kScenes) {
        if (name == entry.name) {
            return entry.make();
        }
        known += (known.empty() ? "" : ", ") + std::string(entry.name);
    }
    return fail("builtin:" + name + ": unknown scene, expected one of " + known +
                ", atlas-NAME of the failure atlas, or bench-NAME");
}

}  // namespace still
