// More than one engine in a process, engines that move and end, threads that come and go, and frame
// numbers that have become large.

#include <catch2/catch.hpp>
#include <limits>
#include <memory>
#include <thread>

#include "demos/scenes/builtin.h"
#include "engine/frame_loop.h"
#include "engine/stage_hash.h"

using namespace still;

namespace {

constexpr int kFrames = 9;

Scene sceneOf(const std::string& name) {
    return builtinScene(name).value();
}

FrameSettings settingsOf(const char* preset) {
    FrameSettings settings;
    settings.width = 131;
    settings.height = 70;
    settings.policy = findPreset(preset)->policy;
    settings.planes = {.normal = true, .motion = true};
    return settings;
}

using Hashes = std::vector<uint64_t>;

void append(Hashes& hashes, const FrameResult& frame) {
    for (const StageHash& stage : hashStages(frame)) {
        hashes.push_back(stage.whole);
    }
}

Hashes play(FrameLoop& loop, int first = 0, int count = kFrames) {
    Hashes hashes;
    for (int frame = first; frame < first + count; ++frame) {
        append(hashes, loop.render(frame));
    }
    return hashes;
}

Hashes playAlone(const Scene& scene, const FrameSettings& settings) {
    Workers workers(1, Schedule::serial);
    FrameLoop loop(scene, settings, workers);
    return play(loop);
}

}  // namespace

TEST_CASE("concurrency: two engines on two threads give the bytes that each gives alone",
          "[concurrency]") {
    const Scene scenes[] = {sceneOf("zoo"), sceneOf("cornell")};
    const FrameSettings settings[] = {settingsOf("still"), settingsOf("quality")};
    Hashes found[2];
    const auto live = [&](size_t k) {
        Workers workers(2);
        FrameLoop loop(scenes[k], settings[k], workers);
        found[k] = play(loop);
    };
    std::thread first(live, 0), second(live, 1);
    first.join();
    second.join();
    for (size_t k : {0, 1}) {
        CAPTURE(k);
        CHECK(found[k] == playAlone(scenes[k], settings[k]));
    }
}

