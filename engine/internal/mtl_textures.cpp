#include "engine/internal/mtl_textures.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include "engine/internal/image_load.h"
#include "engine/internal/obj_text.h"
#include "engine/texture.h"
#include "rasterizer/workers.h"

namespace still {

namespace {

enum class Use { colour, normal, bump, own_alpha, mask };

/// One texture to build from an image. Equal requests are made once.
struct Request {
    Use use = Use::colour;
    Wrap wrap = Wrap::repeat;
    bool preserve_coverage = false;  ///< own_alpha, mask
    float bump_scale = 1.0f;         ///< bump
    friend auto operator<=>(const Request&, const Request&) = default;
};

constexpr int32_t kNoRequest = -1;

/// A texture under way: at most one of the two comes out of it.
struct Build {
    size_t image;
    Request request;
    std::optional<Texture> texture{};
    std::optional<AlphaTexture> alpha{};
    int32_t number = kNoTexture;  ///< in MaterialSet::textures or alpha_textures
};

struct ImageFile {
    std::filesystem::path path;
    std::vector<size_t> builds{};
    std::optional<Error> error{};
    bool memory_error = false;  ///< `error` is about memory
};

template <class Test>
bool allPixels(ImageView<const Rgba8> image, const Test& test) {
    for (int y = 0; y < image.height; ++y) {
        const Rgba8* row = image.row(y);
        if (!std::all_of(row, row + image.width, test)) {
            return false;
        }
    }
    return true;
}

bool isOpaque(ImageView<const Rgba8> image) {
    return allPixels(image, [](const Rgba8& p) { return p.a == 255; });
}

bool isGrey(ImageView<const Rgba8> image) {
    return allPixels(image, [](const Rgba8& p) {
        return std::abs(int(p.r) - int(p.g)) <= 2 && std::abs(int(p.r) - int(p.b)) <= 2;
    });
}

/// A copy whose alpha is the luminance.
Image<Rgba8> luminanceAsAlpha(ImageView<const Rgba8> image) {
    Image<Rgba8> out(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        const Rgba8* row = image.row(y);
        std::transform(row, row + image.width, out.view().row(y), [](const Rgba8& p) {
            return Rgba8{p.r, p.g, p.b, luminance(p)};
        });
    }
    return out;
}

void buildAlpha(Build& build, ImageView<const Rgba8> image) {
    if (!isOpaque(image)) {
        build.alpha = makeAlphaTexture(image, build.request.wrap, build.request.preserve_coverage);
    }
}

void buildTexture(Build& build, ImageView<const Rgba8> image) {
    const Request& request = build.request;
    switch (request.use) {
        case Use::colour:
            build.texture = makeColourTexture(image, request.wrap);
            break;
        case Use::normal:
            build.texture = makeNormalTexture(image, request.wrap);
            break;
        case Use::bump:
            build.texture =
                isGrey(image) ? makeNormalTextureFromHeight(image, request.wrap, request.bump_scale)
                              : makeNormalTexture(image, request.wrap);
            break;
        case Use::own_alpha:
            buildAlpha(build, image);
            break;
        case Use::mask:
            if (isOpaque(image)) {
                buildAlpha(build, luminanceAsAlpha(image).view());
            } else {
                buildAlpha(build, image);
            }
            break;
    }
}

/// Decodes one image and makes all that is wanted of it. Runs on a worker, so it must not throw.
void processImage(ImageFile& file, std::vector<Build>& builds, InputLog& log) noexcept {
    try {
        const std::string name = shownPath(file.path);
        const Result<std::string> text = log.read(file.path);
        if (!text) {
            file.error = text.error();
            return;
        }
        const std::span bytes{reinterpret_cast<const uint8_t*>(text->data()), text->size()};
        if (const auto fits = checkImageMemory(bytes, name, log.maxMemoryBytes()); !fits) {
            file.error = fits.error();
            file.memory_error = true;
            return;
        }
        const Result<Image<Rgba8>> image = decodeImage(bytes, name);
        if (!image) {
            file.error = image.error();
            return;
        }
        for (const size_t build : file.builds) {
            buildTexture(builds[build], image->view());
        }
    } catch (const std::exception&) {
        file.error = Error{shownPath(file.path) + ": not enough memory for this image"};
        file.memory_error = true;
    }
}

/// What each material asked for, as indices into the builds.
struct MaterialRequests {
    int32_t colour = kNoRequest, normal = kNoRequest, alpha = kNoRequest;
};

class Planner {
  public:
    explicit Planner(InputLog& log) : log_(log) {}

    std::vector<ImageFile> images;
    std::vector<Build> builds;
    std::vector<std::string> warnings;

    MaterialRequests plan(const MtlSource& source) {
        const MtlMaterial& m = source.material;
        const bool preserve = m.opacity >= 1.0f;
        MaterialRequests wanted;
        wanted.colour = request(source, m.map_kd, {Use::colour});
        wanted.normal = request(source, m.norm, {Use::normal});
        if (wanted.normal == kNoRequest) {
            wanted.normal = request(source, m.bump, {Use::bump, {}, false, m.bump.bump_scale});
        }
        wanted.alpha = request(source, m.map_d, {Use::mask, {}, preserve});
        if (wanted.alpha == kNoRequest) {
            wanted.alpha = request(source, m.map_kd, {Use::own_alpha, {}, preserve});
        }
        return wanted;
    }

