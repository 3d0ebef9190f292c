// Temporal upscaling: scalar against SIMD, one thread against many, and what must come out.

#include "postfx/upscale.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "random_frames.h"
#include "synthetic.h"
#include "taa_runs.h"

namespace {

using namespace still;
using random_frames::Film;
using random_frames::Random;

struct Run {
    SimdTarget simd = SimdTarget::scalar;
    int threads = 1;
    Schedule schedule = Schedule::serial;
};

struct Sizes {
    int width, height, image_width, image_height;
    int ring;
};

constexpr Sizes kSizes[] = {{64, 48, 128, 96, 8}, {70, 33, 105, 50, 16},  {61, 40, 183, 120, 32},
                            {90, 70, 117, 91, 5}, {129, 65, 131, 111, 7}, {3, 2, 7, 6, 4},
                            {64, 64, 64, 64, 16}};

/// All that a caller can see after a frame.
std::vector<uint16_t> look(const TemporalUpscaler& upscaler) {
    std::vector<uint16_t> seen;
    const ColourPlanes colour = upscaler.colour();
    for (const ImageView<const uint16_t>& plane : {colour.red, colour.green, colour.blue}) {
        const std::vector<uint16_t> copy = taa_runs::copyOf(plane);
        seen.insert(seen.end(), copy.begin(), copy.end());
    }
    const ImageView<const uint8_t> counts = upscaler.sampleCount();
    for (int y = 0; y < counts.height; ++y) {
        seen.insert(seen.end(), counts.row(y), counts.row(y) + counts.width);
    }
    seen.push_back(upscaler.converged() ? 1 : 0);
    return seen;
}

using Seen = std::vector<std::vector<uint16_t>>;

/// A film, with its light changing in some pixels.
Seen upscaleFilm(const Sizes& sizes, bool with_normals, uint64_t seed, int frames, const Run& run) {
    Film film(sizes.width, sizes.height, with_normals, seed);
    Workers workers(run.threads, run.schedule, seed);
    Random random(seed);
    TemporalUpscaler upscaler;
    GBuffer gbuffer;
    Image<uint8_t> light_age(sizes.width, sizes.height);
    Seen seen;
    for (int i = 0; i < frames; ++i) {
        TaaFrame frame = film.next(gbuffer);
        frame.looked_at = !random.chance(30);
        if (random.chance(30)) {
            for (int y = 0; y < sizes.height; ++y) {
                for (int x = 0; x < sizes.width; ++x) {
                    light_age.at(x, y) = uint8_t(random.chance(80) ? 255 : random.below(20));
                }
            }
            frame.light_age = light_age.view();
        }
        upscaler.resolve(gbuffer, frame,
                         {.simd = run.simd,
                          .width = sizes.image_width,
                          .height = sizes.image_height,
                          .sample_cap = 16,
                          .ring = sizes.ring},
                         workers);
        if (frame.looked_at) {
            seen.push_back(look(upscaler));
        }
    }
    return seen;
}

/// The same world seen by pixels that are `ratio` times smaller.
synthetic::World magnified(synthetic::World world, int ratio) {
    world.width *= ratio;
    world.height *= ratio;
    for (synthetic::Layer& layer : world.layers) {
        const auto pose = layer.pose;
        layer.pose = [pose, ratio](int frame) {
            synthetic::Pose p = pose(frame);
            p.offset = {(p.offset.x + 0.5) * ratio - 0.5, (p.offset.y + 0.5) * ratio - 0.5};
            p.scale *= ratio;
            return p;
        };
    }
    return world;
}

struct Player {
    Workers workers{1};
    TemporalUpscaler upscaler;
    GBuffer gbuffer;
    UpscaleSettings settings{.sample_cap = 64, .ring = 16};

    /// A frame of `world`, for an image of settings' size.
    void show(const synthetic::World& world, int frame) {
        const auto [x_fx8, y_fx8] = synthetic::jitter(frame);
        synthetic::render(world, frame, gbuffer);
        upscaler.resolve(gbuffer,
                         {.reset = frame == 0, .jitter_x_fx8 = x_fx8, .jitter_y_fx8 = y_fx8},
                         settings, workers);
    }
    double error(const std::vector<synthetic::Colour>& wanted) const {
        const ColourPlanes colour = upscaler.colour();
        return synthetic::psnr(colour.red, colour.green, colour.blue, wanted, 8);
    }
};

}  // namespace

