// MTL statements: numbers by parseNumber(), images through tinyobjloader with what it gets wrong
// put right first: after -s, -o and -t it eats up to three words, numbers or not.

#include "engine/internal/mtl_parse.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

#include "engine/internal/obj_text.h"

#include <tiny_obj_loader.h>

namespace still {

namespace {

/// Moves `count` words from `rest` to `out`.
void copyWords(std::string& out, std::string_view& rest, int count) {
    for (int i = 0; i < count; ++i) {
        out.append(takeWord(rest)).push_back(' ');
    }
}

/// An image statement with the numbers after -s, -o and -t filled up to three.
std::string withFullOptions(std::string_view line) {
    std::string out;
    copyWords(out, line, 1);
    while (true) {
        std::string_view rest = line;
        const std::string_view word = takeWord(rest);
        if (word.size() < 2 || word[0] != '-') {
            return out.append(trimmed(line));
        }
        copyWords(out, line, 1);
        if (word != "-s" && word != "-o" && word != "-t") {
            copyWords(out, line, word == "-mm" ? 2 : 1);
            continue;
        }
        for (int i = 0; i < 3; ++i) {
            rest = line;
            if (parseNumber(takeWord(rest))) {
                copyWords(out, line, 1);
            } else {
                out.append(word == "-s" ? "1 " : "0 ");
            }
        }
    }
}

MtlImage imageOf(const std::string& name, const tinyobj::texture_option_t& options) {
    MtlImage image;
    image.file = std::string(trimmed(name));
    image.clamp = options.clamp;
    image.bump_scale = std::isfinite(options.bump_multiplier)
                           ? std::clamp(options.bump_multiplier, -1000.0f, 1000.0f)
                           : 1.0f;
    for (int i = 0; i < 3; ++i) {
        image.moved |= options.scale[i] != 1.0f || options.origin_offset[i] != 0.0f ||
                       options.turbulence[i] != 0.0f;
    }
    return image;
}

/// The numbers of one newmtl block.
struct MtlNumbers {
    std::string name;
    std::optional<std::array<float, 3>> kd, ks, ke;
    std::optional<float> ns, d, tr;
};

/// `count` numbers; one alone stands for all. Nothing, and a warning, when they are not finite.
std::optional<std::array<float, 3>> readNumbers(std::string_view line, int count,
                                                const std::string& where,
                                                std::vector<std::string>& warnings) {
    std::array<float, 3> values{};
    for (int i = 0; i < count; ++i) {
        const std::string_view word = takeWord(line);
        const bool alone = i == 1 && word.empty();
        const double number = parseNumber(word).value_or(NAN);
        if (alone) {
            return std::array<float, 3>{values[0], values[0], values[0]};
        }
        if (!(std::abs(number) <= kMaxObjNumber)) {
            warnings.push_back(where + ": \"" + shownText(word) +
                               "\" is not a finite number, the default is used");
            return std::nullopt;
        }
        values[size_t(i)] = float(number);
    }
    return values;
}

/// Reads the statement into `block` if it is one of numbers.
void readMtlNumbers(std::string_view line, MtlNumbers& block, const std::string& where,
                    std::vector<std::string>& warnings) {
    std::string_view rest = line;
    const std::string_view key = takeWord(rest);
    if (key == "Kd" || key == "Ks" || key == "Ke") {
        std::optional<std::array<float, 3>>& colour =
            key == "Kd" ? block.kd : (key == "Ks" ? block.ks : block.ke);
        colour = readNumbers(rest, 3, where, warnings);
    } else if (key == "Ns" || key == "d" || key == "Tr") {
        std::string_view after = rest;
        if (takeWord(after) == "-halo") {
            rest = after;
        }
        if (const auto number = readNumbers(rest, 1, where, warnings)) {
            (key == "Ns" ? block.ns : (key == "d" ? block.d : block.tr)) = (*number)[0];
        }
    }
}

std::array<float, 3> notNegative(std::array<float, 3> colour) {
    for (float& c : colour) {
        c = std::clamp(c, 0.0f, 1e6f);
    }
    return colour;
}

/// Numbers from `block`, images from `images`.
MtlMaterial materialOf(const MtlNumbers& block, const tinyobj::material_t& images) {
    MtlMaterial m;
    m.name = block.name;
    m.map_kd = imageOf(images.diffuse_texname, images.diffuse_texopt);
    m.map_d = imageOf(images.alpha_texname, images.alpha_texopt);
    m.bump = imageOf(images.bump_texname, images.bump_texopt);
    m.norm = imageOf(images.normal_texname, images.normal_texopt);
    const float grey = m.map_kd.file.empty() ? 0.8f : 1.0f;
    m.diffuse = notNegative(block.kd.value_or(std::array<float, 3>{grey, grey, grey}));
    m.specular = notNegative(block.ks.value_or(m.specular));
    m.emission = notNegative(block.ke.value_or(m.emission));
    m.shininess = std::clamp(block.ns.value_or(m.shininess), 1.0f, 1024.0f);
    // `d` is the specification's; `Tr` = 1 − d is what some programs write instead.
    m.opacity = std::clamp(block.d.value_or(1.0f - block.tr.value_or(0.0f)), 0.0f, 1.0f);
    return m;
}

}  // namespace

std::vector<MtlMaterial> parseMtl(std::string text, const std::string& name,
                                  std::vector<std::string>& warnings) {
    normaliseLines(text);
    // The statements of images go on to tinyobjloader, with the blocks named by their number.
    std::vector<MtlNumbers> blocks;
    std::string images;
    size_t line_number = 0;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = text.find('\n', begin);
        const std::string_view line = trimmed({text.data() + begin, end - begin});
        begin = end + 1;
        ++line_number;
        if (startsStatement(line, "newmtl")) {
            images += "newmtl " + std::to_string(blocks.size()) + "\n";
            blocks.push_back({std::string(trimmed(line.substr(6))), {}, {}, {}, {}, {}, {}});
        } else if (!blocks.empty() && (line.starts_with("map_") || line.starts_with("bump") ||
                                       line.starts_with("norm"))) {
            images += withFullOptions(line) + "\n";
        } else if (!blocks.empty()) {
            readMtlNumbers(line, blocks.back(), name + ":" + std::to_string(line_number), warnings);
        }
    }
    std::istringstream stream(images);
    std::map<std::string, int> ignored_map;
    std::vector<tinyobj::material_t> parsed;
    std::string ignored_warning, ignored_error;
    tinyobj::LoadMtl(&ignored_map, &parsed, &stream, &ignored_warning, &ignored_error);
    std::vector<MtlMaterial> materials;
    for (size_t i = 0; i < blocks.size(); ++i) {
        materials.push_back(materialOf(blocks[i], parsed[i]));
    }
    return materials;
}

}  // namespace still
