// Any bytes as an image, and textures of what they decode to.

#include "engine/internal/image_load.h"
#include "rasterizer/draw_list_check.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace still;
    const Result<Image<Rgba8>> image = decodeImage({data, size}, "fuzz");
    if (!image) {
        return 0;
    }
    const ImageView<const Rgba8> pixels = image->view();
    constexpr int kSmall = 128;
    if (pixels.width > kSmall || pixels.height > kSmall) {
        return 0;
    }
    const Wrap wrap = size % 2 == 0 ? Wrap::repeat : Wrap::clamp;
    fuzz::require(flawOf(makeColourTexture(pixels, wrap)) == nullptr, "colour textures are sound");
    fuzz::require(flawOf(makeNormalTexture(pixels, wrap)) == nullptr, "normal maps are sound");
    fuzz::require(flawOf(makeNormalTextureFromHeight(pixels, wrap, 2.0f)) == nullptr,
                  "normal maps of heights are sound");
    fuzz::require(flawOf(makeAlphaTexture(pixels, wrap, size % 3 == 0)) == nullptr,
                  "alpha textures are sound");
    return 0;
}