TEST_CASE("concurrency: engines on several threads may share a scene and workers",
          "[concurrency]") {
    const Scene scene = sceneOf("glass");
    constexpr const char* kPresets[] = {"still", "tiny", "variance", "performance"};
    Workers shared(3);
    Hashes found[4];
    std::vector<std::thread> threads;
    for (size_t k = 0; k < 4; ++k) {
        threads.emplace_back([&, k] {
            FrameLoop loop(scene, settingsOf(kPresets[k]), shared);
            found[k] = play(loop);
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    for (size_t k = 0; k < 4; ++k) {
        CAPTURE(kPresets[k]);
        CHECK(found[k] == playAlone(scene, settingsOf(kPresets[k])));
    }
}

TEST_CASE("concurrency: engines that take turns on one thread do not see each other",
          "[concurrency]") {
    const Scene scenes[] = {sceneOf("fence"), sceneOf("penumbra")};
    const FrameSettings settings[] = {settingsOf("fast"), settingsOf("still")};
    Workers workers(2);
    FrameLoop first(scenes[0], settings[0], workers), second(scenes[1], settings[1], workers);
    Hashes found[2];
    for (int frame = 0; frame < kFrames; ++frame) {
        append(found[0], first.render(frame));
        append(found[1], second.render(frame));
    }
    CHECK(found[0] == playAlone(scenes[0], settings[0]));
    CHECK(found[1] == playAlone(scenes[1], settings[1]));
}

TEST_CASE("concurrency: an engine goes on wherever it is moved, and its last frame stays",
          "[concurrency]") {
    const Scene scene = sceneOf("cubes"), other = sceneOf("cornell");
    for (const char* preset : {"still", "variance", "balanced"}) {
        const FrameSettings settings = settingsOf(preset);
        Workers workers(2);
        auto loop = std::make_unique<FrameLoop>(scene, settings, workers);
        FrameLoop busy(other, settingsOf("still"), workers);
        Hashes found;
        for (int frame = 0; frame < kFrames; ++frame) {
            const FrameResult result = loop->render(frame);
            if (frame % 2 == 0) {
                loop = std::make_unique<FrameLoop>(std::move(*loop));
            } else {
                busy.render(frame);
                busy = std::move(*loop);
                *loop = std::move(busy);
                busy = FrameLoop(other, settingsOf("tiny"), workers);
            }
            append(found, result);
        }
        CAPTURE(preset);
        CHECK(found == playAlone(scene, settings));
    }
}

TEST_CASE("concurrency: engines that end in the middle leave the others alone", "[concurrency]") {
    const Scene scene = sceneOf("zoo"), other = sceneOf("penumbra");
    Workers workers(3);
    FrameLoop loop(scene, settingsOf("still"), workers);
    auto mortal = std::make_unique<FrameLoop>(other, settingsOf("still"), workers);
    Hashes found;
    for (int frame = 0; frame < kFrames; ++frame) {
        mortal->render(frame % 3);
        append(found, loop.render(frame));
        if (frame % 3 == 2) {
            mortal = std::make_unique<FrameLoop>(other, settingsOf("intel"), workers);
        }
    }
    CHECK(found == playAlone(scene, settingsOf("still")));
}

TEST_CASE("concurrency: 1 to 64 workers give the same bytes", "[concurrency]") {
    const Scene scene = sceneOf("glass");
    FrameSettings settings = settingsOf("quality");
    const Hashes expected = playAlone(scene, settings);
    for (int threads = 1; threads <= 64; threads += threads < 8 ? 1 : 7) {
        Workers workers(threads);
        FrameLoop loop(scene, settings, workers);
        CAPTURE(threads);
        CHECK(play(loop) == expected);
    }
}

TEST_CASE("long runs: a history that begins late in the numbers of frames is one that begins at 0",
          "[concurrency]") {
    const Scene scene = sceneOf("checker");  // its camera has come to rest long before
    constexpr int kLast = std::numeric_limits<int>::max(), kCount = 80;
    constexpr int kRested = 1000;
    for (const char* preset : {"still", "quality", "intel"}) {
        FrameSettings settings = settingsOf(preset);
        settings.width = 33;
        settings.height = 20;
        Workers workers(1, Schedule::serial);
        const auto from = [&](int first) {
            FrameLoop loop(scene, settings, workers);
            loop.resize(settings.width, settings.height);
            return play(loop, first, kCount);
        };
        CAPTURE(preset);
        CHECK(from(kLast - kCount) == from(kRested));
    }
}

TEST_CASE("long runs: the last frame of all is rendered", "[concurrency]") {
    Scene scene = sceneOf("checker");
    constexpr int kLast = std::numeric_limits<int>::max();
    scene.cuts = {kLast - 6};
    FrameSettings settings = settingsOf("still");
    Workers workers(1, Schedule::serial);
    FrameLoop run(scene, settings, workers), late(scene, settings, workers);
    Hashes expected, found;
    for (int frame = kLast - 6; frame < kLast; ++frame) {
        run.render(frame);
    }
    append(expected, run.render(kLast));
    append(found, late.render(kLast));
    CHECK(found == expected);
}

TEST_CASE("long runs: sample numbers go over 2^31 as over any other", "[concurrency]") {
    const Scene scene = sceneOf("checker");
    for (const char* preset : {"still", "quality", "variance"}) {
        FrameSettings settings = settingsOf(preset);
        settings.width = 33;
        settings.height = 20;
        settings.subframes = 4;
        settings.first_sample = std::numeric_limits<int>::max() - 50;
        const int period = int(policyPeriod(settings.policy));
        const Hashes over = playAlone(scene, settings);
        settings.first_sample %= period;
        CAPTURE(preset);
        CHECK(over == playAlone(scene, settings));
    }
    for (uint32_t near : {0x7FFFFFFFu, 0xFFFFFFFFu}) {
        for (uint32_t i = near - 200; i != near + 200; ++i) {
            REQUIRE(taaSample(i + 64).x_fx8 == taaSample(i).x_fx8);
            REQUIRE(taaSample(i + 64).y_fx8 == taaSample(i).y_fx8);
        }
    }
}
