// Scalar against SIMD, one thread against many, and what the kernels' sources may contain.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "postfx/taa.h"
#include "random_frames.h"

namespace {

using namespace still;
using random_frames::Options;
using random_frames::Random;

struct Run {
    SimdTarget simd = SimdTarget::scalar;
    int threads = 1;
    Schedule schedule = Schedule::serial;
};

void append(std::vector<uint16_t>& bytes, ImageView<const uint16_t> plane) {
    for (int y = 0; y < plane.height; ++y) {
        bytes.insert(bytes.end(), plane.row(y), plane.row(y) + plane.width);
    }
}

/// Everything a caller can see of a run over random frames, including resets and light changes.
std::vector<uint16_t> resolveRandom(const Options& base, uint64_t seed, int frames,
                                    const Run& run) {
    Random random(seed);
    Workers workers(run.threads, run.schedule, seed);
    Taa taa;
    GBuffer gbuffer;
    std::vector<uint16_t> seen;
    for (int frame = 0; frame < frames; ++frame) {
        Options options = base;
        options.camera_moved = random.chance(60);
        options.patch = 3 + random.below(40);
        random_frames::fill(options, random, gbuffer);
        const bool reset = random.chance(5), shading_changed = random.chance(10);
        const int cap = random.chance(80) ? 64 : 1 + random.below(255);
        taa.resolve(gbuffer, {.reset = reset, .shading_changed = shading_changed},
                    {.simd = run.simd, .sample_cap = cap}, workers);
        append(seen, taa.colour().red);
        append(seen, taa.colour().green);
        append(seen, taa.colour().blue);
        const ImageView<const uint8_t> count = taa.sampleCount();
        for (int y = 0; y < count.height; ++y) {
            seen.insert(seen.end(), count.row(y), count.row(y) + count.width);
        }
        seen.push_back(taa.converged() ? 1 : 0);
    }
    return seen;
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

const Options kSizes[] = {{.width = 1, .height = 1},    {.width = 3, .height = 200},
                          {.width = 65, .height = 63},  {.width = 200, .height = 3},
                          {.width = 130, .height = 70}, {.width = 16, .height = 16}};

}  // namespace

TEST_CASE("taa: every SIMD target equals the scalar twin on random frames", "[postfx][unit]") {
    for (const Options& size : kSizes) {
        for (const bool with_normals : {true, false}) {
            for (uint64_t seed = 1; seed <= 4; ++seed) {
                Options options = size;
                options.with_normals = with_normals;
                const auto wanted = resolveRandom(options, seed, 12, {});
                for (SimdTarget target : availableSimdTargets()) {
                    INFO(name(target)
                         << " " << size.width << "x" << size.height << " seed " << seed);
                    const auto got = resolveRandom(options, seed, 12, {.simd = target});
                    const auto at = std::mismatch(got.begin(), got.end(), wanted.begin());
                    INFO("first difference at value " << at.first - got.begin());
                    CHECK(got == wanted);
                }
            }
        }
    }
}

TEST_CASE("taa: threads and schedules do not change a bit", "[postfx][determinism]") {
    const Options options{.width = 300, .height = 150};
    const auto wanted = resolveRandom(options, 7, 8, {.simd = bestSimdTarget()});
    for (int threads : {1, 2, 3, 8}) {
        const Run run{bestSimdTarget(), threads, Schedule::pooled};
        CHECK(resolveRandom(options, 7, 8, run) == wanted);
    }
    const Run shuffled{bestSimdTarget(), 1, Schedule::shuffled};
    CHECK(resolveRandom(options, 7, 8, shuffled) == wanted);
}

TEST_CASE("taa: kernel sources contain no floating-point type", "[postfx][unit]") {
    const std::filesystem::path root = std::filesystem::path(STILL_SOURCE_DIR) / "postfx";
    int files = 0;
    std::vector<std::filesystem::path> kernels{root / "taa.cpp", root / "taa.h"};
    for (const auto& entry : std::filesystem::directory_iterator(root / "internal")) {
        kernels.push_back(entry.path());
    }
    for (const auto& path : kernels) {
        std::ifstream in(path);
        REQUIRE(in.good());
        ++files;
        std::string line;
        for (int number = 1; std::getline(in, line); ++number) {
            INFO(path << ":" << number << ": " << line);
            CHECK_FALSE(hasWord(line, "float"));
            CHECK_FALSE(hasWord(line, "double"));
        }
    }
    CHECK(files >= 10);
}
