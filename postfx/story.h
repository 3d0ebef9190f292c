#pragma once
// What the temporal methods did: one pixel tap by tap, the whole picture as planes, the work of
// each tile. All of it is told when it is asked for, by the scalar code that defines the result,
// from what the last resolve left behind: a frame that nobody asks about pays nothing.
// Told by Taa, Laboratory and FrameLoop. What the words mean: postfx/README.md.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "postfx/policy.h"
#include "rasterizer/gbuffer.h"
#include "rasterizer/image.h"

namespace still {

/// What was decided about a sample of the past.
enum class Verdict : uint8_t {
    taken,
    no_history,  ///< first frame, cut, or its place in the past is not known
    off_screen,  ///< its place lies outside the picture
    depth,       ///< another layer: something nearer slid over, or this one was hidden
    normal,      ///< the surface was turned otherwise, so it was lit otherwise
    id,          ///< another surface
    colour,      ///< luminance differs too much (TaaPolicy::luma_reject_q15)
    velocity,    ///< it moved otherwise, or began to move since
    epoch,       ///< its surface's shading changed since
    seam,        ///< Method::gather: beyond a border of tiles whose samples lie otherwise, for they
                 ///< rested
};
constexpr int kVerdicts = 10;
/// "taken", "no history", "off-screen", "depth" …
std::string_view verdictName(Verdict verdict);

/// Linear light, fx12, or what a comment says.
using StoryColour = std::array<int, 3>;

/// A sample's depth against that of the layer that is followed.
enum class TapLayer : uint8_t { same, nearer, farther };

/// One sample that a pixel was, or could have been, made from.
struct PixelTap {
    int age = 0;                      ///< frames: 0 is this one
    int x = 0, y = 0;                 ///< pixel of that frame, may lie outside
    int from_centre_x_fx8 = 0;        ///< where the sample lies, seen from the place that
    int from_centre_y_fx8 = 0;        ///< the pixel's centre had in that frame
    int surface = -1;                 ///< −1: not known
    int depth = -1;                   ///< logDepth16; −1: not known
    StoryColour colour{};             ///< linear fx12; 0 where nothing is there
    TapLayer layer = TapLayer::same;  ///< Method::gather
    /// Method::gather: on the farther layer's way, for the colour that it has here now.
    bool along_far = false;
    /// Method::gather: counts with that colour.
    bool recoloured = false;
    /// By its place alone; all of a frame's add up to 256. A cubic filter's may be negative.
    int weight = 0;
    /// In the result, 0 when rejected. Method::gather: after the plane was laid through all. Else
    /// of 256 for all of the pixel's; a failed test may only halve it (TaaPolicy::partial).
    int used = 0;
    Verdict verdict = Verdict::taken;
};

/// Whose motion the pixel follows.
struct StoryOwner {
    int surface = 0;
    int depth = 0;     ///< logDepth16 now …
    int expected = 0;  ///< … and in the frame before, as the rasterizer expects it
    Motion motion{};
    bool moved = false;     ///< belongs to an object that moved
    bool inferred = false;  ///< no sample shows it, but it must be there (Method::gather)
};

/// A box in a space of three channels.
struct StoryBox {
    StoryColour low{}, high{}, middle{};
};

/// How the pixel's colour came about.
enum class PixelSource : uint8_t {
    none,      ///< nothing was resolved yet
    first,     ///< Method::gather without a past: this frame, filtered in space
    mean,      ///< Method::gather at rest: the exact mean of `count` samples
    gathered,  ///< Method::gather: from `taps`
    blended,   ///< Method::recursive: sample and history
};

/// Of Method::recursive. Working colours: linear fx12 or, with Tone::reinhard, c / (1 + max) fx15.
struct BlendStory {
    StoryColour sample{};     ///< this frame's, filtered
    StoryColour history{};    ///< the past's at the pixel's place, before …
    StoryColour rectified{};  ///< … and after it was held against the box
    bool rectifies = false;   ///< the policy has a box
    bool clipped = false;     ///< … and the history was changed by it
    int alpha_q15 = 32768;    ///< share of the sample in the result
    int trust_q8 = 0;         ///< of history after the tests, 256 = full
    int memory = 0;           ///< Blend::mean: samples in history; Blend::confidence: of 255
};

struct PixelStory {
    PixelSource source = PixelSource::none;
    int x = 0, y = 0;
    int jitter_x_fx8 = 0, jitter_y_fx8 = 0;  ///< where this frame's sample lies, from the centre
    /// This frame's sample; where nothing is drawn any more (TileWork), an earlier one.
    StoryColour raw{};
    StoryColour output{};  ///< the resolved colour, before sharpening

    StoryOwner owner{};
    /// Method::gather: two surfaces in the 3×3 window; … that move apart.
    bool layered = false, apart = false;
    int frames = 0;  ///< looked at, this one included
    std::vector<PixelTap> taps{};
    int count = 0;          ///< Method::gather: samples, or frames, in the pixel
    bool finished = false;  ///< … all of its jitter sequence: it stays as it is
    int confidence = 0;     ///< Method::recursive: 0 … 255
    int spatial_q8 = 0;     ///< share of the spatial filter in the result, 256 = all

    /// What lost most of the past's weight, Verdict::taken when nothing was lost; how much of it
    /// was lost, 0 … 255 = all.
    Verdict reason = Verdict::taken;
    int lost = 0;

    /// The 3×3 window of this frame, row by row; beyond the border the last row and column repeat.
    /// Working colours as in BlendStory; linear with Method::gather.
    std::array<StoryColour, 9> window{};
    /// What history is held against; without rectification the window's extent. Exact in the
    /// policy's space, in the other one around the corners of that box; with Method::gather in
    /// both.
    StoryBox box_rgb{}, box_ycocg{};
    BlendStory blend{};  ///< PixelSource::blended
};

/// To and from luma and half chroma as the box knows them.
StoryColour toStoryYcocg(const StoryColour& rgb);
StoryColour fromStoryYcocg(const StoryColour& ycocg);

/// Whole pictures; linear fx12.
enum class StoryPlane : uint8_t {
    /// The past as it is kept: the image of the last frame, or its raw samples (Method::gather).
    history,
    /// The image from the past alone, at this frame's places; 0 where there is none.
    reprojected,  ///< With Method::gather a still pixel's past is its mean, as shown.
    rectified,    ///< the same, held against the box (Method::recursive; else as it is)
    box_low,      ///< of the neighbourhood
    box_high,     ///< …
    box_middle,   ///< …
};

/// Written by rejections().
struct RejectionTargets {
    ImageView<Verdict> reason;  ///< PixelStory::reason
    ImageView<uint8_t> lost;    ///< PixelStory::lost
};

/// What was done for a tile in the last frame (of sub-frames: the last).
struct TileWork {
    bool drawn = false;
    bool recorded = false;  ///< Method::gather: its samples went into the ring
    bool summed = false;    ///< Method::gather: its samples were added to those of still pixels
    bool resolved = false;  ///< gathered or blended; a first frame's spatial filter counts as well
    bool finished = false;  ///< Method::gather: all samples are there, nothing is left to do
};

}  // namespace still
