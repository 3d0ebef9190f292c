#pragma once
// Materials as the rasterizer wants them, from MTL blocks and the images they name.

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/internal/input_log.h"
#include "engine/internal/mtl_parse.h"
#include "rasterizer/draw_list.h"

namespace still {

/// A material and where it comes from.
struct MtlSource {
    MtlMaterial material;
    std::filesystem::path library;  ///< images are looked for beside it
};

struct MaterialSet {
    std::vector<Material> materials;  ///< one per source
    std::vector<Texture> textures;
    std::vector<AlphaTexture> alpha_textures;
    std::vector<std::string> warnings;
    std::optional<Error> memory_error;  ///< an image needs more than there is: nothing else counts
};

/// Reads each image once (by several threads) and builds each texture once per way of using it.
/// Order and contents do not depend on the threads. Missing and broken images, and those that
/// must not be read, become warnings, and the materials do without.
///  - Alpha: map_d (its alpha channel where that is used, else its luminance), otherwise the alpha
///    channel of map_Kd; none when everything is opaque.
///  - Relief: `norm` is a normal map; `bump` is a height map when it is grey, else a normal map.
/// `meanwhile`, if any, is called once, by one of the threads, with what is known before images are
/// read: which sources have an image for a normal map. What it throws is passed on.
MaterialSet buildMaterials(
    std::span<const MtlSource> sources, InputLog& log,
    const std::function<void(const std::vector<bool>& normal_mapped)>& meanwhile = {});

}  // namespace still
