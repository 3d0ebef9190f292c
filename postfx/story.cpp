#include "postfx/story.h"

#include <algorithm>

#include "postfx/internal/lab_rules.h"
#include "postfx/internal/story_parts.h"

namespace still {

std::string_view verdictName(Verdict verdict) {
    static constexpr std::array<std::string_view, kVerdicts> kNames = {
        "taken", "no history", "off-screen", "depth", "normal",
        "id",    "colour",     "velocity",   "epoch", "seam"};
    return kNames[size_t(verdict)];
}

StoryColour toStoryYcocg(const StoryColour& rgb) {
    const lab::Rgb c = lab::toYcocg({{rgb[0], rgb[1], rgb[2]}});
    return {c.v[0], c.v[1], c.v[2]};
}

StoryColour fromStoryYcocg(const StoryColour& ycocg) {
    const lab::Rgb c = lab::fromYcocg({{ycocg[0], ycocg[1], ycocg[2]}});
    return {c.v[0], c.v[1], c.v[2]};
}

StoryBox boxAround(const StoryBox& box, StoryColour (*to)(const StoryColour&)) {
    StoryBox result;
    result.middle = to(box.middle);
    result.low = result.high = result.middle;
    for (size_t corner = 0; corner < 8; ++corner) {
        const StoryColour from{(corner & 1) != 0 ? box.high[0] : box.low[0],
                               (corner & 2) != 0 ? box.high[1] : box.low[1],
                               (corner & 4) != 0 ? box.high[2] : box.low[2]};
        const StoryColour moved = to(from);
        for (size_t c = 0; c < 3; ++c) {
            result.low[c] = std::min(result.low[c], moved[c]);
            result.high[c] = std::max(result.high[c], moved[c]);
        }
    }
    return result;
}

}  // namespace still
