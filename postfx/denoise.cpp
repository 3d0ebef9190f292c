// One frame: how light changed, block by block → every tile: what its pixels show, past and present
// blended, how uncertain that is → passes of the filter.

#include "postfx/denoise.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>
#include <vector>

#include "postfx/internal/denoise_kernels.h"
#include "postfx/internal/denoise_rules.h"

namespace still {
namespace {

using denoising::BlockChange;
using denoising::FilterPlanes;
using denoising::Job;
using denoising::kChannels;
using denoising::kParts;
using denoising::Other;
using denoising::Past;
using denoising::TileRect;

template <class T, size_t kCount>
void resizeAll(std::array<Image<T>, kCount>& images, int width, int height) {
    for (Image<T>& image : images) {
        image.resize(width, height);
    }
}

template <class T, size_t kCount>
void pointTo(T* (&pointers)[kCount], std::array<Image<T>, kCount>& images) {
    for (size_t i = 0; i < kCount; ++i) {
        pointers[i] = images[i].view().data;
    }
}

struct PastImages {
    std::array<Image<float>, kChannels> light;
    std::array<Image<float>, kParts> square;
    std::array<Image<uint8_t>, kParts> count, age;
    Image<uint8_t> still;
    std::array<Image<float>, 3> normal;
    Image<uint16_t> surface, depth;

    void resize(int width, int height) {
        resizeAll(light, width, height);
        resizeAll(square, width, height);
        resizeAll(count, width, height);
        resizeAll(age, width, height);
        resizeAll(normal, width, height);
        still.resize(width, height);
        surface.resize(width, height);
        depth.resize(width, height);
    }
    Past pointers() {
        Past past;
        pointTo(past.light, light);
        pointTo(past.square, square);
        pointTo(past.count, count);
        pointTo(past.age, age);
        pointTo(past.normal, normal);
        past.still = still.view().data;
        past.surface = surface.view().data;
        past.depth = depth.view().data;
        return past;
    }
};

struct OtherImages {
    std::array<Image<float>, kChannels> light;
    std::array<Image<float>, kParts> square;
    std::array<Image<uint8_t>, kParts> count;
    Image<uint16_t> surface;
    Image<uint32_t> stored;

    void resize(int width, int height) {
        resizeAll(light, width, height);
        resizeAll(square, width, height);
        resizeAll(count, width, height);
        surface.resize(width, height);
        stored.resize(width, height);
    }
    Other pointers() {
        Other other;
        pointTo(other.light, light);
        pointTo(other.square, square);
        pointTo(other.count, count);
        other.surface = surface.view().data;
        other.stored = stored.view().data;
        return other;
    }
};

struct FilterImages {
    std::array<Image<uint16_t>, kChannels> light;
    std::array<Image<float>, kParts> variance;

