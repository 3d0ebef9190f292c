#pragma once
// One function per built-in scene for measuring; demos/scenes/bench_scenes.h lists them.

#include "engine/scene.h"

namespace still::scenes {

Scene makeBenchTiny();       ///< a million triangles of about two pixels at 1920 × 1080
Scene makeBenchMid();        ///< 70,000 triangles that cover the picture one and a half times
Scene makeBenchFillFront();  ///< four layers that cover the picture, the nearest first
Scene makeBenchFillBack();   ///< the same, the nearest last

}  // namespace still::scenes
