#pragma once
// The command lines of `stillframe atlas` and `stillframe chart`, as they were typed.

#include <optional>
#include <string>
#include <vector>

#include "demos/stillframe/options.h"

namespace still::command {

struct AtlasOptions {
    std::string suite = "failures";   ///< or "noise"
    std::string scenes;               ///< comma-separated names of cases; empty: the suite's
    std::vector<std::string> models;  ///< scenes that become cases of the suite of noise
    std::string lights;               ///< scene file that lights them; empty: their own
    std::string presets;              ///< comma-separated columns; empty: the suite's
    std::string versus;  ///< one of the columns, which the others are held against; empty: the
                         ///< suite's, which has one in the suite of noise
    Size resolution{320, 180};
    std::optional<Size> time_resolution;  ///< of what is timed; empty: the same
    int samples = 0;                      ///< at most so many of a reference; 0: as each case wants
    std::string cache;                    ///< folder; empty: the user's
    std::string output;                   ///< folder, made when it is not there
    bool json = false;
    bool quiet = false;
    Limits limits;
};

struct ChartOptions {
    std::vector<std::string> scenes;  ///< FILE.obj, FILE.json or builtin:NAME
    std::string lights;               ///< scene file that lights them; empty: their own
    std::string output;               ///< folder, made when it is not there
    std::string cache;                ///< folder; empty: the user's
    Size resolution{640, 360};
    int frames = 64;             ///< of each segment
    double orbit_deg = 1.0 / 3;  ///< of the moving segment, per frame
    int reference_samples = 256;
    bool json = false;
    bool quiet = false;
    Limits limits;
};

}  // namespace still::command