TEST_CASE("upscale: every target gives the scalar kernel's pictures") {
    for (const SimdTarget target : availableSimdTargets()) {
        for (uint64_t seed = 1; seed <= 12; ++seed) {
            const Sizes& sizes = kSizes[seed % std::size(kSizes)];
            const bool with_normals = seed % 3 != 0;
            const Seen expected = upscaleFilm(sizes, with_normals, seed, 14, {});
            INFO(name(target) << ", seed " << seed);
            CHECK(upscaleFilm(sizes, with_normals, seed, 14, {.simd = target}) == expected);
        }
    }
}

TEST_CASE("upscale: threads and their schedule do not matter") {
    for (uint64_t seed = 20; seed < 24; ++seed) {
        const Sizes sizes{150, 140, 225, 210, 8};
        const Seen expected = upscaleFilm(sizes, true, seed, 8, {.simd = bestSimdTarget()});
        INFO("seed " << seed);
        CHECK(
            upscaleFilm(sizes, true, seed, 8,
                        {.simd = bestSimdTarget(), .threads = 3, .schedule = Schedule::shuffled}) ==
            expected);
    }
}

TEST_CASE(
    "upscale: a pan comes nearer to the truth with every frame, and far nearer than one frame") {
    for (const int ratio : {2, 3}) {
        const synthetic::World world = taa_runs::panning(0.37, 0.21);
        const synthetic::World large = magnified(world, ratio);
        Player player;
        player.settings.width = large.width;
        player.settings.height = large.height;
        double first = 0, fourth = 0, last = 0;
        for (int frame = 0; frame < 24; ++frame) {
            player.show(world, frame);
            if (frame == 0 || frame == 4 || frame == 23) {
                const double error = player.error(synthetic::reference(large, frame, 8));
                (frame == 0 ? first : frame == 4 ? fourth : last) = error;
            }
        }
        INFO("ratio " << ratio << ": " << first << ", " << fourth << ", " << last << " dB");
        CHECK(fourth > first + 1);
        CHECK(last > fourth + 1);
    }
}

TEST_CASE("upscale: what stands still ends as the mean of all samples and then rests") {
    const synthetic::World world = taa_runs::stillLife();
    const synthetic::World large = magnified(world, 2);
    Player player;
    player.settings.width = large.width;
    player.settings.height = large.height;
    for (int frame = 0; frame < 64; ++frame) {
        CHECK_FALSE(player.upscaler.rest(world.width, world.height, player.settings));
        player.show(world, frame);
    }
    CHECK(player.error(synthetic::reference(large, 63, 16)) > 30);
    CHECK(player.upscaler.rest(world.width, world.height, player.settings));
    CHECK(player.upscaler.converged());
    CHECK_FALSE(player.upscaler.rest(world.width + 1, world.height, player.settings));
}

TEST_CASE("upscale: frames may change their size, and the history stays") {
    const synthetic::World small = taa_runs::panning(0.37, 0.21);
    const synthetic::World image = magnified(small, 4);
    const synthetic::World half = magnified(small, 2);
    Player player;
    player.settings.width = image.width;
    player.settings.height = image.height;
    Player anew;
    anew.settings = player.settings;
    // Frames of half the image's size; then a step to a larger size, whose first frame shows
    // what those before it have brought.
    const synthetic::World other = magnified(small, 3);
    for (int frame = 0; frame < 12; ++frame) {
        player.show(half, frame);
    }
    player.show(other, 12);
    synthetic::World cut = other;
    anew.show(cut, 0);
    const double before = player.error(synthetic::reference(image, 12, 6));
    const double alone = anew.error(synthetic::reference(image, 0, 6));
    INFO(before << " dB with the history, " << alone << " dB without");
    CHECK(before > alone + 1);
}

TEST_CASE("upscale: one colour stays one colour") {
    synthetic::World world = taa_runs::panning(1.7, -0.6);
    for (synthetic::Layer& layer : world.layers) {
        layer.colour = [](synthetic::Point) { return synthetic::Colour{0.5, 0.25, 2}; };
    }
    Player player;
    player.settings.width = world.width * 3 / 2;
    player.settings.height = world.height * 3 / 2;
    for (int frame = 0; frame < 6; ++frame) {
        player.show(world, frame);
    }
    const ColourPlanes colour = player.upscaler.colour();
    int wrong = 0;
    for (int y = 0; y < player.settings.height; ++y) {
        for (int x = 0; x < player.settings.width; ++x) {
            wrong += colour.red.row(y)[x] != 2048 || colour.green.row(y)[x] != 1024 ||
                             colour.blue.row(y)[x] != 8192
                         ? 1
                         : 0;
        }
    }
    CHECK(wrong == 0);
}