    void resize(int width, int height) {
        resizeAll(light, width, height);
        resizeAll(variance, width, height);
    }
    FilterPlanes pointers() {
        FilterPlanes planes;
        pointTo(planes.light, light);
        pointTo(planes.variance, variance);
        return planes;
    }
};

/// Blocks on each side whose samples tell how light changed in one.
constexpr int kChangeReach = 2;
/// What few samples say of a change is less than there is.
constexpr float kUnsureGain = 4.0f;

/// From the samples of a block and its neighbours. Where all of them changed by the same factor,
/// that is what happened to the light; the rest is uncertain.
BlockChange changeOf(ImageView<const uint16_t> before, ImageView<const uint16_t> now, int x,
                     int y) {
    const int x0 = std::max(x - kChangeReach, 0), x1 = std::min(x + kChangeReach, now.width - 1);
    const int y0 = std::max(y - kChangeReach, 0), y1 = std::min(y + kChangeReach, now.height - 1);
    uint32_t sum_before = 0, sum_now = 0, sum_most = 0;
    bool same = true;
    for (int j = y0; j <= y1; ++j) {
        for (int i = x0; i <= x1; ++i) {
            const uint16_t a = before.row(j)[i], b = now.row(j)[i];
            same &= a == b;
            sum_before += a;
            sum_now += b;
            sum_most += std::max(a, b);
        }
    }
    if (same) {
        return {};
    }
    const float ratio = sum_before == 0 ? 1.0f : float(sum_now) / float(sum_before);
    float off = 0;
    for (int j = y0; j <= y1; ++j) {
        for (int i = x0; i <= x1; ++i) {
            off += std::abs(float(now.row(j)[i]) - ratio * float(before.row(j)[i]));
        }
    }
    // What is gone may have had another hue than what stays.
    const float unsure = std::max(kUnsureGain * off / float(sum_most), std::abs(ratio - 1.0f));
    return {ratio, std::min(1.0f, unsure)};
}

/// The parts of a tile's light that are to be filtered, a bit for each.
int noisyParts(const FilterPlanes& planes, ptrdiff_t stride, const TileRect& tile) {
    int parts = 0;
    for (int p = 0; p < kParts; ++p) {
        bool all_quiet = true;
        for (int y = tile.y0; y < tile.y1 && all_quiet; ++y) {
            const ptrdiff_t at = y * stride + tile.x0;
            const uint16_t* red = planes.light[3 * p] + at;
            const uint16_t* green = planes.light[3 * p + 1] + at;
            const uint16_t* blue = planes.light[3 * p + 2] + at;
            const float* variance = planes.variance[p] + at;
            for (int x = 0; x < tile.x1 - tile.x0; ++x) {
                all_quiet &= denoising::quiet(
                    variance[x],
                    denoising::luminance(float(red[x]), float(green[x]), float(blue[x])));
            }
        }
        parts |= all_quiet ? 0 : 1 << p;
    }
    return parts;
}

/// The parts of a tile's light of which some pixel has few samples.
int freshParts(const Job& job, const TileRect& tile) {
    int parts = 0;
    for (int p = 0; p < kParts; ++p) {
        bool fresh = false;
        for (int y = tile.y0; y < tile.y1; ++y) {
            const ptrdiff_t at = y * job.stride + tile.x0;
            for (int x = 0; x < tile.x1 - tile.x0; ++x) {
                const int count = job.now.count[p][at + x];
                fresh |= count > 0 && count < denoising::kFewSamples;
            }
        }
        parts |= fresh ? 1 << p : 0;
    }
    return parts;
}

/// The parts that are not filtered, as they are.
void copyParts(const FilterPlanes& in, const FilterPlanes& out, int parts, ptrdiff_t stride,
               const TileRect& tile) {
    const int width = tile.x1 - tile.x0;
    for (int p = 0; p < kParts; ++p) {
        for (int y = tile.y0; y < tile.y1 && !denoising::filters(parts, p); ++y) {
            const ptrdiff_t at = y * stride + tile.x0;
            std::copy_n(in.variance[p] + at, width, out.variance[p] + at);
            for (int c = 3 * p; c < 3 * p + 3; ++c) {
                std::copy_n(in.light[c] + at, width, out.light[c] + at);
            }
        }
    }
}

/// Of the nearest sample around each pixel, which owns it in the resolve: what lies behind may be
/// lit anew without an edge losing its anti-aliasing. What reflects nothing is long lit as it is.
void agesOfOwners(const GBuffer& gbuffer, ImageView<const uint8_t> age, ImageView<uint8_t> out,
                  const TileRect& tile) {
    const bool has_albedo = gbuffer.planes.albedo;
    // Larger is nearer; of equally near ones that which is lit anew.
    const auto keyAt = [&](int x, int y) {
        const bool dark =
            has_albedo && (gbuffer.albedo_red.at(x, y) | gbuffer.albedo_green.at(x, y) |
                           gbuffer.albedo_blue.at(x, y)) == 0;
        const int own = dark ? 255 : age.row(y)[x];
        return uint64_t{gbuffer.depth.at(x, y)} << 8 | uint64_t(255 - own);
    };
    uint64_t columns[kTileSize + 2];
    const int x0 = std::max(tile.x0 - 1, 0), x1 = std::min(tile.x1 + 1, age.width);
    for (int y = tile.y0; y < tile.y1; ++y) {
        const int above = std::max(y - 1, 0), below = std::min(y + 1, age.height - 1);
        for (int x = x0; x < x1; ++x) {
            columns[x - x0] = std::max(std::max(keyAt(x, above), keyAt(x, y)), keyAt(x, below));
        }
        for (int x = tile.x0; x < tile.x1; ++x) {
            const int left = std::max(x - 1, x0) - x0, right = std::min(x + 1, x1 - 1) - x0;
            const uint64_t nearest =
                std::max(std::max(columns[left], columns[x - x0]), columns[right]);
            out.row(y)[x] = uint8_t(255 - (nearest & 255));
        }
    }
}

/// Whether light has not been as it is for long somewhere in the tile.
bool isYoung(ImageView<const uint8_t> age, const TileRect& tile) {
    uint8_t least = 255;
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            least = std::min(least, age.row(y)[x]);
        }
    }
    return least < 255;
}

}  // namespace

