#include "engine/internal/scene_materials.h"

#include <algorithm>

#include "engine/internal/image_load.h"
#include "engine/internal/json_tracks.h"
#include "engine/internal/normals.h"
#include "engine/texture.h"

namespace still {

template <class T, class Make>
int32_t SceneMaterials::textureOf(const JsonCursor& name,
                                  std::map<std::filesystem::path, int32_t>& known,
                                  std::vector<T>& textures, Make&& make) {
    const std::string text = name.text();
    const std::filesystem::path file = folder_ / text;
    const auto entry = known.find(file);
    if (entry != known.end()) {
        return entry->second;
    }
    const Result<Image<Rgba8>> image = access_.find(folder_, text).and_then([&](const auto& found) {
        scene_.files.push_back(found.string());
        return loadImage(found, max_memory_bytes_);
    });
    if (!image) {
        name.refuse(image.error().message);
        return kNoTexture;
    }
    textures.push_back(make(image->view(), Wrap::repeat));
    return known.emplace(file, int32_t(textures.size() - 1)).first->second;
}

Material SceneMaterials::readValues(const JsonCursor& cursor) {
    Material material;
    if (const auto colour = cursor.find("diffuse")) {
        material.diffuse = readColour(*colour);
    }
    if (const auto colour = cursor.find("specular")) {
        material.specular = readColour(*colour);
    }
    if (const auto colour = cursor.find("emission")) {
        material.emission = readColour(*colour);
    }
    if (const auto shininess = cursor.find("shininess")) {
        material.shininess = float(shininess->number(1, 1024));
    }
    if (const auto opacity = cursor.find("opacity")) {
        material.opacity = float(opacity->number(0, 1));
        material.alpha_mode = material.opacity < 1 ? AlphaMode::stochastic : AlphaMode::opaque;
    }
    if (const auto image = cursor.find("image")) {
        material.colour_texture = textureOf(*image, colours_, scene_.textures, makeColourTexture);
    }
    if (const auto height = cursor.find("height")) {
        readHeight(*height, material);
    }
    return material;
}

void SceneMaterials::readHeight(const JsonCursor& cursor, Material& material) {
    cursor.expectKeys({"image", "scale"});
    material.height_scale = float(cursor.require("scale").number(0, 1));
    material.height_texture =
        textureOf(cursor.require("image"), heights_, scene_.alpha_textures, makeHeightTexture);
}

uint32_t SceneMaterials::add(const Material& material) {
    scene_.materials.push_back(material);
    return uint32_t(scene_.materials.size() - 1);
}

void SceneMaterials::readShared(const JsonCursor& cursor, uint32_t material, uint32_t mesh) {
    bool has_height = scene_.materials[material].height_texture != kNoTexture;
    MaterialTracks tracks{.material = material, .offset = {}, .swaps = {}};
    if (const auto offset = cursor.find("offset")) {
        tracks.offset = readOffsetTrack(*offset);
    }
    if (const auto swaps = cursor.find("swaps")) {
        for (const JsonCursor& at : swaps->items(1, SIZE_MAX)) {
            at.expectKeys({"frame", "material"});
            const JsonCursor frame_at = at.require("frame");
            const int frame = frame_at.integer(0, kMaxFrame);
            if (!tracks.swaps.empty() && frame <= tracks.swaps.back().frame) {
                frame_at.expected("a frame after that of the swap before");
            }
            const JsonCursor values = at.require("material");
            values.expectKeys(
                {"diffuse", "specular", "shininess", "emission", "opacity", "image", "height"});
            const Material other = readValues(values);
            has_height |= other.height_texture != kNoTexture;
            tracks.swaps.push_back({frame, add(other)});
        }
    }
    if (!tracks.offset.keys.empty() || !tracks.swaps.empty()) {
        scene_.material_tracks.push_back(std::move(tracks));
    }
    if (has_height && scene_.meshes[mesh].tangents.empty()) {
        scene_.meshes[mesh].tangents = generateTangents(scene_.meshes[mesh]);
    }
}

void SceneMaterials::readOfShape(const JsonCursor& cursor, uint32_t mesh) {
    cursor.expectKeys({"diffuse", "specular", "shininess", "emission", "opacity", "image", "height",
                       "offset", "swaps"});
    const uint32_t material = scene_.meshes[mesh].parts[0].material;
    scene_.materials[material] = readValues(cursor);
    readShared(cursor, material, mesh);
}

void SceneMaterials::readOfObj(const JsonCursor& cursor, const ObjMaterials& obj) {
    for (const JsonCursor& at : cursor.items(0, SIZE_MAX)) {
        at.expectKeys({"name", "height", "offset", "swaps"});
        const JsonCursor name_at = at.require("name");
        const auto name = std::find(obj.names.begin(), obj.names.end(), name_at.text());
        if (name == obj.names.end()) {
            name_at.expected("a material that the OBJ uses");
            continue;
        }
        const uint32_t material = obj.first_material + uint32_t(name - obj.names.begin());
        if (!described_.insert(material).second) {
            name_at.refuse("expected each material once, since objects of one OBJ share them");
        }
        if (const auto height = at.find("height")) {
            readHeight(*height, scene_.materials[material]);
        }
        readShared(at, material, obj.mesh);
    }
}

}  // namespace still
