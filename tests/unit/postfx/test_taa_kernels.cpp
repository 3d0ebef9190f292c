// Scalar against SIMD, one thread against many, and what the kernels' sources may contain.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "postfx/taa.h"
#include "random_frames.h"
#include "taa_runs.h"

namespace {

using namespace still;
using random_frames::Film;
using random_frames::Options;
using random_frames::Random;

struct Run {
    SimdTarget simd = SimdTarget::scalar;
    int threads = 1;
    Schedule schedule = Schedule::serial;
};

struct Size {
    int width, height;
};

/// Everything a caller can see after each frame.
using Seen = std::vector<std::vector<uint16_t>>;

std::vector<uint16_t> look(const Taa& taa) {
    std::vector<uint16_t> seen = taa_runs::everything(taa);
    seen.push_back(taa.converged() ? 1 : 0);
    return seen;
}

/// Ages in patches, most of them long.
void age(Random& random, int width, int height, Image<uint8_t>& plane) {
    plane.resize(width, height);
    const int patch = 1 + random.below(50);
    const int salt = random.below(1000);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int roll = (x / patch * 7 + y / patch * 13 + salt) % 10;
            plane.at(x, y) = uint8_t(roll < 4 ? 255 : roll * 4 - 16 + random.below(3));
        }
    }
}

/// Frames that have nothing to do with each other.
Seen resolveNoise(const Options& base, uint64_t seed, int frames, const Run& run) {
    Random random(seed);
    Workers workers(run.threads, run.schedule, seed);
    Taa taa;
    GBuffer gbuffer;
    Image<uint8_t> light_age;
    Seen seen;
    for (int frame = 0; frame < frames; ++frame) {
        Options options = base;
        options.camera_moved = random.chance(60);
        options.patch = 3 + random.below(40);
        random_frames::fill(options, random, gbuffer);
        TaaFrame facts{.reset = random.chance(5),
                       .shading_changed = random.chance(10),
                       .jitter_x_fx8 = random.below(256) - 128,
                       .jitter_y_fx8 = random.below(256) - 128};
        if (random.chance(50)) {
            age(random, base.width, base.height, light_age);
            facts.light_age = light_age.view();
        }
        const int cap = random.chance(80) ? 64 : 1 + random.below(255);
        taa.resolve(gbuffer, facts, {.simd = run.simd, .sample_cap = cap}, workers);
        seen.push_back(look(taa));
    }
    return seen;
}

Seen resolveFilm(Size size, bool with_normals, uint64_t seed, int frames, const Run& run) {
    constexpr int kRings[] = {1, 2, 3, 4, 5, 7, 8, 12, 16};
    Random random(seed + 1000);
    const int ring = kRings[random.below(int(std::size(kRings)))];
    const int cap = random.chance(50) ? 64 : 1 + random.below(30);
    Film film(size.width, size.height, with_normals, seed);
    Workers workers(run.threads, run.schedule, seed);
    Taa taa;
    GBuffer gbuffer;
    Image<uint8_t> light_age;
    Seen seen;
    for (int frame = 0; frame < frames; ++frame) {
        TaaFrame facts = film.next(gbuffer);
        if (seed % 4 == 0 && random.chance(60)) {
            age(random, size.width, size.height, light_age);
            facts.light_age = light_age.view();
        }
        taa.resolve(gbuffer, facts, {.simd = run.simd, .sample_cap = cap, .ring = ring}, workers);
        seen.push_back(look(taa));
    }
    return seen;
}

/// "" or where two runs part.
std::string firstDifference(const Seen& got, const Seen& wanted, Size size) {
    for (size_t frame = 0; frame < wanted.size(); ++frame) {
        const auto at = std::mismatch(got[frame].begin(), got[frame].end(), wanted[frame].begin());
        if (at.first == got[frame].end()) {
            continue;
        }
        constexpr const char* kPlanes[] = {"red", "green", "blue", "count", "converged"};
        const auto index = int(at.first - got[frame].begin());
        const int plane = index / (size.width * size.height);
        const int pixel = index % (size.width * size.height);
        return "frame " + std::to_string(frame) + " " + kPlanes[plane] + " (" +
               std::to_string(pixel % size.width) + ", " + std::to_string(pixel / size.width) +
               "): " + std::to_string(*at.first) + ", scalar " + std::to_string(*at.second);
    }
    return "";
}