  private:
    int32_t request(const MtlSource& source, const MtlImage& image, Request request);
    std::optional<std::filesystem::path> find(const MtlSource& source, const MtlImage& image);
    void warnOnce(const std::string& text) {
        if (warned_.insert(text).second) {
            warnings.push_back(text);
        }
    }

    InputLog& log_;
    std::map<std::filesystem::path, size_t> image_numbers_;
    std::map<std::pair<size_t, Request>, int32_t> build_numbers_;
    std::set<std::string> warned_;
};

int32_t Planner::request(const MtlSource& source, const MtlImage& image, Request request) {
    const std::optional<std::filesystem::path> path = find(source, image);
    if (!path) {
        return kNoRequest;
    }
    if (image.moved) {
        warnOnce(shownPath(source.library) + ": material \"" + shownText(source.material.name) +
                 "\": image options -s, -o and -t are ignored");
    }
    request.wrap = image.clamp ? Wrap::clamp : Wrap::repeat;
    const auto [file, new_file] = image_numbers_.try_emplace(*path, images.size());
    if (new_file) {
        images.push_back({*path});
    }
    const auto [entry, new_build] =
        build_numbers_.try_emplace({file->second, request}, int32_t(builds.size()));
    if (new_build) {
        images[file->second].builds.push_back(builds.size());
        builds.push_back({file->second, request});
    }
    return entry->second;
}

/// The file an image statement means, with a warning when there is none. Tried in turn: the name
/// beside the library; without options that were written behind it; its last part beside the
/// library (absolute paths of another machine).
std::optional<std::filesystem::path> Planner::find(const MtlSource& source, const MtlImage& image) {
    std::string name = image.file;
    if (name.empty()) {
        return std::nullopt;
    }
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.size() > 2 && name.front() == '"' && name.back() == '"') {
        name = name.substr(1, name.size() - 2);
    }
    const std::filesystem::path folder = source.library.parent_path();
    const std::string bare(trimmed(std::string_view(name).substr(0, name.find(" -"))));
    const std::string last = std::filesystem::path(bare).filename().string();
    bool outside = false;
    for (const std::string& candidate : {name, bare, last}) {
        const bool permitted = log_.access().permits(folder, candidate);
        outside |= !permitted;
        if (permitted && log_.isFile(folder / candidate)) {
            return (folder / candidate).lexically_normal();
        }
    }
    warnOnce(shownPath(source.library) + ": image " + shownText(name) +
             (outside ? ": lies outside of the scene's folder, the material does without; " +
                            std::string(FileAccess::kAdvice)
                      : ": no such file, the material does without"));
    return std::nullopt;
}

Material materialOf(const MtlMaterial& m, const MaterialRequests& wanted,
                    const std::vector<Build>& builds) {
    const auto numberOf = [&](int32_t request) {
        return request == kNoRequest ? kNoTexture : builds[size_t(request)].number;
    };
    Material out;
    out.diffuse = m.diffuse;
    out.specular = m.specular;
    out.emission = m.emission;
    out.shininess = m.shininess;
    out.opacity = m.opacity;
    out.colour_texture = numberOf(wanted.colour);
    out.normal_texture = numberOf(wanted.normal);
    out.alpha_texture = numberOf(wanted.alpha);
    if (m.opacity < 1.0f) {
        out.alpha_mode = AlphaMode::stochastic;
    } else if (out.alpha_texture != kNoTexture) {
        out.alpha_mode = AlphaMode::test;
    }
    return out;
}

/// Moves what was built into the set, in order of the requests.
void collect(std::vector<Build>& builds, MaterialSet& set) {
    for (Build& build : builds) {
        if (build.texture) {
            build.number = int32_t(set.textures.size());
            set.textures.push_back(std::move(*build.texture));
        } else if (build.alpha) {
            build.number = int32_t(set.alpha_textures.size());
            set.alpha_textures.push_back(std::move(*build.alpha));
        }
    }
}

}  // namespace

MaterialSet buildMaterials(std::span<const MtlSource> sources, InputLog& log,
                           const std::function<void(const std::vector<bool>&)>& meanwhile) {
    Planner planner(log);
    std::vector<MaterialRequests> wanted;
    std::vector<bool> normal_mapped;
    for (const MtlSource& source : sources) {
        wanted.push_back(planner.plan(source));
        normal_mapped.push_back(wanted.back().normal != kNoRequest);
    }
    constexpr int kMaxThreads = 8;  // each holds a decoded image
    const int tasks = int(planner.images.size()) + 1;
    Workers workers(
        std::clamp(int(std::thread::hardware_concurrency()), 1, std::min(tasks, kMaxThreads)));
    std::exception_ptr thrown;
    workers.parallelFor(tasks, 1, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            if (i > 0) {
                processImage(planner.images[size_t(i - 1)], planner.builds, log);
                continue;
            }
            try {
                meanwhile ? meanwhile(normal_mapped) : void();
            } catch (...) {
                thrown = std::current_exception();
            }
        }
    });
    if (thrown) {
        std::rethrow_exception(thrown);
    }
    MaterialSet set;
    set.warnings = std::move(planner.warnings);
    for (const ImageFile& image : planner.images) {
        if (image.error) {
            set.warnings.push_back(image.error->message);
        }
        if (image.memory_error && !set.memory_error) {
            set.memory_error = image.error;
        }
    }
    collect(planner.builds, set);
    for (size_t i = 0; i < sources.size(); ++i) {
        set.materials.push_back(materialOf(sources[i].material, wanted[i], planner.builds));
    }
    return set;
}

}  // namespace still
