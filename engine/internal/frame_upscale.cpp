// Frames that are smaller than the picture.

#include "engine/internal/frame_loop_state.h"

namespace still {

/// Whether the finished picture is enlarged in space.
bool FrameLoop::State::enlarges() const {
    return temporal() && upscales(settings.policy);
}

int FrameLoop::State::renderedWidth() const {
    return temporal() ? renderedSize(settings.width, settings.policy.ratio_fx8) : settings.width;
}
int FrameLoop::State::renderedHeight() const {
    return temporal() ? renderedSize(settings.height, settings.policy.ratio_fx8) : settings.height;
}

void FrameLoop::State::enlarge() {
    for (Image<uint16_t>* plane : {&enlarged.red, &enlarged.green, &enlarged.blue}) {
        plane->resize(settings.width, settings.height);
    }
    const bool bicubic = settings.policy.upscaler == UpscaleMethod::bicubic;
    enlarger.run(gathers() ? taa.colour() : laboratory.colour(),
                 bicubic ? EnlargeFilter::bicubic : EnlargeFilter::edge,
                 {enlarged.red.view(), enlarged.green.view(), enlarged.blue.view()}, settings.simd,
                 workers);
}

}  // namespace still
