#pragma once
// One function per scene of the failure atlas; demos/scenes/atlas.h finds them by name. Speeds in
// pixels per frame at 320×180.

#include "engine/scene.h"

namespace still::scenes::atlas {

// atlas_edges.cpp
Scene makeDisocclusion();  ///< a box at 12 and a post at −8 px/frame before bricks
Scene makeWiresStill();    ///< wires of 0.15 … 0.9 px
Scene makeWiresSway();     ///< the same, ends swing at up to 1.5 px/frame
Scene makeWiresPan();      ///< the same under a camera at 1.7 px/frame
Scene makeFenceStill();    ///< chain link with wires of about 1.2 px
Scene makeFencePan();      ///< the same under a camera at 2.3 px/frame
Scene makeLeavesStill();   ///< alpha-tested cards
Scene makeLeavesTurn();    ///< the same, turning, the nearest leaves at 1.85 px/frame
Scene makeHdrStill();      ///< bars of emission 16 before a dark wall
Scene makeHdrMove();       ///< the same, bars at (1.3, 0.4) px/frame
Scene makeSliversStill();  ///< 100,352 triangles on 100 × 100 pixels
Scene makeSliversTurn();   ///< the same, turning, corners at 0.6 px/frame

// atlas_patterns.cpp
Scene makeZonePlateStill();  ///< rings of 0 … 1 cycle per pixel, point-sampled
Scene makeZonePlateSlow();   ///< pan of 0.1 … 0.5 px/frame, see slowPanSpeed()
Scene makeZonePlateHalf();   ///< pan of exactly ½ px/frame
Scene makeCheckerStill();    ///< floor and ceiling out to the horizon, point-sampled
Scene makeCheckerSlow();     ///< camera turns by 0.1 … 0.5 px/frame
Scene makeCheckerHalf();     ///< camera turns by ½ px/frame
Scene makeSparkleStill();    ///< highlights on a bumpy normal map without mips
Scene makeSparklePan();      ///< the same under a camera at 0.7 px/frame
Scene makeParallaxStill();   ///< the corner of a height-mapped room
Scene makeParallaxPan();     ///< the same under a camera at (1.2, 0.3) px/frame
Scene makeDepthPan();        ///< depths 0.02 … 950; the nearest pane moves by 1.1 px/frame
Scene makeDitherStill();     ///< ordered-dither alpha, about one texel per pixel
Scene makeDitherPan();       ///< the same under a camera at 0.7 px/frame

// atlas_camera.cpp
Scene makeRotate();       ///< cube, wheel and knot turn, corners at up to 2.9 px/frame
Scene makeRoll();         ///< camera rolls by 1°/frame: 2.8 px/frame at the left and right border
Scene makeZoom();         ///< field of view closes: about 2.2 px/frame at the left and right
Scene makeFastPan();      ///< 60 px/frame
Scene makeScreenEdges();  ///< fine detail enters at (2.6, 1.7) px/frame
Scene makeCut();          ///< pan of 1 px/frame, at frame 24 a cut to elsewhere
Scene makeResize();       ///< still; the program changes the size
Scene makeLong();         ///< still wires, chain link and glass, for 10,000 frames
Scene makeCourtyardStill();  ///< the courtyard's knot and ball move, the camera stands
Scene makeCourtyardPan();    ///< camera turns by 4/3 px/frame (4 at 960×540)
Scene makeCourtyardOrbit();  ///< camera circles its target by 0.4°/frame, knot and ball move

// atlas_light.cpp
Scene makeLightOn();       ///< a lamp goes on at frame 24
Scene makeLightOff();      ///< the lamp goes off at frame 24
Scene makeLightFlicker();  ///< another brightness in every frame
Scene makeGlassStill();    ///< stochastic panes, one behind the other
Scene makeGlassMove();     ///< panes slide at ±1.5 px/frame

// atlas_surface.cpp
Scene makeMaterialSwap();   ///< wall and boxes have other materials from frame 24 on
Scene makeTextureScroll();  ///< textures run at (1.5, 0) and (0.4, 0.7) px/frame on still belts
Scene makeScreen();         ///< a flip book, one page every other frame
Scene makeMovingShadow();   ///< dapples run at (1.2, 0.3) px/frame over still ground
Scene makeNoise();          ///< snow of 1.5-pixel grains, all new in every frame
Scene makeLowResolution();  ///< 32 × 18 flat cells, renewed every 4th frame, pan of 0.6 px/frame

}  // namespace still::scenes::atlas