struct Denoiser::State {
    int width = 0, height = 0;
    int tiles_x = 0, tiles = 0;
    std::array<PastImages, 2> past;
    OtherImages other;
    uint32_t frame = 0;
    int cursor = 0;
    bool has_past = false;
    std::array<FilterImages, 2> filtered;
    std::array<Image<float>, 2> step;
    std::array<std::vector<BlockChange>, kParts> change;
    std::vector<int> noisy_parts, fresh_parts;  ///< of each tile
    Image<uint8_t> light_age, owner_age;        ///< of each pixel; of what owns it
    std::vector<uint8_t> young;                 ///< tiles with pixels of some age
    bool any_young = false;

    TileRect rectOf(int tile) const {
        const int x0 = tile % tiles_x * kTileSize, y0 = tile / tiles_x * kTileSize;
        return {x0, y0, std::min(x0 + kTileSize, width), std::min(y0 + kTileSize, height)};
    }
    template <class Kernel>
    void eachTile(Workers& workers, Kernel&& kernel) {
        workers.parallelFor(tiles, 1, [&](int begin, int end, int) {
            for (int tile = begin; tile < end; ++tile) {
                kernel(tile, rectOf(tile));
            }
        });
    }
    void resize(int new_width, int new_height);
    void noteChange(const LightChange& seen, Workers& workers);
    Job makeJob(const GBuffer& gbuffer, const LightPlanes& noisy, bool changed);
    void filter(const Job& job, const denoising::Kernels& kernels, Workers& workers);
};

void Denoiser::State::resize(int new_width, int new_height) {
    if (width == new_width && height == new_height) {
        return;
    }
    width = new_width;
    height = new_height;
    tiles_x = (width + kTileSize - 1) / kTileSize;
    tiles = tiles_x * ((height + kTileSize - 1) / kTileSize);
    for (PastImages& images : past) {
        images.resize(width, height);
    }
    other.resize(width, height);
    for (FilterImages& images : filtered) {
        images.resize(width, height);
    }
    for (Image<float>& image : step) {
        image.resize(width, height);
    }
    light_age.resize(width, height);
    owner_age.resize(width, height);
    noisy_parts.resize(size_t(tiles));
    fresh_parts.resize(size_t(tiles));
    young.resize(size_t(tiles));
    has_past = false;
}

void Denoiser::State::noteChange(const LightChange& seen, Workers& workers) {
    const std::array<ImageView<const uint16_t>, kParts> before{seen.direct_before,
                                                               seen.indirect_before};
    const std::array<ImageView<const uint16_t>, kParts> now{seen.direct_now, seen.indirect_now};
    for (size_t p = 0; p < kParts; ++p) {
        const int blocks_x = now[p].width, blocks_y = now[p].height;
        change[p].resize(size_t(blocks_x) * size_t(blocks_y));
        workers.parallelFor(blocks_y, 8, [&](int begin, int end, int) {
            for (int y = begin; y < end; ++y) {
                for (int x = 0; x < blocks_x; ++x) {
                    change[p][size_t(y * blocks_x + x)] = changeOf(before[p], now[p], x, y);
                }
            }
        });
    }
}

Job Denoiser::State::makeJob(const GBuffer& gbuffer, const LightPlanes& noisy, bool changed) {
    Job job;
    job.width = width;
    job.height = height;
    job.stride = gbuffer.id.view().stride;
    job.id = gbuffer.id.view().data;
    job.depth = gbuffer.depth.view().data;
    job.normal = gbuffer.normal.view().data;
    job.motion = gbuffer.motion.view().data;
    job.depth_before = gbuffer.depth_before.view().data;
    const ColourPlanes* parts[kParts] = {&noisy.direct, &noisy.indirect};
    for (int p = 0; p < kParts; ++p) {
        job.noisy[3 * p] = parts[p]->red.data;
        job.noisy[3 * p + 1] = parts[p]->green.data;
        job.noisy[3 * p + 2] = parts[p]->blue.data;
        job.change[p] = changed ? change[size_t(p)].data() : nullptr;
    }
    job.blocks_x = (width + kLightBlock - 1) / kLightBlock;
    job.step[0] = step[0].view().data;
    job.step[1] = step[1].view().data;
    job.has_past = has_past;
    job.frame = frame;
    job.other = other.pointers();
    job.before = past[size_t(1 - cursor)].pointers();
    job.now = past[size_t(cursor)].pointers();
    job.first = filtered[0].pointers();
    job.light_age = light_age.view().data;
    return job;
}

