#pragma once
// What several tests of sessions need.

#include <string>

#include "demos/inspect/session.h"
#include "demos/scenes/builtin.h"
#include "engine/hash.h"

namespace still::inspect {

constexpr int kTestWidth = 120, kTestHeight = 72;

inline Scene sceneNamed(const std::string& name) {
    return builtinScene(name).value();
}

inline Mode modeCalled(const std::string& name) {
    return modeNamed(name).value();
}

inline SessionSettings testSettings() {
    return {.width = kTestWidth, .height = kTestHeight};
}

inline uint64_t hashOf(const Drawn& drawn) {
    return hashPlane(drawn.image);
}

/// Draws until nothing changes any more; how often something did.
inline int drawToRest(Session& session, int limit) {
    int draws = 0;
    while (draws < limit && session.draw().changed) {
        ++draws;
    }
    return draws;
}

/// The canvas as it is now, to compare with later ones.
inline Image<Rgb8> copyOf(ImageView<const Rgb8> picture) {
    Image<Rgb8> copy(picture.width, picture.height);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            copy.at(x, y) = picture.at(x, y);
        }
    }
    return copy;
}

}  // namespace still::inspect
