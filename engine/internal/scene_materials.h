#pragma once
// Materials of scene files: values, images, and how they change over time. Keys, units and limits
// as in engine/README.md.

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/internal/file_access.h"
#include "engine/internal/json.h"
#include "engine/scene.h"

namespace still {

/// Materials of one OBJ in a scene: numbers first_material … first_material + names.size() − 1.
struct ObjMaterials {
    uint32_t mesh = 0;
    uint32_t first_material = 0;
    std::vector<std::string> names{};  ///< as in the MTL
};

/// Adds to one scene what its file says about materials. Each image is read once per use.
class SceneMaterials {
  public:
    /// Images are looked for in `folder`. `access` and scene must outlive this.
    SceneMaterials(std::filesystem::path folder, const FileAccess& access,
                   uint64_t max_memory_bytes, Scene& scene)
        : folder_(std::move(folder)),
          access_(access),
          max_memory_bytes_(max_memory_bytes),
          scene_(scene) {}

    /// A shape's "material": sets that of the mesh's only part.
    void readOfShape(const JsonCursor& cursor, uint32_t mesh);
    /// An OBJ's "materials": height maps and changes of those that it brings.
    void readOfObj(const JsonCursor& cursor, const ObjMaterials& obj);

  private:
    Material readValues(const JsonCursor& cursor);
    void readHeight(const JsonCursor& cursor, Material& material);
    /// Height map, offset and swaps of a material of `mesh`.
    void readShared(const JsonCursor& cursor, uint32_t material, uint32_t mesh);
    uint32_t add(const Material& material);
    template <class T, class Make>
    int32_t textureOf(const JsonCursor& name, std::map<std::filesystem::path, int32_t>& known,
                      std::vector<T>& textures, Make&& make);

    std::filesystem::path folder_;
    const FileAccess& access_;
    uint64_t max_memory_bytes_;
    Scene& scene_;
    std::map<std::filesystem::path, int32_t> colours_, heights_;
    std::set<uint32_t> described_;  ///< materials that an OBJ's "materials" named
};

}  // namespace still
