// The denoiser's kernels against their scalar twins, threads, and what it promises of light.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "denoise_light.h"
#include "postfx/denoise.h"
#include "random_frames.h"

namespace {

using namespace still;
using denoise_light::Light;
using random_frames::Film;
using random_frames::Random;

/// Mostly some light or none, sometimes far too much.
void makeNoise(Random& random, Light& light) {
    for (Image<uint16_t>* plane : light.all()) {
        for (int y = 0; y < plane->height(); ++y) {
            for (int x = 0; x < plane->width(); ++x) {
                const int most = random.chance(1) ? 65536 : 4000;
                plane->at(x, y) = uint16_t(random.chance(50) ? 0 : random.below(most));
            }
        }
    }
    const bool calm = random.chance(40);
    for (int p = 0; p < 4; p += 2) {
        Image<uint16_t>&before = *light.allChanges()[size_t(p)],
        &now = *light.allChanges()[size_t(p + 1)];
        for (int y = 0; y < now.height(); ++y) {
            for (int x = 0; x < now.width(); ++x) {
                before.at(x, y) = uint16_t(random.below(4000));
                const bool same = calm || random.chance(80);
                now.at(x, y) = same ? before.at(x, y) : uint16_t(random.below(5000));
            }
        }
    }
}

template <class T>
void append(ImageView<const T> plane, std::vector<uint16_t>& out) {
    for (int y = 0; y < plane.height; ++y) {
        out.insert(out.end(), plane.row(y), plane.row(y) + plane.width);
    }
}

std::vector<uint16_t> look(const Denoiser& denoiser) {
    std::vector<uint16_t> seen;
    for (const ColourPlanes& part : {denoiser.light().direct, denoiser.light().indirect}) {
        append(part.red, seen);
        append(part.green, seen);
        append(part.blue, seen);
    }
    append(denoiser.lightAge(), seen);
    return seen;
}

struct Run {
    SimdTarget simd = SimdTarget::scalar;
    int threads = 1;
    Schedule schedule = Schedule::serial;
};

using Seen = std::vector<std::vector<uint16_t>>;

Seen denoiseFilm(int width, int height, uint64_t seed, int frames, const Run& run) {
    Random random(seed + 500);
    Film film(width, height, true, seed);
    Workers workers(run.threads, run.schedule, seed);
    GBuffer gbuffer;
    Light light;
    light.resize(width, height);
    Denoiser denoiser;
    Seen seen;
    for (int i = 0; i < frames; ++i) {
        const TaaFrame facts = film.next(gbuffer);
        makeNoise(random, light);
        DenoiseFrame frame{.reset = facts.reset};
        if (random.chance(50)) {
            frame.change = light.change();
        }
        denoiser.run(gbuffer, light.planes(), frame, run.simd, workers);
        seen.push_back(look(denoiser));
    }
    return seen;
}

/// "" or where two runs part.
std::string firstDifference(const Seen& got, const Seen& wanted, int width, int height) {
    for (size_t frame = 0; frame < wanted.size(); ++frame) {
        const auto at = std::mismatch(got[frame].begin(), got[frame].end(), wanted[frame].begin());
        if (at.first != got[frame].end()) {
            const int index = int(at.first - got[frame].begin());
            const int pixel = index % (width * height);
            return "frame " + std::to_string(frame) + " plane " +
                   std::to_string(index / (width * height)) + " (" + std::to_string(pixel % width) +
                   ", " + std::to_string(pixel / width) + "): " + std::to_string(*at.first) +
                   ", scalar " + std::to_string(*at.second);
        }
    }
    return "";
}

}  // namespace

TEST_CASE("denoise: every SIMD target equals the scalar twin", "[postfx][unit]") {
    constexpr int kSizes[][2] = {{1, 1}, {3, 130}, {65, 63}, {200, 3}, {130, 70}, {16, 16}};
    for (const auto& [width, height] : kSizes) {
        for (uint64_t seed = 1; seed <= 4; ++seed) {
            const Seen wanted = denoiseFilm(width, height, seed, 8, {});
            for (const SimdTarget target : availableSimdTargets()) {
                INFO(name(target) << " " << width << "x" << height << " seed " << seed);
                CHECK(firstDifference(denoiseFilm(width, height, seed, 8, {.simd = target}), wanted,
                                      width, height) == "");
            }
        }
    }
}

TEST_CASE("denoise: threads and schedules do not change a bit", "[postfx][determinism]") {
    const Seen wanted = denoiseFilm(200, 150, 7, 6, {.simd = bestSimdTarget()});
    for (const int threads : {2, 3, 8}) {
        const Run run{bestSimdTarget(), threads, Schedule::pooled};
        CHECK(firstDifference(denoiseFilm(200, 150, 7, 6, run), wanted, 200, 150) == "");
    }
    const Run shuffled{bestSimdTarget(), 1, Schedule::shuffled};
    CHECK(firstDifference(denoiseFilm(200, 150, 7, 6, shuffled), wanted, 200, 150) == "");
}
