#include "engine/memory_need.h"

#include <array>
#include <vector>

namespace still {
namespace {

template <class T>
uint64_t bytesOf(const std::vector<T>& elements) {
    return elements.size() * sizeof(T);
}

/// Of each pixel of a frame: what is drawn.
uint64_t drawnBytes(const FrameSettings& s, bool light_is_sampled) {
    const bool temporal = s.anti_aliasing == AntiAliasing::taa;
    const bool gathers = temporal && s.policy.method == Method::gather;
    const bool denoises =
        light_is_sampled && s.denoise == Denoise::svgf && s.anti_aliasing != AntiAliasing::ssaa;
    uint64_t bytes = 3 * sizeof(uint16_t) + sizeof(uint32_t) + sizeof(uint16_t);
    if (s.planes.normal || gathers || light_is_sampled) {
        bytes += sizeof(uint32_t);
    }
    if (s.planes.motion || temporal || denoises) {
        bytes += sizeof(Motion) + sizeof(uint16_t);
    }
    if (light_is_sampled) {
        constexpr uint64_t kLight = 6 * sizeof(uint16_t), kAlbedo = 3 * sizeof(uint16_t);
        constexpr uint64_t kDenoiser = 150;  // two pasts of 53, another of 40, passes of a filter
        bytes += kLight + kAlbedo + (denoises ? kDenoiser : 0);
    }
    return bytes;
}

/// What a temporal method keeps of each pixel of the frame, and of the picture.
struct PastBytes {
    uint64_t frame = 0, picture = 0;
};
PastBytes pastBytes(const TaaPolicy& policy) {
    constexpr uint64_t kColour = 3 * sizeof(uint16_t);
    constexpr uint64_t kSlot = 10 * sizeof(int16_t);  // taa::SlotPlanes
    constexpr uint64_t kHint = sizeof(int16_t);
    PastBytes bytes;
    if (policy.method == Method::recursive) {
        // Colours of more bits before and now, what is shown, and confidence.
        bytes.frame = 2 * 3 * sizeof(uint32_t) + kColour + 1;
    } else if (upscalesInTime(policy)) {
        constexpr uint64_t kSums = 3 * sizeof(uint32_t) + 2 * sizeof(uint16_t);
        bytes.frame = uint64_t(policy.ring) * kSlot + kHint;
        bytes.picture = kSums + kColour + 1;
    } else {
        constexpr uint64_t kSums = kColour + 3 + 1;
        bytes.frame = uint64_t(policy.ring) * kSlot + kHint + kSums + kColour + 1;
    }
    if (upscales(policy) && !upscalesInTime(policy)) {
        bytes.frame += 4 * sizeof(float);  // SpatialUpscaler
        bytes.picture += kColour;
    }
    if (policy.sharpness_q15 > 0) {
        bytes.picture += kColour;
    }
    return bytes;
}

}  // namespace

uint64_t sceneMemoryBytes(const Scene& scene) {
    uint64_t bytes = 0;
    for (const Mesh& m : scene.meshes) {
        bytes += bytesOf(m.x) + bytesOf(m.y) + bytesOf(m.z) + bytesOf(m.attributes) +
                 bytesOf(m.tangents) + bytesOf(m.indices) + bytesOf(m.parts);
    }
    for (const Texture& texture : scene.textures) {
        bytes += bytesOf(texture.texels);
    }
    for (const AlphaTexture& texture : scene.alpha_textures) {
        bytes += bytesOf(texture.texels);
    }
    return bytes;
}

uint64_t frameMemoryBytes(const FrameSettings& s, bool light_is_sampled) {
    const bool temporal = s.anti_aliasing == AntiAliasing::taa;
    const int ratio_fx8 = temporal ? s.policy.ratio_fx8 : kNativeRatio_fx8;
    const uint64_t picture = uint64_t(s.width) * uint64_t(s.height);
    const uint64_t frame =
        uint64_t(renderedSize(s.width, ratio_fx8)) * uint64_t(renderedSize(s.height, ratio_fx8));
    uint64_t bytes = frame * drawnBytes(s, light_is_sampled) + picture * sizeof(Rgb8);
    if (temporal) {
        const PastBytes past = pastBytes(s.policy);
        bytes += frame * past.frame + picture * past.picture;
    }
    if (s.anti_aliasing == AntiAliasing::fxaa) {
        bytes += picture * 3 * sizeof(uint16_t);
    } else if (s.anti_aliasing == AntiAliasing::ssaa && s.ssaa_samples > 1) {
        bytes += picture * 3 * (sizeof(uint32_t) + sizeof(uint16_t));
    }
    return bytes;
}

std::string bytesText(uint64_t bytes) {
    constexpr std::array<const char*, 5> kUnits{"KB", "MB", "GB", "TB", "PB"};
    if (bytes < 1024) {
        return std::to_string(bytes) + " bytes";
    }
    size_t unit = 0;
    uint64_t size = uint64_t{1024};  // of the unit
    while (unit + 1 < kUnits.size() && bytes / size >= 1024) {
        size *= 1024;
        ++unit;
    }
    // Tenths, from whole units and the rest, so that nothing overflows.
    const uint64_t tenths = bytes / size * 10 + (bytes % size * 10 + size - 1) / size;
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " " + kUnits[unit];
}

Result<void> checkMemory(const std::string& name, uint64_t needed_bytes, uint64_t allowed_bytes) {
    if (needed_bytes <= allowed_bytes) {
        return {};
    }
    return fail(name + ": needs about " + bytesText(needed_bytes) + " of memory, " +
                bytesText(allowed_bytes) + " are allowed (--max-memory)");
}

Result<void> checkFrameMemory(const std::string& name, const Scene& scene,
                              const FrameSettings& settings, uint64_t allowed_bytes, int loops) {
    const std::string size =
        std::to_string(settings.width) + "x" + std::to_string(settings.height);
    return checkMemory(name + " at " + size,
                       sceneMemoryBytes(scene) +
                           uint64_t(loops) * frameMemoryBytes(settings, scene.lights.sampled()),
                       allowed_bytes);
}

}  // namespace still
