#pragma once
// Every choice that published temporal anti-aliasing methods make, as one value; and the named
// recipes. Sources of the recipes and their figures: postfx/README.md.
// All numbers are integers: q15 = 1/32768, fx8 = 1/256, so that a policy is exact and comparable,
// and can be a template argument (presets are compiled for their own values).

#include <cstdint>
#include <span>
#include <string_view>

namespace still {

/// Where in the pixel a frame's sample lies; the sequences are in engine/jitter.h.
enum class JitterPattern : uint8_t {
    none,
    uniform2,
    rgss4,
    halton8,
    halton16,
    halton32,
    hammersley4,
    hammersley8,
    hammersley16,
    net16,
    net32,
    net64,  ///< centred (0,2)-net, Owen-scrambled: ours
    r2,
    blue_noise,
};

enum class Method : uint8_t {
    gather,     ///< ours: postfx/taa.h
    recursive,  ///< everybody else's: postfx/laboratory.h
};
enum class Blend : uint8_t {
    fixed,       ///< alpha_q15
    mean,        ///< 1/N, N up to count_cap
    confidence,  ///< lerp(alpha_q15, 1, 1 − confidence); confidence grows by a third each frame
    velocity,    ///< alpha_q15 at rest, grows by velocity_alpha_q15 for each pixel of motion
};
enum class MotionSource : uint8_t { surfaces, camera };
enum class Dilation : uint8_t { centre, nearest_depth, longest };
enum class HistoryFilter : uint8_t {
    nearest,
    bilinear,
    catmull_rom5,
    catmull_rom16,
    validated,  ///< bilinear 2×2, each tap tested; then 3×3; then the current sample
};
enum class SampleFilter : uint8_t {
    box,
    triangle,
    gaussian,
    blackman_harris,
    mitchell,
    catmull_rom,
    b_spline,
    lanczos2,
};
enum class Rectification : uint8_t {
    off,
    clamp,           ///< to the 3×3 minimum and maximum
    clip,            ///< towards the box's centre, same box
    variance_clip,   ///< towards the mean, box μ ± k σ
    variance_clamp,  ///< to the same box
    rounded_clip,    ///< mean of the 3×3 box and the plus-shaped box, towards its centre
};
enum class ColourSpace : uint8_t { rgb, ycocg };
enum class AntiFlicker : uint8_t {
    none,
    inverse_luminance,  ///< sample and history are weighted by 1 / (1 + luminance)
    inverse_log,        ///< by 1 / (1 + log2(1 + luminance))
    luma_difference,    ///< alpha falls to its steady_share_q15 where luminances agree
};
enum class Tone : uint8_t { linear, reinhard };  ///< in which blending takes place

/// How a picture becomes larger than what is rendered: TaaPolicy::ratio_fx8.
enum class UpscaleMethod : uint8_t {
    temporal,  ///< postfx/upscale.h; Method::recursive takes `edge` instead
    bicubic,   ///< anti-aliased at the rendered size, then postfx/spatial_upscale.h
    edge,      ///< the same along the edges
};

constexpr int kNativeRatio_fx8 = 256, kMaxRatio_fx8 = 768;

struct TaaPolicy {
    Method method = Method::gather;

    JitterPattern jitter = JitterPattern::net64;
    int jitter_scale_fx8 = 256;
    bool scramble = false;  ///< another order of the samples in every cycle

    // Method::gather
    int ring = 8;  ///< raw frames kept, this one included: 1 … 16

