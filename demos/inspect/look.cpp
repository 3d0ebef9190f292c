#include "demos/inspect/look.h"

#include <algorithm>
#include <array>

namespace still::inspect {
namespace {

constexpr std::array kViews{
    ViewInfo{View::picture, "picture", "what the mode makes"},
    ViewInfo{View::sample, "sample", "this frame's sample alone, before anything temporal"},
    ViewInfo{View::depth, "depth", "near is bright, logarithmic; nothing is black"},
    ViewInfo{View::normal, "normal", "x, y, z of -1 to 1 as red, green, blue; nothing is black"},
    ViewInfo{View::id, "id", "a colour for each surface; nothing is black"},
    ViewInfo{View::motion, "motion",
             "hue is the direction, white rests, full colour at 16 pixels; no history is black"},
    ViewInfo{View::history, "history", "the past as it is kept: last image, or last raw samples"},
    ViewInfo{View::reprojected, "reprojected",
             "the past alone, carried to this frame's places; black where there is none"},
    ViewInfo{View::clipped, "clipped", "the same, after it was held against the neighbourhood"},
    ViewInfo{View::neighbourhood, "neighbourhood",
             "middle of the box of 3 x 3 samples that the past is held against"},
    ViewInfo{View::rejection, "rejection",
             "why the past was lost: white none, cyan off-screen, red depth, green normal, yellow "
             "id, magenta colour, orange velocity, blue epoch, brown seam"},
    ViewInfo{View::count, "count", "samples in the pixel: black none, white all of the pattern"},
    ViewInfo{View::confidence, "confidence", "trust in what is known: black none, white full"},
    ViewInfo{View::tiles, "tiles",
             "green nothing, yellow drawn, orange recorded, red resolved as well"},
    ViewInfo{View::overdraw, "overdraw",
             "triangles: black none, blue 2, magenta 4, orange 6, yellow 8, white 11 and more"},
    ViewInfo{View::error, "error",
             "distance from the reference: black none, blue, magenta, orange, yellow, white 64"},
    ViewInfo{View::light, "light",
             "sampled light on white surfaces, one random sample a pixel; black where none is"},
    ViewInfo{View::denoised, "denoised", "the same after the denoiser; black without it"},
};

}  // namespace

std::span<const ViewInfo> allViews() {
    return kViews;
}

std::optional<View> viewNamed(std::string_view name) {
    const auto found = std::find_if(kViews.begin(), kViews.end(),
                                    [&](const ViewInfo& info) { return info.name == name; });
    return found == kViews.end() ? std::nullopt : std::optional(found->view);
}

}  // namespace still::inspect
