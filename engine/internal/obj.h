#pragma once
// An OBJ file with its MTL libraries and images as values the rasterizer can draw.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/load.h"
#include "engine/result.h"
#include "engine/scene.h"

namespace still {

/// One OBJ file. `mesh` has one part per run of faces that share group (or object) and material, in
/// file order; material and texture numbers are local to this model.
struct ObjModel {
    Mesh mesh;
    std::vector<Material> materials;
    std::vector<std::string> material_names;  ///< one each, as in the MTL; "" of undefined ones
    std::vector<Texture> textures;
    std::vector<AlphaTexture> alpha_textures;
    std::vector<std::string> warnings;  ///< one line each, naming the file
    std::vector<std::string> files;     ///< see Scene::files
};

/// Loads FILE.obj, the MTL libraries it names and the images they name. Images are decoded by
/// several threads; the result does not depend on how many.
/// Refused with an Error: a file that cannot be read, has no triangle, has a coordinate that is not
/// finite (or beyond ±1e18), or a face with a vertex that does not exist. Everything else that is
/// odd (missing libraries and images, unknown materials, broken texture coordinates or normals)
/// becomes a warning and a usable model. What stands in `options.cache_folder` is taken instead
/// when it is the same.
Result<ObjModel> loadObj(const std::filesystem::path& file, const LoadOptions& options = {});

/// The same from text that comes from nowhere in particular: `name` stands for it in messages, and
/// what it names is looked for beside that.
Result<ObjModel> parseObjModel(std::string text, const std::filesystem::path& name,
                               const LoadOptions& options = {});

/// Moves the model's assets to the end of the scene's, with indices adjusted, and returns the
/// number of its mesh. Adds no object.
uint32_t appendModel(Scene& scene, ObjModel&& model, std::string name);

}  // namespace still