/// A tile without noise is copied once: then it is the same in both sets of planes.
void Denoiser::State::filter(const Job& job, const denoising::Kernels& kernels, Workers& workers) {
    for (int pass = 0; pass < denoising::kPasses; ++pass) {
        const FilterPlanes in = filtered[size_t(pass % 2)].pointers();
        const FilterPlanes out = filtered[size_t(1 - pass % 2)].pointers();
        eachTile(workers, [&](int tile, const TileRect& rect) {
            const bool last = pass + 1 == denoising::kPasses;
            const int noisy = noisy_parts[size_t(tile)];
            const int parts = noisy & (last ? fresh_parts[size_t(tile)] : noisy);
            if (pass == 0 || last) {
                copyParts(in, out, pass == 0 ? noisy : parts | ~noisy, job.stride, rect);
            }
            if (parts != 0) {
                kernels.filter(job, in, out, pass, parts, rect);
            }
        });
    }
}

Denoiser::Denoiser() : state_(std::make_unique<State>()) {}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

void Denoiser::run(const GBuffer& gbuffer, const LightPlanes& noisy, const DenoiseFrame& frame,
                   SimdTarget simd, Workers& workers) {
    assert(gbuffer.planes.normal && gbuffer.planes.motion);
    State& s = *state_;
    s.resize(gbuffer.width(), gbuffer.height());
    s.has_past &= !frame.reset;
    const bool changed = s.has_past && !frame.change.direct_now.empty();
    if (changed) {
        s.noteChange(frame.change, workers);
    }
    s.cursor = 1 - s.cursor;
    ++s.frame;
    const Job job = s.makeJob(gbuffer, noisy, changed);
    const denoising::Kernels kernels = denoising::kernels(simd);
    s.eachTile(workers, [&](int, const TileRect& rect) { kernels.guides(job, rect); });
    s.eachTile(workers, [&](int tile, const TileRect& rect) {
        kernels.blend(job, rect);
        s.young[size_t(tile)] = isYoung(s.light_age.view(), rect) ? 1 : 0;
    });
    s.any_young = std::find(s.young.begin(), s.young.end(), 1) != s.young.end();
    s.eachTile(workers, [&](int tile, const TileRect& rect) {
        kernels.variance(job, rect);
        s.noisy_parts[size_t(tile)] = noisyParts(job.first, job.stride, rect);
        s.fresh_parts[size_t(tile)] = freshParts(job, rect);
        if (s.any_young) {
            agesOfOwners(gbuffer, s.light_age.view(), s.owner_age.view(), rect);
        }
    });
    s.filter(job, kernels, workers);
    s.has_past = true;
}

LightPlanes Denoiser::light() const {
    const FilterImages& images = state_->filtered[denoising::kPasses % 2];
    return {{images.light[0].view(), images.light[1].view(), images.light[2].view()},
            {images.light[3].view(), images.light[4].view(), images.light[5].view()}};
}

ImageView<const uint8_t> Denoiser::lightAge() const {
    const State& s = *state_;
    return s.any_young ? s.owner_age.view() : ImageView<const uint8_t>();
}

void remodulate(GBuffer& gbuffer, const LightPlanes& light, Workers& workers) {
    const ColourTargets to{gbuffer.red.view(), gbuffer.green.view(), gbuffer.blue.view()};
    const auto add = [](const uint16_t* albedo, const uint16_t* direct, const uint16_t* indirect,
                        uint16_t* out, int count) {
        for (int x = 0; x < count; ++x) {
            const uint32_t both = std::min<uint32_t>(uint32_t(direct[x]) + indirect[x], 65535);
            const uint32_t added = (albedo[x] * both + kColourOne / 2) >> kColourBits;
            out[x] = uint16_t(std::min<uint32_t>(out[x] + added, 65535));
        }
    };
    workers.parallelFor(gbuffer.tiles_x * gbuffer.tiles_y, 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) {
            const int x0 = tile % gbuffer.tiles_x * kTileSize;
            const int y0 = tile / gbuffer.tiles_x * kTileSize;
            const int width = std::min(kTileSize, gbuffer.width() - x0);
            for (int y = y0; y < std::min(y0 + kTileSize, gbuffer.height()); ++y) {
                add(gbuffer.albedo_red.view().row(y) + x0, light.direct.red.row(y) + x0,
                    light.indirect.red.row(y) + x0, to.red.row(y) + x0, width);
                add(gbuffer.albedo_green.view().row(y) + x0, light.direct.green.row(y) + x0,
                    light.indirect.green.row(y) + x0, to.green.row(y) + x0, width);
                add(gbuffer.albedo_blue.view().row(y) + x0, light.direct.blue.row(y) + x0,
                    light.indirect.blue.row(y) + x0, to.blue.row(y) + x0, width);
            }
        }
    });
}

}  // namespace still
