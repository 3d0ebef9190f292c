#pragma once
// One function per built-in scene; demos/scenes/builtin.h finds them by name.

#include "engine/scene.h"

namespace still::scenes {

Scene makeCourtyard();  ///< a colonnaded court, about 100,000 triangles
Scene makeTriangle();   ///< one large triangle of one colour
Scene makeCubes();      ///< still, turning and travelling boxes before a textured wall
Scene makeChecker();    ///< a checkered plane out to the horizon
Scene makeWires();      ///< slanted wires thinner than a pixel before a plain wall
Scene makeFence();      ///< alpha-tested chain link before bricks
Scene makeGlass();      ///< stochastic panes of opacity 0.4 over boxes
Scene makeLights();     ///< point lights, highlights, a normal-mapped wall, keyed intensity
Scene makeDepth();      ///< close pairs of planes over a depth range of 1e5
Scene makeZoo();        ///< a bit of everything, for tables of hashes
Scene makePan();        ///< still boxes under a panning camera, with a cut at frame 20

// With sampled light.
Scene makeCornell();      ///< the Cornell box: an area light and one bounce
Scene makePenumbra();     ///< a board moves through the light of a large lamp
Scene makeMovingLight();  ///< a lamp moves over a still life
Scene makeContact();      ///< ambient light and contact shadows
Scene makeSwitchOff();    ///< two lamps, one of which goes out in frame 32

}  // namespace still::scenes
