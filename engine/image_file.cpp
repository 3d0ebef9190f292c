#include "engine/image_file.h"

#include "engine/internal/image_load.h"

namespace still {

Result<Image<Rgb8>> readImageFile(const std::filesystem::path& file) {
    return loadImage(file).map([](const Image<Rgba8>& from) {
        Image<Rgb8> image(from.width(), from.height());
        for (int y = 0; y < from.height(); ++y) {
            for (int x = 0; x < from.width(); ++x) {
                const Rgba8 c = from.at(x, y);
                image.at(x, y) = {c.r, c.g, c.b};
            }
        }
        return image;
    });
}

}  // namespace still
