#pragma once
// The statements of an MTL library that Stillframe uses.

#include <array>
#include <string>
#include <vector>

namespace still {

/// One image statement (map_Kd, map_d, bump, norm).
struct MtlImage {
    std::string file;  ///< as written; empty: no such statement
    bool clamp = false;
    bool moved = false;  ///< -s, -o or -t with other than the default; not supported
    float bump_scale = 1.0f;
};

struct MtlMaterial {
    std::string name;
    std::array<float, 3> diffuse{0.8f, 0.8f, 0.8f};  ///< 1 where there is an image but no Kd
    std::array<float, 3> specular{0.0f, 0.0f, 0.0f};
    std::array<float, 3> emission{0.0f, 0.0f, 0.0f};
    float shininess = 10.0f;  ///< 1 … 1024
    float opacity = 1.0f;     ///< 0 … 1
    MtlImage map_kd, map_d, bump, norm;
};

/// Parses MTL text. Never fails: what is not understood is skipped or, where a number is broken,
/// noted in `warnings` (one line, starting with `name`) and left at its default. Where a name is
/// defined twice the first definition is the one to use.
std::vector<MtlMaterial> parseMtl(std::string text, const std::string& name,
                                  std::vector<std::string>& warnings);

}  // namespace still