bool hasWord(const std::string& line, const std::string& word) {
    const auto letter = [&](size_t i) {
        return i < line.size() &&
               (std::isalnum(static_cast<unsigned char>(line[i])) != 0 || line[i] == '_');
    };
    for (size_t at = line.find(word); at != std::string::npos; at = line.find(word, at + 1)) {
        if (!letter(at - 1) && !letter(at + word.size())) {
            return true;
        }
    }
    return false;
}

constexpr Size kSizes[] = {{1, 1}, {3, 200}, {65, 63}, {200, 3}, {130, 70}, {16, 16}};

}  // namespace

TEST_CASE("taa: every SIMD target equals the scalar twin on noise", "[postfx][unit]") {
    for (const Size size : kSizes) {
        for (uint64_t seed = 1; seed <= 4; ++seed) {
            const Options options{
                .width = size.width, .height = size.height, .with_normals = seed % 2 == 0};
            const Seen wanted = resolveNoise(options, seed, 10, {});
            for (const SimdTarget target : availableSimdTargets()) {
                INFO(name(target) << " " << size.width << "x" << size.height << " seed " << seed);
                CHECK(firstDifference(resolveNoise(options, seed, 10, {.simd = target}), wanted,
                                      size) == "");
            }
        }
    }
}

TEST_CASE("taa: every SIMD target equals the scalar twin on films", "[postfx][unit]") {
    for (const Size size : kSizes) {
        for (uint64_t seed = 1; seed <= 12; ++seed) {
            const bool with_normals = seed % 3 != 0;
            const Seen wanted = resolveFilm(size, with_normals, seed, 20, {});
            for (const SimdTarget target : availableSimdTargets()) {
                INFO(name(target) << " " << size.width << "x" << size.height << " seed " << seed);
                CHECK(firstDifference(resolveFilm(size, with_normals, seed, 20, {.simd = target}),
                                      wanted, size) == "");
            }
        }
    }
}

TEST_CASE("taa: threads and schedules do not change a bit", "[postfx][determinism]") {
    const Size size{300, 150};
    for (const uint64_t seed : {7u, 8u}) {
        const Seen wanted = resolveFilm(size, true, seed, 12, {.simd = bestSimdTarget()});
        for (const int threads : {1, 2, 3, 8}) {
            const Run run{bestSimdTarget(), threads, Schedule::pooled};
            CHECK(firstDifference(resolveFilm(size, true, seed, 12, run), wanted, size) == "");
        }
        const Run shuffled{bestSimdTarget(), 1, Schedule::shuffled};
        CHECK(firstDifference(resolveFilm(size, true, seed, 12, shuffled), wanted, size) == "");
    }
}

TEST_CASE("taa: kernel sources contain no floating-point type", "[postfx][unit]") {
    const std::filesystem::path root = std::filesystem::path(STILL_SOURCE_DIR) / "postfx";
    std::set<std::filesystem::path> sources{root / "taa.cpp",     root / "taa.h",
                                            root / "spatial.cpp", root / "spatial.h",
                                            root / "upscale.cpp", root / "upscale.h"};
    for (const char* part :
         {"ring.h", "rules.h", "owner.h", "record_reference.cpp", "record-inl.h", "accumulate.h",
          "accumulate_reference.cpp", "accumulate-inl.h", "gather.h", "gather_reference.cpp",
          "gather_fetch-inl.h", "gather_layers-inl.h", "gather-inl.h", "taa_lanes-inl.h",
          "taa_simd.cpp", "kernels.h"}) {
        sources.insert(root / "internal" / part);
    }
    for (const auto& entry : std::filesystem::directory_iterator(root / "internal")) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("denoise") && !name.starts_with("spatial_upscale")) {
            sources.insert(entry.path());
        }
    }
    for (const auto& path : sources) {
        INFO(path);
        std::ifstream in(path);
        REQUIRE(in.good());
        std::string line;
        for (int number = 1; std::getline(in, line); ++number) {
            if (hasWord(line, "float") || hasWord(line, "double")) {
                FAIL_CHECK(path << ":" << number << ": " << line);
            }
        }
    }
}
