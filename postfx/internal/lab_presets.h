#pragma once
// The recipes of the laboratory as compile-time values: postfx/policy.cpp lists them for people,
// the SIMD kernels are specialised for them. Sources, and what each recipe leaves out:
// postfx/README.md.

#include <array>
#include <string_view>

#include "postfx/policy.h"

namespace still::lab {

constexpr TaaPolicy kBasic{
    .method = Method::recursive,
    .jitter = JitterPattern::halton16,
    .alpha_q15 = 1638,  // 0.05
    .dilation = Dilation::nearest_depth,
    .history = HistoryFilter::bilinear,
    .rectification = Rectification::clamp,
    .space = ColourSpace::rgb,
};

constexpr TaaPolicy kVariance{
    .method = Method::recursive,
    .jitter = JitterPattern::halton16,
    .alpha_q15 = 3277,  // 0.1
    .dilation = Dilation::nearest_depth,
    .history = HistoryFilter::catmull_rom16,
    .rectification = Rectification::variance_clip,
    .space = ColourSpace::ycocg,
    .sigma_fx8 = 256,
};

constexpr TaaPolicy kInside{
    .method = Method::recursive,
    .jitter = JitterPattern::halton16,
    .alpha_q15 = 3932,         // 0.12 …
    .steady_share_q15 = 8192,  // … × 0.25 = 0.03
    .dilation = Dilation::nearest_depth,
    .history = HistoryFilter::bilinear,
    .sample = SampleFilter::triangle,
    .rectification = Rectification::rounded_clip,
    .space = ColourSpace::rgb,
    .anti_flicker = AntiFlicker::luma_difference,
};

constexpr TaaPolicy kIntel{
    .method = Method::recursive,
    .jitter = JitterPattern::halton16,
    .blend = Blend::mean,
    .count_cap = 16,
    .dilation = Dilation::longest,
    .history = HistoryFilter::catmull_rom5,
    .rectification = Rectification::variance_clamp,
    .space = ColourSpace::ycocg,
    .sigma_fx8 = 192,        // 0.75 at speed …
    .sigma_still_fx8 = 512,  // … 2 at rest
    .sigma_speed = 128,
    .depth_reject_q15 = 655,  // 0.02
    .tone = Tone::reinhard,
};

constexpr TaaPolicy kFilament{
    .method = Method::recursive,
    .jitter = JitterPattern::halton16,
    .alpha_q15 = 3932,  // 0.12
    .motion = MotionSource::camera,
    .dilation = Dilation::centre,
    .history = HistoryFilter::catmull_rom5,
    .dering = true,
    .sample = SampleFilter::lanczos2,
    .rectification = Rectification::rounded_clip,
    .space = ColourSpace::rgb,
    .tone = Tone::reinhard,
    .mip_bias_fx8 = -256,
};

constexpr TaaPolicy kGodot{
    .method = Method::recursive,
    .jitter = JitterPattern::halton16,
    .blend = Blend::mean,
    .count_cap = 16,
    .dilation = Dilation::nearest_depth,
    .history = HistoryFilter::catmull_rom16,
    .rectification = Rectification::variance_clip,
    .space = ColourSpace::ycocg,
    .sigma_fx8 = 102,        // 0.4 at speed …
    .sigma_still_fx8 = 256,  // … 1 at rest
    .sigma_speed = 128,
    .velocity_reject_fx8 = 640,  // 2.5 px
    .partial = true,
    .anti_flicker = AntiFlicker::luma_difference,
    .tone = Tone::reinhard,
};

constexpr TaaPolicy kFsrLike{
    .method = Method::recursive,
    .jitter = JitterPattern::halton8,
    .blend = Blend::confidence,
    .alpha_q15 = 1901,  // 0.058
    .dilation = Dilation::nearest_depth,
    .history = HistoryFilter::catmull_rom16,
    .dering = true,
    .sample = SampleFilter::lanczos2,
    .rectification = Rectification::variance_clamp,
    .space = ColourSpace::ycocg,
    .sigma_fx8 = 256,        // 1 at speed …
    .sigma_still_fx8 = 768,  // … 3 at rest
    .sigma_speed = 20,
    .depth_reject_q15 = 655,  // 0.02
    .tone = Tone::reinhard,
    .mip_bias_fx8 = -256,
    .sharpness_q15 = 16384,  // 0.5
};

constexpr TaaPolicy kEmaConsistent{
    .method = Method::recursive,
    .jitter = JitterPattern::halton16,
    .alpha_q15 = 6554,  // 0.2
    .dilation = Dilation::centre,
    .history = HistoryFilter::validated,
    .rectification = Rectification::off,
    .space = ColourSpace::rgb,
    .depth_reject_q15 = 655,     // 0.02
    .normal_reject_q15 = 29491,  // 0.9
    .id_reject = true,
};

/// In the order of taaPresets(), after ours.
constexpr std::array<TaaPreset, 8> kRecipes{{
    {"basic", "textbook: Halton, 3x3 min/max clamp, 0.95 history", kBasic},
    {"variance", "Salvi 2016: variance clip k = 1, alpha 0.1, Catmull-Rom", kVariance},
    {"inside", "Playdead's INSIDE, Pedersen 2016: rounded clip, feedback 0.88 ... 0.97", kInside},
    {"intel", "Intel TAA: variance clamp k = 0.75 ... 2, running mean", kIntel},
    {"filament", "Google Filament: Lanczos sample, camera motion only, alpha 0.12", kFilament},
    {"godot", "Godot 4: variance clip in tone-mapped YCoCg, mean of up to 16", kGodot},
    {"fsr-like", "AMD FSR 2/3 at native size, without locks: 3 sigma at rest, sharpened", kFsrLike},
    {"ema-consistent", "SVGF's reprojection: alpha 0.2, tested 2x2, then 3x3 taps, no clip",
     kEmaConsistent},
}};

/// `policy` without what the resolve does not read: equal values resolve to equal bytes.
constexpr TaaPolicy resolvePart(TaaPolicy policy) {
    constexpr TaaPolicy kDefault{};
    policy.jitter = kDefault.jitter;
    policy.jitter_scale_fx8 = kDefault.jitter_scale_fx8;
    policy.scramble = kDefault.scramble;
    policy.ring = kDefault.ring;
    policy.motion = kDefault.motion;
    policy.mip_bias_fx8 = kDefault.mip_bias_fx8;
    policy.sharpness_q15 = kDefault.sharpness_q15;
    return policy;
}

}  // namespace still::lab
