#include "engine/internal/model_format.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "engine/hash.h"
#include "rasterizer/draw_list_check.h"

namespace still {
namespace {

constexpr size_t kPieceBytes = size_t{256} << 10;

template <class T>
constexpr size_t pieceBytes() {
    return kPieceBytes / sizeof(T) * sizeof(T);
}

// What elements may be. Objects and not functions, so that loops are compiled for each.
constexpr auto isCoordinate = [](float value) { return within(value, kMaxPosition); };
constexpr auto isElement = [](const auto& element) { return isSound(element); };
constexpr auto isTexel = [](uint32_t word) { return word >> 30 == 0; };
constexpr auto isAnything = [](auto) { return true; };

/// What writes and reads have in common: which values there are, in which order. The structured
/// bindings stop compiling when a member is added.
template <class Io>
void describe(Io& io, Material& material) {
    auto& [diffuse, specular, emission, shininess, opacity, alpha_mode, colour, normal, alpha,
           height, height_scale, u_offset, v_offset] = material;
    io.values(diffuse, specular, emission, shininess, opacity, alpha_mode, colour, normal, alpha,
              height, height_scale, u_offset, v_offset);
}

template <class Io, class AnyTexture, class Check>
void describe(Io& io, AnyTexture& texture, const Check& check) {
    auto& [wrap, levels, texels] = texture;
    io.values(wrap);
    io.list(levels, [&](TextureLevel& level) {
        auto& [width, height, offset, stride] = level;
        io.values(width, height, offset, stride);
    });
    io.array(texels, check);
}

template <class Io>
void describe(Io& io, Mesh& mesh) {
    auto& [x, y, z, attributes, tangents, indices, parts] = mesh;
    io.array(x, isCoordinate);
    io.array(y, isCoordinate);
    io.array(z, isCoordinate);
    io.array(attributes, isElement);
    io.array(tangents, isElement);
    io.array(indices, isAnything);
    io.list(parts, [&](MeshPart& part) {
        auto& [first_triangle, triangle_count, material] = part;
        io.values(first_triangle, triangle_count, material);
    });
}

template <class Io>
void describe(Io& io, ObjModel& model) {
    // The files are those of ModelOrigin.
    auto& [mesh, materials, names, textures, alpha_textures, warnings, files] = model;
    const auto text = [&](std::string& words) { io.text(words); };
    describe(io, mesh);
    io.list(materials, [&](Material& material) { describe(io, material); });
    io.list(names, text);
    io.list(textures, [&](Texture& texture) { describe(io, texture, isTexel); });
    io.list(alpha_textures, [&](AlphaTexture& texture) { describe(io, texture, isAnything); });
    io.list(warnings, text);
}

template <class Io>
void describe(Io& io, ModelOrigin& origin) {
    auto& [key, inputs] = origin;
    io.text(key);
    io.list(inputs, [&](InputLog::Entry& entry) {
        auto& [file, input] = entry;
        auto& [present, bytes, hash] = input;
        io.text(file);
        io.values(present, bytes, hash);
    });
}

class Writer {
  public:
    FlatModel flat;

    template <class... T>
    void values(const T&... v) {
        (flat.table.append(reinterpret_cast<const char*>(&v), sizeof v), ...);
    }
    void text(const std::string& words) {
        values(uint64_t{words.size()});
        flat.table += words;
    }
    template <class T, class Each>
    void list(std::vector<T>& elements, const Each& each) {
        values(uint64_t{elements.size()});
        std::for_each(elements.begin(), elements.end(), each);
    }
    template <class T, class Check>
    void array(const std::vector<T>& v, const Check&) {
        flat.arrays.push_back(
            {{reinterpret_cast<const char*>(v.data()), v.size() * sizeof(T)}, pieceBytes<T>()});
    }
};

/// Reads an array that `info` describes; false when it is another one.
template <class T, class Check>
bool readArray(std::istream& stream, const ArrayInfo& info, std::vector<T>& out,
               const Check& check) {
    static_assert(std::is_trivially_copyable_v<T>);
    out.reserve(size_t(info.bytes) / sizeof(T));
    std::vector<T> piece(pieceBytes<T>() / sizeof(T));
    uint64_t hash = 0;
    for (uint64_t left = info.bytes; left > 0;) {
        const size_t bytes = size_t(std::min<uint64_t>(left, pieceBytes<T>()));
        const auto end = piece.begin() + ptrdiff_t(bytes / sizeof(T));
        auto* data = reinterpret_cast<char*>(piece.data());
        if (!stream.read(data, std::streamsize(bytes)) || !std::all_of(piece.begin(), end, check)) {
            return false;
        }
        hash = hashBytes({data, bytes}, hash);
        out.insert(out.end(), piece.begin(), end);
        left -= bytes;
    }
    return hash == info.hash;
}

class Reader {
  public:
    Reader(std::string_view table, std::span<const ArrayInfo> arrays)
        : table_(table), arrays_(arrays) {}

