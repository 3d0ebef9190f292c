#include "postfx/policy.h"

#include <algorithm>
#include <array>
#include <optional>

#include "postfx/internal/lab_presets.h"
#include "rasterizer/fixed.h"

namespace still {
namespace {

constexpr TaaPolicy gathering(int ring) {
    TaaPolicy policy;
    policy.ring = ring;
    return policy;
}

/// Rings of temporal upscaling are as long as the time that it saves allows: postfx/README.md.
constexpr TaaPolicy upscaling(int ratio_fx8, UpscaleMethod upscaler, int ring = 8) {
    TaaPolicy policy = gathering(ring);
    policy.ratio_fx8 = ratio_fx8;
    policy.upscaler = upscaler;
    return policy;
}
constexpr int kRatio1_5 = 384, kRatio1_7 = 435, kRatio2 = 512, kRatio3 = 768;

constexpr std::array<TaaPreset, 9> kOurs{{
    {"still", "ours: gathers 8 raw frames along the motion", gathering(8)},
    {"fast", "ours, from 4 frames", gathering(4)},
    {"tiny", "ours, from 2 frames", gathering(2)},
    {"quality", "ours, rendered at 1/1.5 per axis",
     upscaling(kRatio1_5, UpscaleMethod::temporal, 7)},
    {"balanced", "ours, rendered at 1/1.7 per axis",
     upscaling(kRatio1_7, UpscaleMethod::temporal, 7)},
    {"performance", "ours, rendered at 1/2 per axis", upscaling(kRatio2, UpscaleMethod::temporal)},
    {"ultra", "ours, rendered at 1/3 per axis", upscaling(kRatio3, UpscaleMethod::temporal, 9)},
    {"bicubic", "still at 1/1.5 per axis, enlarged by Catmull-Rom",
     upscaling(kRatio1_5, UpscaleMethod::bicubic)},
    {"edge", "still at 1/1.5 per axis, enlarged along edges (AMD's FSR 1 EASU)",
     upscaling(kRatio1_5, UpscaleMethod::edge)},
}};

constexpr auto makePresets() {
    std::array<TaaPreset, kOurs.size() + lab::kRecipes.size()> all{};
    std::copy(kOurs.begin(), kOurs.end(), all.begin());
    std::copy(lab::kRecipes.begin(), lab::kRecipes.end(), all.begin() + kOurs.size());
    return all;
}
constexpr auto kPresets = makePresets();

/// Number of `value` in a list like "none|camera", if it is in it.
constexpr std::optional<int> indexIn(std::string_view list, std::string_view value) {
    for (int index = 0;; ++index) {
        const size_t bar = list.find('|');
        if (list.substr(0, bar) == value) {
            return index;
        }
        if (bar == std::string_view::npos) {
            return {};
        }
        list.remove_prefix(bar + 1);
    }
}

/// The number that up to 9 digits spell; 0 for none.
constexpr std::optional<int64_t> digitsOf(std::string_view text) {
    constexpr size_t kMostDigits = 9;
    if (text.size() > kMostDigits) {
        return {};
    }
    int64_t number = 0;
    for (const char c : text) {
        if (c < '0' || c > '9') {
            return {};
        }
        number = number * 10 + (c - '0');
    }
    return number;
}

/// A decimal number times `unit`, rounded half up.
constexpr std::optional<int64_t> scaledNumber(std::string_view text, int unit) {
    const int sign = text.starts_with('-') ? -1 : 1;
    text.remove_prefix(sign < 0 ? 1 : 0);
    const size_t point = std::min(text.find('.'), text.size());
    const std::string_view part = text.substr(std::min(point + 1, text.size()));
    const auto whole = digitsOf(text.substr(0, point)), fraction = digitsOf(part);
    if (!whole || !fraction || point + part.size() == 0) {
        return {};
    }
    int64_t ten_to = 1;
    for (size_t i = 0; i < part.size(); ++i) {
        ten_to *= 10;
    }
    // The whole part needs no rounding.
    return sign * *whole * unit + floorDiv(2 * sign * *fraction * unit + ten_to, 2 * ten_to);
}

struct Entry {
    TaaPolicyKey key;
    void (*set)(TaaPolicy&, int) = nullptr;
    int (*get)(const TaaPolicy&) = nullptr;
};

template <auto kMember>
void assign(TaaPolicy& policy, int value) {
    auto& field = policy.*kMember;
    field = static_cast<std::remove_reference_t<decltype(field)>>(value);
}

template <auto kMember>
int valueOf(const TaaPolicy& policy) {
    return int(policy.*kMember);
}

template <auto kMember>
constexpr Entry choice(std::string_view name, std::string_view values) {
    const int last = int(std::count(values.begin(), values.end(), '|'));
    return {{name, values, 0, 0, last}, assign<kMember>, valueOf<kMember>};
}
template <auto kMember>
constexpr Entry number(std::string_view name, std::string_view values, int unit, int low,
                       int high) {
    return {{name, values, unit, low, high}, assign<kMember>, valueOf<kMember>};
}

constexpr int kQ15 = 32768;
using P = TaaPolicy;

// Choices are listed in the order of their enumerators.
constexpr Entry kEntries[] = {
    choice<&P::method>("method", "gather|recursive"),
    choice<&P::jitter>("jitter",
                       "none|uniform2|rgss4|halton8|halton16|halton32|hammersley4|hammersley8|"
                       "hammersley16|net16|net32|net64|r2|blue-noise"),
    number<&P::jitter_scale_fx8>("jitter_scale", "0 ... 2", 256, 0, 512),
    choice<&P::scramble>("scramble", "off|on"),
    number<&P::ring>("ring", "1 ... 16", 1, 1, 16),
    choice<&P::blend>("blend", "fixed|mean|confidence|velocity"),
    number<&P::alpha_q15>("alpha", "0 ... 1", kQ15, 0, kQ15),
    number<&P::count_cap>("count_cap", "1 ... 255", 1, 1, 255),
    number<&P::velocity_alpha_q15>("velocity_alpha", "0 ... 1", kQ15, 0, kQ15),
    number<&P::steady_share_q15>("steady_share", "0 ... 1", kQ15, 0, kQ15),
    choice<&P::motion>("motion", "surfaces|camera"),
    choice<&P::dilation>("dilation", "centre|nearest-depth|longest"),
    choice<&P::history>("history", "nearest|bilinear|catmull-rom5|catmull-rom16|validated"),
    choice<&P::dering>("dering", "off|on"),
    choice<&P::sample>("sample",
                       "box|triangle|gaussian|blackman-harris|mitchell|catmull-rom|b-spline|"
                       "lanczos2"),
    choice<&P::rectification>("rectification",
                              "off|clamp|clip|variance-clip|variance-clamp|rounded-clip"),
    choice<&P::space>("space", "rgb|ycocg"),
    number<&P::sigma_fx8>("sigma", "0 ... 4", 256, 0, 1024),
    number<&P::sigma_still_fx8>("sigma_still", "0 ... 4", 256, 0, 1024),
    number<&P::sigma_speed>("sigma_speed", "1 ... 1000", 1, 1, 1000),
    number<&P::depth_reject_q15>("depth_reject", "0 ... 0.5", kQ15, 0, kQ15 / 2),
    number<&P::normal_reject_q15>("normal_reject", "0 ... 1", kQ15, 0, kQ15),
    choice<&P::id_reject>("id_reject", "off|on"),
    number<&P::velocity_reject_fx8>("velocity_reject", "0 ... 127", 256, 0, 32512),
    number<&P::luma_reject_q15>("luma_reject", "0 ... 1", kQ15, 0, kQ15),
    choice<&P::partial>("partial", "off|on"),
    choice<&P::anti_flicker>("anti_flicker", "none|inverse-luminance|inverse-log|luma-difference"),
    choice<&P::tone>("tone", "linear|reinhard"),
    number<&P::ratio_fx8>("ratio", "1 ... 3", 256, kNativeRatio_fx8, kMaxRatio_fx8),
    choice<&P::upscaler>("upscaler", "temporal|bicubic|edge"),
    number<&P::mip_bias_fx8>("mip_bias", "-8 ... 8", 256, -2048, 2048),
    number<&P::sharpness_q15>("sharpness", "0 ... 1", kQ15, 0, kQ15),
};

constexpr auto makeKeys() {
    std::array<TaaPolicyKey, std::size(kEntries)> keys{};
    std::transform(std::begin(kEntries), std::end(kEntries), keys.begin(),
                   [](const Entry& entry) { return entry.key; });
    return keys;
}
constexpr auto kKeys = makeKeys();

std::optional<int> parsedValue(const Entry& entry, std::string_view text) {
    const TaaPolicyKey& key = entry.key;
    if (key.unit == 0) {
        return indexIn(key.values, text);
    }
    const std::optional<int64_t> value = scaledNumber(text, key.unit);
    if (!value || *value < key.low || *value > key.high ||
        (key.unit == 1 && text.find('.') != std::string_view::npos)) {
        return {};
    }
    return int(*value);
}

const Entry* entryOf(std::string_view key) {
    return std::find_if(std::begin(kEntries), std::end(kEntries),
                        [&](const Entry& e) { return e.key.name == key; });
}

}  // namespace

int mipBias_fx8(const TaaPolicy& policy) {
    // Squaring doubles the logarithm: one bit of it a time, one more than is kept.
    int log2_fx9 = 0;
    uint64_t root = uint64_t(policy.ratio_fx8) << 22;  // 1.0 = 2^30, below 4
    while (root >= uint64_t{2} << 30) {
        root >>= 1;
        log2_fx9 += 512;
    }
    for (int bit = 256; bit > 0; bit >>= 1) {
        root = (root * root) >> 30;
        if (root >= uint64_t{2} << 30) {
            root >>= 1;
            log2_fx9 += bit;
        }
    }
    return policy.mip_bias_fx8 + roundShift(-log2_fx9, 1);
}

std::span<const TaaPreset> taaPresets() {
    return kPresets;
}

const TaaPreset* findPreset(std::string_view name) {
    const auto* found = std::find_if(kPresets.begin(), kPresets.end(),
                                     [&](const TaaPreset& preset) { return preset.name == name; });
    return found == kPresets.end() ? nullptr : found;
}

std::span<const TaaPolicyKey> taaPolicyKeys() {
    return kKeys;
}

bool setPolicyKey(TaaPolicy& policy, std::string_view key, std::string_view value) {
    const Entry* entry = entryOf(key);
    if (entry == std::end(kEntries)) {
        return false;
    }
    const std::optional<int> parsed = parsedValue(*entry, value);
    if (parsed) {
        entry->set(policy, *parsed);
    }
    return parsed.has_value();
}

int policyNumber(const TaaPolicy& policy, const TaaPolicyKey& key) {
    return entryOf(key.name)->get(policy);
}

void setPolicyNumber(TaaPolicy& policy, const TaaPolicyKey& key, int number) {
    entryOf(key.name)->set(policy, std::clamp(number, key.low, key.high));
}

}  // namespace still
