#pragma once
// Of a picture that something is wrong with, the smallest one that it is still wrong with (delta
// debugging: A. Zeller, R. Hildebrandt, "Simplifying and isolating failure-inducing input", 2002).

#include <functional>
#include <string>

#include "tests/support/test_scene.h"

namespace still::test {

struct DrawCase {
    TestScene scene;
    FrameView view;
};

/// What is wrong with a case; empty: nothing.
using DrawCheck = std::function<std::string(DrawCase&)>;

/// Takes away instances, triangles, materials, lights and parts of the picture, and makes what is
/// left plainer, for as long as `check` finds something wrong, whatever it is; at most `tries`
/// checks. The case itself when nothing is wrong with it.
DrawCase minimized(DrawCase found, const DrawCheck& check, int tries = 2000);

/// Statements that make `scene` and `view` of the case, to be pasted into a test; of textures only
/// their number.
std::string asCode(const DrawCase& shown);

}  // namespace still::test
