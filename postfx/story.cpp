#include "postfx/story.h"

#include "postfx/internal/lab_rules.h"

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

}  // namespace still
