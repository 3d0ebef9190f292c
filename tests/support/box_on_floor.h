#pragma once

#include "engine/scene.h"

/// A floor and a box; the box moves in the frames `first` … `last`.
still::Scene boxOnFloor(int first, int last);
