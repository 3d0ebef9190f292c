#pragma once
// What people choose to see: plain values, compared by the session to know whether anything is to
// be drawn again.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "demos/inspect/mode.h"

namespace still::inspect {

/// What a pane shows of its frame. Colours and ranges: README.md.
enum class View : uint8_t {
    picture,        ///< what the mode makes
    sample,         ///< the sample of this frame alone
    depth,          ///< of that sample
    normal,         ///< of that sample
    id,             ///< of that sample
    motion,         ///< of that sample
    history,        ///< the past as it is kept
    reprojected,    ///< the past alone, at this frame's places
    clipped,        ///< the same, held against the neighbourhood
    neighbourhood,  ///< middle of the box that the past is held against
    rejection,      ///< why, and how much of the past was not used
    count,          ///< samples that a pixel was made from
    confidence,     ///< how much of a pixel is known
    tiles,          ///< what was done for each tile of 64 × 64 pixels, and skipped
    overdraw,       ///< triangles that lie over each other
    error,          ///< distance from a supersampled picture that converges while all is still
    light,          ///< sampled light as it is: one random sample a pixel
    denoised,       ///< the same, clean
};

struct ViewInfo {
    View view;
    std::string_view name;   ///< "depth"
    std::string_view about;  ///< one line: what the colours mean
};
/// In the order of the enumeration.
std::span<const ViewInfo> allViews();
std::optional<View> viewNamed(std::string_view name);

struct PaneSettings {
    Mode mode{};
    View view = View::picture;
    friend bool operator==(const PaneSettings&, const PaneSettings&) = default;
};

/// Shows the pixels around one of them, as squares. With two panes, both, side by side.
struct Magnifier {
    bool on = false;
    int x = 0, y = 0;    ///< pixel of the window in the middle of it
    int factor = 8;      ///< 2 … 64 pixels of the window for one of the picture
    bool grid = true;    ///< lines between the pixels
    bool jitter = true;  ///< the middle pixel once more in the corner, with its samples' places
    friend bool operator==(const Magnifier&, const Magnifier&) = default;
};

/// Drawn over the finished picture, where the pixels' centres are, hidden by what lies in front.
struct Overlays {
    bool grid = false;    ///< on the ground, y = 0
    bool axes = false;    ///< x red, y green, z blue, from the origin
    bool edges = false;   ///< of all triangles
    bool tiles = false;   ///< borders of the tiles of 64 × 64 pixels
    bool arrows = false;  ///< where what is seen was a frame ago
    friend bool operator==(const Overlays&, const Overlays&) = default;
};

/// A pixel of a pane's picture.
struct PickedPixel {
    int pane = 0;
    int x = 0, y = 0;
    friend bool operator==(const PickedPixel&, const PickedPixel&) = default;
};

struct Look {
    bool split = false;    ///< pane 1 to the right of the divider
    double divider = 0.5;  ///< 0 … 1 of the width
    Magnifier magnifier{};
    Overlays overlays{};
    std::optional<PickedPixel> picked{};
    bool smooth_upscale = false;  ///< of pictures smaller than the window: bilinear, else squares
    friend bool operator==(const Look&, const Look&) = default;
};

}  // namespace still::inspect