    // Method::recursive
    Blend blend = Blend::fixed;
    int alpha_q15 = 3277;         ///< share of the new sample
    int count_cap = 64;           ///< Blend::mean
    int velocity_alpha_q15 = 0;   ///< added per pixel of motion (Blend::velocity)
    int steady_share_q15 = 8192;  ///< AntiFlicker::luma_difference
    MotionSource motion = MotionSource::surfaces;
    Dilation dilation = Dilation::nearest_depth;
    HistoryFilter history = HistoryFilter::bilinear;
    bool dering = false;  ///< hold the history filter within its inner taps
    SampleFilter sample = SampleFilter::box;
    Rectification rectification = Rectification::variance_clip;
    ColourSpace space = ColourSpace::ycocg;
    int sigma_fx8 = 256;      ///< k of μ ± kσ
    int sigma_still_fx8 = 0;  ///< k of a pixel at rest; 0 = sigma_fx8 at any speed …
    int sigma_speed = 128;    ///< … else k falls to sigma_fx8 at this many pixels a frame
    // Tests of history; 0 = not made. One that fails rejects, or, if partial, halves the weight of
    // history.
    int depth_reject_q15 = 0;   ///< largest relative difference of depth
    int normal_reject_q15 = 0;  ///< smallest cosine
    bool id_reject = false;
    int velocity_reject_fx8 = 0;  ///< largest difference of motion now and before, pixels
    int luma_reject_q15 = 0;      ///< largest relative change of luminance
    bool partial = false;
    AntiFlicker anti_flicker = AntiFlicker::none;
    Tone tone = Tone::linear;

    // Both
    /// Output size by rendered size, per axis: kNativeRatio_fx8 … kMaxRatio_fx8. The rendered size
    /// is rounded up to whole pixels.
    int ratio_fx8 = 256;
    UpscaleMethod upscaler = UpscaleMethod::temporal;
    int mip_bias_fx8 = 0;
    int sharpness_q15 = 0;  ///< of the sharpening after the resolve

    friend bool operator==(const TaaPolicy&, const TaaPolicy&) = default;
};

/// Whether a frame has fewer pixels than the picture.
constexpr bool upscales(const TaaPolicy& policy) {
    return policy.ratio_fx8 > kNativeRatio_fx8;
}
/// … that history makes good: postfx/upscale.h.
constexpr bool upscalesInTime(const TaaPolicy& policy) {
    return upscales(policy) && policy.upscaler == UpscaleMethod::temporal &&
           policy.method == Method::gather;
}
/// Width or height of the frames for one of the picture.
constexpr int renderedSize(int size, int ratio_fx8) {
    return (size * 256 + ratio_fx8 - 1) / ratio_fx8;
}
/// TaaPolicy::mip_bias_fx8 less log2 of the ratio (to 1/256): textures are as sharp as the
/// picture's pixels want them.
int mipBias_fx8(const TaaPolicy& policy);

struct TaaPreset {
    std::string_view name;
    std::string_view about;  ///< one line: whose, and where its constants are published
    TaaPolicy policy;
};

/// still, fast, tiny, the ones that upscale, then the published ones.
std::span<const TaaPreset> taaPresets();

/// Null when there is no such preset.
const TaaPreset* findPreset(std::string_view name);

/// A setting as people type it: the field's name without its unit, the value in natural units
/// ("alpha", "0.1"; "sigma", "1.25"; "history", "catmull-rom5"; "dering", "on").
struct TaaPolicyKey {
    std::string_view name;
    std::string_view values;  ///< allowed ones, for messages: "off|on", "0 … 1"
    /// Of numbers: units per 1. 0: one of `values`, whose number is its place there.
    int unit = 0;
    int low = 0, high = 0;  ///< range in units, or of places
};
std::span<const TaaPolicyKey> taaPolicyKeys();

/// The setting of one of taaPolicyKeys() as the number it is kept as.
int policyNumber(const TaaPolicy& policy, const TaaPolicyKey& key);
/// `number` is held within the key's range.
void setPolicyNumber(TaaPolicy& policy, const TaaPolicyKey& key, int number);

/// False, and nothing is changed, when there is no such key or the value is not one of its values.
/// Decimal fractions are rounded half up to the field's unit, in integers.
bool setPolicyKey(TaaPolicy& policy, std::string_view key, std::string_view value);

}  // namespace still
