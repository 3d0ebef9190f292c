#include "demos/stillframe/equal_time.h"

#include <algorithm>
#include <cmath>

#include "demos/stillframe/case_loop.h"
#include "postfx/metrics.h"

namespace still::command {
namespace {

/// Upwards: what samples are short of is not their own.
int samplesFor(int frames, double share) {
    return std::clamp(int(std::ceil(share * frames)), 1, 65536);
}

}  // namespace

EqualTime measureEqualTime(const PreparedCase& prepared, size_t segment, double share) {
    const std::vector<CaseFrame>& compared = prepared.segments[segment];
    const bool still = isStill(prepared.scene, {});
    EqualTime result{.samples = samplesFor(still ? compared.front().frame + 1 : 1, share),
                     .frames = still ? 1 : int(compared.size())};
    const Mode mode{.name = {},
                    .anti_aliasing = AntiAliasing::ssaa,
                    .ssaa_samples = result.samples,
                    .denoise = Denoise::off};
    CaseLoop loop(*prepared.atlas, prepared.scene, mode.settings(prepared.view));
    PixelError error;
    for (size_t i = 0; i < size_t(result.frames); ++i) {
        const ImageView<const Rgb8> reference = compared[i].reference.picture.view();
        const ImageView<const Rgb8> picture = loop.render(compared[i].frame).output;
        error += pixelError(picture, reference);
        result.ssim += ssim(picture, reference) / result.frames;
    }
    result.rms = rmse(error);
    return result;
}

}  // namespace still::command
