// What a frame is said to need, against what it takes.

#include <catch2/catch.hpp>
#include <fstream>
#include <limits>

#include "demos/scenes/builtin.h"
#include "engine/anti_aliasing.h"
#include "engine/frame_loop.h"
#include "engine/memory_need.h"

using namespace still;

namespace {

/// Addresses in use; large planes are mappings of their own, so they show here at once.
uint64_t mappedBytes() {
    constexpr uint64_t kPageBytes = 4096;
    uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * kPageBytes;
}

}  // namespace

TEST_CASE("memory need: amounts are told by powers of 1024, rounded up", "[unit][engine]") {
    CHECK(bytesText(0) == "0 bytes");
    CHECK(bytesText(1023) == "1023 bytes");
    CHECK(bytesText(1024) == "1.0 KB");
    CHECK(bytesText(1025) == "1.1 KB");
    CHECK(bytesText(uint64_t{1536} << 20) == "1.5 GB");
    CHECK(bytesText((uint64_t{1} << 20) - 1) == "1024.0 KB");
    CHECK(bytesText(std::numeric_limits<uint64_t>::max()) == "16384.0 PB");
    CHECK(checkMemory("a.obj", 10, 10));
    CHECK(checkMemory("a.obj", 11 << 20, 10 << 20).error().message ==
          "a.obj: needs about 11.0 MB of memory, 10.0 MB are allowed (--max-memory)");
}

TEST_CASE("memory need: a frame takes what was said before, and not much more", "[unit][engine]") {
    if (mappedBytes() == 0) {
        WARN("no /proc/self/statm here: skipped");
        return;
    }
    const auto [scene_name, mode] =
        GENERATE(table<const char*, const char*>({{"triangle", "none"},
                                                  {"triangle", "fxaa"},
                                                  {"triangle", "ssaa:4"},
                                                  {"triangle", "taa:still"},
                                                  {"triangle", "taa:tiny"},
                                                  {"triangle", "taa:basic"},
                                                  {"triangle", "taa:performance"},
                                                  {"cornell", "taa:still"},
                                                  {"cornell", "none"}}));
    const Scene scene = builtinScene(scene_name).value();
    const AntiAliasingChoice choice = parseAntiAliasing(mode).value();
    const FrameSettings settings{.width = 1280,
                                 .height = 704,
                                 .anti_aliasing = choice.mode,
                                 .policy = choice.policy,
                                 .ssaa_samples = choice.ssaa_samples};
    Workers workers(1);
    FrameLoop loop(scene, settings, workers);
    const uint64_t before = mappedBytes();
    loop.render(settings.policy.ring);  // all of the ring
    const double taken = double(mappedBytes() - before);
    const double said = double(frameMemoryBytes(settings, scene.lights.sampled()));
    INFO(scene_name << ", " << mode << ": " << taken / said);
    CHECK(taken >= 0.98 * said);
    CHECK(taken <= 1.3 * said + (8 << 20));
}
