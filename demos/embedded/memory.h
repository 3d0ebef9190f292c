#pragma once
// The program's operator new: all memory is that of one arena.

#include "rasterizer/arena.h"

namespace spin {

/// From now on, memory asked for ends the program.
void sealArena();

const still::Arena& arena();

}  // namespace spin