    std::vector<ModelFill> fills;

    bool good() const { return good_ && table_.empty() && fills.size() == arrays_.size(); }

    template <class... T>
    void values(T&... v) {
        (take(reinterpret_cast<char*>(&v), sizeof v), ...);
    }
    void text(std::string& words) {
        words.resize(takeCount());
        take(words.data(), words.size());
    }
    template <class T, class Each>
    void list(std::vector<T>& elements, const Each& each) {
        elements.resize(takeCount());
        for (size_t i = 0; good_ && i < elements.size(); ++i) {
            each(elements[i]);
        }
    }
    template <class T, class Check>
    void array(std::vector<T>& v, const Check& check) {
        good_ =
            good_ && fills.size() < arrays_.size() && arrays_[fills.size()].bytes % sizeof(T) == 0;
        if (good_) {
            const ArrayInfo info = arrays_[fills.size()];
            fills.push_back({info, [info, &v, check](std::istream& stream) {
                                 return readArray(stream, info, v, check);
                             }});
        }
    }

  private:
    void take(char* to, size_t count) {
        good_ = good_ && count <= table_.size();
        if (good_ && count > 0) {
            std::memcpy(to, table_.data(), count);
            table_.remove_prefix(count);
        }
    }
    /// A number of things of at least one byte each; 0 when there cannot be so many.
    size_t takeCount() {
        uint64_t count = 0;
        values(count);
        good_ = good_ && count <= table_.size();
        return good_ ? size_t(count) : 0;
    }

    std::string_view table_;
    std::span<const ArrayInfo> arrays_;
    bool good_ = true;
};

}  // namespace

ArrayInfo FlatArray::info() const {
    ArrayInfo info{bytes.size(), 0};
    for (size_t at = 0; at < bytes.size(); at += piece_bytes) {
        info.hash = hashBytes(bytes.substr(at, piece_bytes), info.hash);
    }
    return info;
}

FlatModel flatten(const ModelOrigin& origin, const ObjModel& model) {
    Writer writer;
    describe(writer, const_cast<ModelOrigin&>(origin));  // it only reads
    describe(writer, const_cast<ObjModel&>(model));
    return std::move(writer.flat);
}

std::vector<ModelFill> unflatten(std::string_view table, std::span<const ArrayInfo> arrays,
                                 ModelOrigin& origin, ObjModel& model) {
    Reader reader(table, arrays);
    describe(reader, origin);
    describe(reader, model);
    return reader.good() ? std::move(reader.fills) : std::vector<ModelFill>{};
}

bool isSound(const ObjModel& model) {
    const size_t textures = model.textures.size(), alphas = model.alpha_textures.size();
    const auto sound = [](const auto& texture) { return flawOf(texture) == nullptr; };
    return flawOfIndices(model.mesh, model.materials) == nullptr && !model.mesh.indices.empty() &&
           model.material_names.size() == model.materials.size() &&
           std::all_of(model.materials.begin(), model.materials.end(),
                       [&](const Material& m) { return flawOf(m, textures, alphas) == nullptr; }) &&
           std::all_of(model.textures.begin(), model.textures.end(), sound) &&
           std::all_of(model.alpha_textures.begin(), model.alpha_textures.end(), sound);
}

}  // namespace still
