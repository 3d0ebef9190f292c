// OBJ text → triangles with shared vertices → parts with materials.

#include <algorithm>
#include <bit>
#include <cmath>
#include <exception>
#include <map>
#include <optional>
#include <utility>

#include "engine/internal/input_log.h"
#include "engine/internal/model_cache.h"
#include "engine/internal/mtl_parse.h"
#include "engine/internal/mtl_textures.h"
#include "engine/internal/normals.h"
#include "engine/internal/obj.h"
#include "engine/internal/obj_parse.h"
#include "engine/internal/obj_polygon.h"
#include "engine/internal/obj_text.h"
#include "engine/internal/obj_unique.h"
#include "engine/memory_need.h"

namespace still {

namespace {

/// Triangles cut from the faces, as numbers of ObjFile::corners.
struct CutFaces {
    std::vector<uint32_t> corners;
    std::vector<MeshPart> parts;
};

bool isDegenerate(const Vector3f& a, const Vector3f& b, const Vector3f& c) {
    std::array<double, 3> ab, ac;
    for (size_t k = 0; k < 3; ++k) {
        ab[k] = double(b[k]) - a[k];
        ac[k] = double(c[k]) - a[k];
    }
    return ab[1] * ac[2] - ab[2] * ac[1] == 0.0 && ab[2] * ac[0] - ab[0] * ac[2] == 0.0 &&
           ab[0] * ac[1] - ab[1] * ac[0] == 0.0;
}

void cutFace(const ObjFile& file, uint32_t begin, uint32_t end, CutFaces& out) {
    const auto position = [&](uint32_t corner) -> const Vector3f& {
        return file.positions[size_t(file.corners[corner].position)];
    };
    if (end - begin == 3) {
        if (!isDegenerate(position(begin), position(begin + 1), position(begin + 2))) {
            out.corners.insert(out.corners.end(), {begin, begin + 1, begin + 2});
        }
        return;
    }
    std::vector<Vector3f> polygon;
    polygon.reserve(end - begin);
    for (uint32_t c = begin; c < end; ++c) {
        polygon.push_back(position(c));
    }
    std::vector<std::array<uint32_t, 3>> triangles;
    triangulatePolygon(polygon, triangles);
    for (const auto& [a, b, c] : triangles) {
        if (!isDegenerate(polygon[a], polygon[b], polygon[c])) {
            out.corners.insert(out.corners.end(), {begin + a, begin + b, begin + c});
        }
    }
}

/// Surfaces are numbered with 15 bits. When a file has more groups than that, neighbours with the
/// same material become one part.
void mergeParts(std::vector<MeshPart>& parts) {
    if (parts.size() < kMaxSurfaces) {
        return;
    }
    std::vector<MeshPart> merged;
    for (const MeshPart& part : parts) {
        if (!merged.empty() && merged.back().material == part.material) {
            merged.back().triangle_count += part.triangle_count;
        } else {
            merged.push_back(part);
        }
    }
    parts = std::move(merged);
}

/// `material_of_run` gives each run's material.
CutFaces cutFaces(const ObjFile& file, const std::vector<uint32_t>& material_of_run) {
    CutFaces out;
    out.corners.reserve(file.corners.size() * 3 / 2);
    for (size_t run = 0; run < file.runs.size(); ++run) {
        const uint32_t face_end =
            run + 1 < file.runs.size() ? file.runs[run + 1].first_face : uint32_t(file.faceCount());
        const uint32_t first = uint32_t(out.corners.size() / 3);
        for (uint32_t face = file.runs[run].first_face; face < face_end; ++face) {
            cutFace(file, file.face_begin[face], file.face_begin[face + 1], out);
        }
        const uint32_t count = uint32_t(out.corners.size() / 3) - first;
        if (count > 0) {
            out.parts.push_back({first, count, material_of_run[run]});
        }
    }
    mergeParts(out.parts);
    return out;
}

/// Unit normals, corner by corner of the triangles.
std::vector<Vector3f> cornerNormals(const ObjFile& file, const CutFaces& cut) {
    std::vector<Vector3f> unit;
    unit.reserve(file.normals.size());
    for (const Vector3f& n : file.normals) {
        unit.push_back(normalised(n));
    }
    std::vector<Vector3f> normals;
    normals.reserve(cut.corners.size());
    bool complete = true;
    for (const uint32_t c : cut.corners) {
        const int32_t n = file.corners[c].normal;
        normals.push_back(n == kNoIndex ? Vector3f{} : unit[size_t(n)]);
        complete &= normals.back() != Vector3f{};
    }
    if (!complete) {
        std::vector<uint32_t> positions;
        positions.reserve(cut.corners.size());
        for (const uint32_t c : cut.corners) {
            positions.push_back(uint32_t(file.corners[c].position));
        }
        generateNormals(file.positions, positions, normals);
    }
    return normals;
}

/// Brings texture coordinates into ±2^15, where floats still resolve 1/256 of a tile: first by
/// whole tiles, the same for all (which repeating textures do not show), then by clamping.
void tameTexcoords(std::vector<std::array<float, 2>>& texcoords, bool repeat_only) {
    constexpr double kLimit = 32768.0;
    for (size_t axis = 0; axis < 2 && !texcoords.empty(); ++axis) {
        const auto [low, high] =
            std::minmax_element(texcoords.begin(), texcoords.end(),
                                [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
        const double min = (*low)[axis], max = (*high)[axis];
        if (min >= -kLimit && max <= kLimit) {
            continue;
        }
        const double shift = repeat_only ? std::floor(min + (max - min) * 0.5) : 0.0;
        for (std::array<float, 2>& t : texcoords) {
            t[axis] = float(std::clamp(double(t[axis]) - shift, -kLimit, kLimit));
        }
    }
}

std::array<float, 2> texcoordOf(const ObjFile& file, uint32_t corner) {
    const int32_t t = file.corners[corner].texcoord;
    return t == kNoIndex ? std::array<float, 2>{} : file.texcoords[size_t(t)];
}

/// Fills indices and vertices: corners that agree in position, texture coordinates, normal and (in
/// parts of normal-mapped materials) in handedness become one vertex, in order of first use.
void shareVertices(const ObjFile& file, const CutFaces& cut, const std::vector<Vector3f>& normals,
                   const std::vector<bool>& normal_mapped, Mesh& mesh) {
    UniqueKeys<6> unique(file.positions.size());
    mesh.indices.reserve(cut.corners.size());
    for (const MeshPart& part : cut.parts) {
        const bool mapped = normal_mapped[part.material];
        const uint32_t end = part.first_triangle + part.triangle_count;
        for (uint32_t t = part.first_triangle; t < end; ++t) {
            const uint32_t* corners = cut.corners.data() + size_t(t) * 3;
            const bool mirrored =
                mapped && isMirrored(texcoordOf(file, corners[0]), texcoordOf(file, corners[1]),
                                     texcoordOf(file, corners[2]));
            for (size_t k = 0; k < 3; ++k) {
                const ObjCorner& corner = file.corners[corners[k]];
                const Vector3f& n = normals[size_t(t) * 3 + k];
                const uint32_t vertex =
                    unique.numberOf({uint32_t(corner.position), uint32_t(corner.texcoord),
                                     std::bit_cast<uint32_t>(n[0]), std::bit_cast<uint32_t>(n[1]),
                                     std::bit_cast<uint32_t>(n[2]), uint32_t(mirrored)});
                mesh.indices.push_back(vertex);
                if (vertex == mesh.vertexCount()) {
                    const Vector3f& p = file.positions[size_t(corner.position)];
                    const std::array<float, 2> uv = texcoordOf(file, corners[k]);
                    mesh.x.push_back(p[0]);
                    mesh.y.push_back(p[1]);
                    mesh.z.push_back(p[2]);
                    mesh.attributes.push_back({n[0], n[1], n[2], uv[0], uv[1]});
                }
            }
        }
    }
}

/// Splits at blanks that are not behind a backslash.
std::vector<std::string> escapedWords(const std::string& text) {
    std::vector<std::string> words{""};
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ' ') {
            words.back() += text[++i];
        } else if (text[i] != ' ' && text[i] != '\t') {
            words.back() += text[i];
        } else if (!words.back().empty()) {
            words.emplace_back();
        }
    }
    return words;
}

/// Files of one mtllib statement: one name, which may have blanks in it, or several names.
/// `outside` becomes true when one of them must not be read.
std::vector<std::filesystem::path> libraryFiles(const std::filesystem::path& folder,
                                                const std::string& statement, InputLog& log,
                                                bool& outside) {
    const auto withSlashes = [](std::string name) {
        std::replace(name.begin(), name.end(), '\\', '/');
        return name;
    };
    const auto isFile = [&](const std::string& name) {
        const bool permitted = log.access().permits(folder, name);
        outside |= !permitted;
        return permitted && log.isFile(folder / name);
    };
    const std::string whole = withSlashes(statement);
    if (isFile(whole)) {
        return {folder / whole};
    }
    std::vector<std::filesystem::path> files;
    for (const std::string& word : escapedWords(statement)) {
        if (const std::string name = withSlashes(word); isFile(name)) {
            files.push_back(folder / name);
        }
    }
    return files;
}

using MaterialLibrary = std::map<std::string, MtlSource, std::less<>>;

MaterialLibrary readLibraries(const std::filesystem::path& obj, const ObjFile& file, InputLog& log,
                              std::vector<std::string>& warnings) {
    MaterialLibrary library;
    for (const std::string& statement : file.libraries) {
        bool outside = false;
        const auto files = libraryFiles(obj.parent_path(), statement, log, outside);
        if (files.empty() || outside) {
            warnings.push_back(shownPath(obj) + ": material library " + shownText(statement) +
                               (outside ? ": lies outside of the scene's folder and is not read; " +
                                              std::string(FileAccess::kAdvice)
                                        : ": no such file"));
        }
        for (const std::filesystem::path& path : files) {
            Result<std::string> text = log.read(path);
            if (!text) {
                warnings.push_back(text.error().message);
                continue;
            }
            for (MtlMaterial& m : parseMtl(std::move(*text), shownPath(path), warnings)) {
                const std::string name = m.name;
                library.try_emplace(name, MtlSource{std::move(m), path});
            }
        }
    }
    return library;
}

/// The material of that name, or that of the name's first word (a comment may follow it).
MtlSource findMaterial(const MaterialLibrary& library, const std::string& name) {
    std::string_view rest = name;
    for (const std::string_view key : {std::string_view(name), takeWord(rest)}) {
        const auto entry = library.find(key);
        if (entry != library.end()) {
            return entry->second;
        }
    }
    return {};
}

/// Materials in order of first use by a face; fills `material_of_run`.
std::vector<MtlSource> usedMaterials(const std::string& name, const ObjFile& file,
                                     const MaterialLibrary& library,
                                     std::vector<uint32_t>& material_of_run,
                                     std::vector<std::string>& warnings) {
    std::vector<MtlSource> used;
    std::map<int32_t, uint32_t> numbers;
    for (const ObjRun& run : file.runs) {
        const auto [entry, added] = numbers.try_emplace(run.material, uint32_t(used.size()));
        material_of_run.push_back(entry->second);
        if (!added) {
            continue;
        }
        used.emplace_back();
        if (run.material != kNoIndex) {
            const std::string& wanted = file.materials[size_t(run.material)];
            used.back() = findMaterial(library, wanted);
            if (used.back().library.empty()) {
                warnings.push_back(name + ": material \"" + shownText(wanted) +
                                   "\" is not defined, it is drawn grey");
            }
        }
    }
    return used;
}

bool anyClamped(const std::vector<MtlSource>& sources) {
    return std::any_of(sources.begin(), sources.end(), [](const MtlSource& source) {
        const MtlMaterial& m = source.material;
        return m.map_kd.clamp || m.map_d.clamp || m.bump.clamp || m.norm.clamp;
    });
}

/// Everything of the mesh but the parts. `normal_mapped` goes by material.
Mesh buildMesh(const ObjFile& file, const CutFaces& cut, const std::vector<bool>& normal_mapped) {
    Mesh mesh;
    shareVertices(file, cut, cornerNormals(file, cut), normal_mapped, mesh);
    if (std::find(normal_mapped.begin(), normal_mapped.end(), true) != normal_mapped.end()) {
        mesh.tangents = generateTangents(mesh);
    }
    return mesh;
}

Result<ObjModel> buildModel(const std::filesystem::path& path, ObjFile file, InputLog& log) {
    ObjModel model;
    model.warnings = std::move(file.warnings);
    const MaterialLibrary library = readLibraries(path, file, log, model.warnings);
    std::vector<uint32_t> material_of_run;
    const std::vector<MtlSource> sources =
        usedMaterials(shownPath(path), file, library, material_of_run, model.warnings);
    for (const MtlSource& source : sources) {
        model.material_names.push_back(source.material.name);
    }
    CutFaces cut = cutFaces(file, material_of_run);
    if (cut.corners.empty()) {
        return fail(shownPath(path) + ": no triangles, expected at least one face");
    }
    tameTexcoords(file.texcoords, !anyClamped(sources));
    std::vector<bool> expected;
    MaterialSet set = buildMaterials(sources, log, [&](const std::vector<bool>& normal_mapped) {
        expected = normal_mapped;
        model.mesh = buildMesh(file, cut, expected);
    });
    if (set.memory_error) {
        return tl::make_unexpected(*set.memory_error);
    }
    std::vector<bool> normal_mapped;
    for (const Material& material : set.materials) {
        normal_mapped.push_back(material.normal_texture != kNoTexture);
    }
    if (normal_mapped != expected) {  // an image was broken
        model.mesh = buildMesh(file, cut, normal_mapped);
    }
    model.mesh.parts = std::move(cut.parts);
    model.materials = std::move(set.materials);
    model.textures = std::move(set.textures);
    model.alpha_textures = std::move(set.alpha_textures);
    model.warnings.insert(model.warnings.end(), set.warnings.begin(), set.warnings.end());
    return model;
}

/// Text and what is parsed of it are in memory together.
Result<void> checkText(const std::filesystem::path& path, size_t text_bytes, uint64_t max_bytes) {
    constexpr uint64_t kTimes = 4;  // what ObjSource reserves, and the text itself
    return checkMemory(shownPath(path), kTimes * text_bytes, max_bytes);
}

/// From `text`, which stands at `path` or is read from there.
Result<ObjModel> readModel(const std::filesystem::path& path, InputLog& log,
                           std::optional<std::string> text = {}) {
    try {
        Result<std::string> whole = text ? Result<std::string>(std::move(*text)) : log.read(path);
        if (!whole) {
            return tl::make_unexpected(whole.error());
        }
        if (const auto fits = checkText(path, whole->size(), log.maxMemoryBytes()); !fits) {
            return tl::make_unexpected(fits.error());
        }
        Result<ObjFile> file = parseObj(std::move(*whole), shownPath(path));
        if (!file) {
            return tl::make_unexpected(file.error());
        }
        return buildModel(path, std::move(*file), log);
    } catch (const std::exception&) {
        // The standard library's; nothing of ours throws.
        return fail(shownPath(path) + ": not enough memory to load it");
    }
}

void shift(int32_t& texture, size_t by) {
    texture = texture == kNoTexture ? kNoTexture : texture + int32_t(by);
}

template <class T>
void moveBehind(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

Result<ObjModel> loadObj(const std::filesystem::path& path, const LoadOptions& options) {
    InputLog log(options, path);
    const auto withFiles = [&log](ObjModel model) {
        for (InputLog::Entry& entry : log.entries()) {
            model.files.push_back(std::move(entry.file));
        }
        return model;
    };
    if (options.cache_folder.empty()) {
        return readModel(path, log).map(withFiles);
    }
    const ModelCache cache(options.cache_folder, path, log.access());
    if (std::optional<ObjModel> model = cache.load()) {
        return std::move(*model);
    }
    Result<ObjModel> model = readModel(path, log);
    if (model) {
        cache.store(*model, log);
    }
    return std::move(model).map(withFiles);
}

Result<ObjModel> parseObjModel(std::string text, const std::filesystem::path& name,
                               const LoadOptions& options) {
    InputLog log(options, name);
    return readModel(name, log, std::move(text));
}

uint32_t appendModel(Scene& scene, ObjModel&& model, std::string name) {
    for (Material& m : model.materials) {
        shift(m.colour_texture, scene.textures.size());
        shift(m.normal_texture, scene.textures.size());
        shift(m.alpha_texture, scene.alpha_textures.size());
        shift(m.height_texture, scene.alpha_textures.size());
    }
    for (MeshPart& part : model.mesh.parts) {
        part.material += uint32_t(scene.materials.size());
    }
    moveBehind(scene.materials, model.materials);
    moveBehind(scene.textures, model.textures);
    moveBehind(scene.alpha_textures, model.alpha_textures);
    moveBehind(scene.warnings, model.warnings);
    moveBehind(scene.files, model.files);
    scene.meshes.push_back(std::move(model.mesh));
    scene.mesh_names.push_back(std::move(name));
    return uint32_t(scene.meshes.size() - 1);
}

}  // namespace still
