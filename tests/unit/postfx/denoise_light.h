#pragma once
// Planes of light for tests of the denoiser.

#include <array>

#include "postfx/denoise.h"

namespace denoise_light {

using namespace still;

struct Light {
    LightImages images;
    LightChangeImages changes;

    LightPlanes planes() const {
        return {{images.direct_red.view(), images.direct_green.view(), images.direct_blue.view()},
                {images.indirect_red.view(), images.indirect_green.view(),
                 images.indirect_blue.view()}};
    }
    LightChange change() const {
        return {changes.direct_before.view(), changes.direct_now.view(),
                changes.indirect_before.view(), changes.indirect_now.view()};
    }
    void resize(int width, int height) {
        for (Image<uint16_t>* plane : all()) {
            plane->resize(width, height);
        }
        for (Image<uint16_t>* plane : allChanges()) {
            plane->resize((width + kLightBlock - 1) / kLightBlock,
                          (height + kLightBlock - 1) / kLightBlock);
        }
    }
    std::array<Image<uint16_t>*, 6> all() {
        return {&images.direct_red,   &images.direct_green,   &images.direct_blue,
                &images.indirect_red, &images.indirect_green, &images.indirect_blue};
    }
    std::array<Image<uint16_t>*, 4> allChanges() {
        return {&changes.direct_before, &changes.direct_now, &changes.indirect_before,
                &changes.indirect_now};
    }
};

}  // namespace denoise_light
