#pragma once
// What is asked of `still`, case by case. Where a target of the failure atlas is missed, the bound
// is the number of today with a margin, so that it cannot get worse unnoticed; 0.3 dB of every
// number in dB are margin. Numbers may only be made stricter.

#include <optional>
#include <vector>

namespace still::test {

struct StillBound {
    const char* scene;
    const char* rival;         ///< the best of the published presets there
    double lead_db = 3;        ///< at least, over the rival; target 3, and 6 for the first three
    double flicker = 0.003;    ///< at most; target 0.003
    double first_lead_db = 3;  ///< at least, of the first frame over raw; target 3
};

struct MovingBound {
    const char* scene;
    const char* rival;
    double lead_db = -0.2;                            ///< target −0.2
    double sharpness_min = 0.9, sharpness_max = 1.1;  ///< target 0.9 … 1.1
    double flip_above_raw = 0;                        ///< at most, in any frame; target 0
};

struct EventBound {
    const char* scene;
    double flip_above_raw = 0;  ///< as above
    /// At least, of the event's frame over raw, where it begins a new picture; target 3.
    std::optional<double> first_lead_db{};
};

const std::vector<StillBound>& stillBounds();
const std::vector<MovingBound>& movingBounds();
const std::vector<EventBound>& eventBounds();

}  // namespace still::test
