// The suite of noise: scenes lit by one random sample a pixel, and what a denoiser may get wrong.

#include "demos/scenes/atlas.h"
#include "demos/scenes/scenes.h"

namespace still {
namespace {

constexpr int kReferenceSamples = 4096;

AtlasCase movingNoise(const char* name, const char* failure, const char* measure, Scene (*make)()) {
    return {.name = name,
            .failure = failure,
            .measure = measure,
            .make = make,
            .segments = {{.name = "moving",
                          .first = 24,
                          .last = 38,
                          .step = 2,
                          .ssaa_samples = kReferenceSamples}}};
}

std::vector<AtlasCase> allNoiseCases() {
    AtlasCase penumbra = movingNoise("penumbra",
                                     "A wide soft shadow moves: what is kept of it is a trail, "
                                     "what is dropped is noise.",
                                     "trail", scenes::makePenumbra);
    penumbra.trail = true;
    const AtlasCase switch_off{
        .name = "switch-off",
        .failure = "Means of many frames glow on when a lamp goes out.",
        .measure = "residual",
        .make = scenes::makeSwitchOff,
        .segments = {{.name = "event", .first = 31, .last = 42, .ssaa_samples = kReferenceSamples}},
        .event_frame = 32};
    return {
        settledNoise("cornell", "Light from one bounce is noisier than light from a lamp.",
                     scenes::makeCornell),
        settledNoise("contact", "Contact shadows are smaller than the filters that take the noise.",
                     scenes::makeContact),
        penumbra,
        movingNoise("moving-light", "The light of every pixel is another one in every frame.",
                    "psnr", scenes::makeMovingLight),
        switch_off,
    };
}

}  // namespace

AtlasCase settledNoise(std::string name, std::string failure, std::function<Scene()> make) {
    return {.name = std::move(name),
            .failure = std::move(failure),
            .measure = "ssim",
            .make = std::move(make),
            .segments = {
                {.name = "still", .first = 31, .last = 46, .ssaa_samples = kReferenceSamples}}};
}

const std::vector<AtlasCase>& noiseCases() {
    static const std::vector<AtlasCase> cases = allNoiseCases();
    return cases;
}

}  // namespace still
