// The stories of the published methods.

#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "postfx/laboratory.h"
#include "random_frames.h"
#include "random_policy.h"
#include "rasterizer/fixed.h"

namespace {

using namespace still;
using random_frames::Options;
using random_frames::Random;

struct Planes {
    Image<uint16_t> red, green, blue;

    Planes(int width, int height) : red(width, height), green(width, height), blue(width, height) {}
    ColourTargets targets() { return {red.view(), green.view(), blue.view()}; }
    StoryColour at(int x, int y) const { return {red.at(x, y), green.at(x, y), blue.at(x, y)}; }
};

/// All that can be asked of a whole picture.
struct Told {
    Image<Verdict> reason;
    Image<uint8_t> lost;
    Planes past, rectified, low, high;

    Told(const Laboratory& laboratory, const GBuffer& g, Workers& workers)
        : reason(g.width(), g.height()),
          lost(g.width(), g.height()),
          past(g.width(), g.height()),
          rectified(g.width(), g.height()),
          low(g.width(), g.height()),
          high(g.width(), g.height()) {
        laboratory.rejections(g, {reason.view(), lost.view()}, workers);
        laboratory.storyPlane(g, StoryPlane::reprojected, past.targets(), workers);
        laboratory.storyPlane(g, StoryPlane::rectified, rectified.targets(), workers);
        laboratory.storyPlane(g, StoryPlane::box_low, low.targets(), workers);
        laboratory.storyPlane(g, StoryPlane::box_high, high.targets(), workers);
    }
};

/// The taps' shares of the result add up to all of it: that of 256, within its roundings.
bool sharesAddUp(const PixelStory& story) {
    int used = 0;
    for (const PixelTap& tap : story.taps) {
        used += tap.used;
    }
    return std::abs(used - 256) <= 13;
}

/// Holds for any box: history clipped or clamped lies in it, within the rounding of the clip.
bool isInBox(const PixelStory& story, ColourSpace space) {
    const bool ycocg = space == ColourSpace::ycocg;
    const StoryBox& box = ycocg ? story.box_ycocg : story.box_rgb;
    const StoryColour colour = ycocg ? toStoryYcocg(story.blend.rectified) : story.blend.rectified;
    bool held = true;
    for (size_t c = 0; c < 3; ++c) {
        const int slack = 4 + (box.high[c] - box.low[c]) / 512;
        held &= colour[c] >= box.low[c] - slack && colour[c] <= box.high[c] + slack;
    }
    return held;
}

std::string wrongIn(const PixelStory& story, const Laboratory& laboratory, const Told& told,
                    const TaaPolicy& policy) {
    const int x = story.x, y = story.y;
    const ColourPlanes shown = laboratory.colour();
    const StoryColour output{shown.red.at(x, y), shown.green.at(x, y), shown.blue.at(x, y)};
    if (story.output != output) {
        return "another colour";
    }
    if (story.confidence != laboratory.confidence().at(x, y)) {
        return "another confidence";
    }
    if (!sharesAddUp(story)) {
        return "shares do not add up";
    }
    if (told.reason.at(x, y) != story.reason || told.lost.at(x, y) != story.lost) {
        return "another reason";
    }
    if (policy.tone == Tone::linear && story.frames == 2) {
        if (told.past.at(x, y) != story.blend.history ||
            told.rectified.at(x, y) != story.blend.rectified) {
            return "another past";
        }
    }
    if (policy.tone == Tone::linear && policy.space == ColourSpace::rgb &&
        policy.rectification == Rectification::clamp && story.frames == 2 &&
        !isInBox(story, policy.space)) {
        return "outside the box";
    }
    return "";
}

/// "" or the first pixel whose story is wrong.
std::string checkRun(const Options& base, const TaaPolicy& policy, uint64_t seed, int frames,
                     std::array<int, kVerdicts>& reasons) {
    Random random(seed);
    Workers workers(1, Schedule::serial);
    Laboratory laboratory;
    GBuffer gbuffer;
    for (int frame = 0; frame < frames; ++frame) {
        Options options = base;
        options.camera_moved = random.chance(60);
        options.patch = 3 + random.below(40);
        random_frames::fill(options, random, gbuffer);
        laboratory.resolve(gbuffer,
                           {.reset = random.chance(5),
                            .jitter_x_fx8 = random.below(256) - 128,
                            .jitter_y_fx8 = random.below(256) - 128},
                           policy, bestSimdTarget(), workers);
        const Told told(laboratory, gbuffer, workers);
        for (int y = 0; y < base.height; ++y) {
            for (int x = 0; x < base.width; ++x) {
                const PixelStory story = laboratory.story(gbuffer, x, y);
                ++reasons[size_t(story.reason)];
                const std::string wrong = wrongIn(story, laboratory, told, policy);
                if (!wrong.empty()) {
                    return wrong + " at " + std::to_string(x) + ", " + std::to_string(y) +
                           " in frame " + std::to_string(frame);
                }
            }
        }
    }
    return "";
}

/// A plain surface everywhere, at rest.
void fillPlain(GBuffer& g) {
    constexpr int kSide = 16;
    g.resize(kSide, kSide, {.normal = true, .motion = true});
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            g.red.at(x, y) = g.green.at(x, y) = g.blue.at(x, y) = 1000;
            g.depth.at(x, y) = std::bit_cast<uint32_t>(0.1f);
            g.depth_before.at(x, y) = uint16_t(logDepth16(g.depth.at(x, y)));
            g.id.at(x, y) = 1;
            g.normal.at(x, y) = 0;
            g.motion.at(x, y) = {};
        }
    }
}

/// Two frames of it; `change` alters the second.
template <class Change>
PixelStory afterChange(const TaaPolicy& policy, Change&& change) {
    Workers workers(1, Schedule::serial);
    Laboratory laboratory;
    GBuffer g;
    fillPlain(g);
    laboratory.resolve(g, {.reset = true}, policy, bestSimdTarget(), workers);
    for (int y = 0; y < g.height(); ++y) {
        for (int x = 0; x < g.width(); ++x) {
            change(g, x, y);
        }
    }
    laboratory.resolve(g, {}, policy, bestSimdTarget(), workers);
    return laboratory.story(g, 8, 8);
}

TaaPolicy plainPolicy() {
    TaaPolicy policy;
    policy.method = Method::recursive;
    policy.rectification = Rectification::off;
    return policy;
}

}  // namespace

TEST_CASE("story: the stories of every published preset have the picture's colours",
          "[postfx][unit]") {
    std::array<int, kVerdicts> reasons{};
    for (const TaaPreset& preset : taaPresets()) {
        if (preset.policy.method == Method::recursive) {
            INFO(preset.name);
            CHECK(checkRun({.width = 50, .height = 37}, preset.policy, 3, 6, reasons) == "");
        }
    }
}

TEST_CASE("story: the stories of random policies have the picture's colours", "[postfx][unit]") {
    Random random(7);
    std::array<int, kVerdicts> reasons{};
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        const TaaPolicy policy = random_frames::randomPolicy(random);
        const Options size{.width = seed % 2 != 0 ? 33 : 16, .height = seed % 5 != 0 ? 17 : 3};
        INFO("policy " << seed);
        CHECK(checkRun(size, policy, seed, 4, reasons) == "");
    }
    for (const Verdict verdict :
         {Verdict::taken, Verdict::no_history, Verdict::off_screen, Verdict::depth, Verdict::normal,
          Verdict::id, Verdict::colour, Verdict::velocity}) {
        INFO(verdictName(verdict));
        CHECK(reasons[size_t(verdict)] > 0);
    }
}

TEST_CASE("story: each test of the laboratory names itself", "[postfx][unit]") {
    const auto nothing = [](GBuffer&, int, int) {};
    TaaPolicy policy = plainPolicy();
    policy.depth_reject_q15 = 1000;
    policy.normal_reject_q15 = 30000;
    policy.id_reject = true;
    policy.velocity_reject_fx8 = 128;
    policy.luma_reject_q15 = 3000;
    const PixelStory taken = afterChange(policy, nothing);
    CHECK(taken.reason == Verdict::taken);
    CHECK(taken.lost == 0);
    CHECK(taken.blend.trust_q8 == 256);

    struct Case {
        Verdict reason;
        void (*change)(GBuffer&, int, int);
    };
    const Case cases[] = {
        {Verdict::depth, [](GBuffer& g, int x, int y) { g.depth_before.at(x, y) += 500; }},
        {Verdict::normal, [](GBuffer& g, int x, int y) { g.normal.at(x, y) = 0x4000'4000; }},
        {Verdict::id, [](GBuffer& g, int x, int y) { g.id.at(x, y) = 2; }},
        {Verdict::velocity,
         [](GBuffer& g, int x, int y) {
             g.motion.at(x, y) = {256, 0};
         }},
        {Verdict::colour, [](GBuffer& g, int x, int y) { g.green.at(x, y) = 2000; }},
        {Verdict::off_screen,
         [](GBuffer& g, int x, int y) {
             g.motion.at(x, y) = {9999, 0};
         }},
        {Verdict::no_history,
         [](GBuffer& g, int x, int y) {
             g.motion.at(x, y) = {kNoHistory, 0};
         }},
    };
    for (const Case& c : cases) {
        INFO(verdictName(c.reason));
        const PixelStory story = afterChange(policy, c.change);
        CHECK(story.reason == c.reason);
        CHECK(story.lost == 255);
        CHECK(story.blend.trust_q8 == 0);
        CHECK(story.output == story.raw);
        policy.partial = true;
        const bool halved = c.reason != Verdict::off_screen && c.reason != Verdict::no_history;
        CHECK(afterChange(policy, c.change).blend.trust_q8 == (halved ? 128 : 0));
        policy.partial = false;
    }
}

TEST_CASE("story: a bright past is told before and after the clip", "[postfx][unit]") {
    TaaPolicy policy = plainPolicy();
    policy.rectification = Rectification::clamp;
    policy.space = ColourSpace::rgb;
    const PixelStory story = afterChange(policy, [](GBuffer& g, int x, int y) {
        g.red.at(x, y) = uint16_t(200 + x);
        g.green.at(x, y) = uint16_t(300 + y);
    });
    CHECK(story.blend.rectifies);
    CHECK(story.blend.clipped);
    CHECK(story.blend.history == StoryColour{1000, 1000, 1000});
    CHECK(story.blend.rectified == StoryColour{209, 309, 1000});
    CHECK(story.box_rgb.low == StoryColour{207, 307, 1000});
    CHECK(story.box_rgb.high == StoryColour{209, 309, 1000});
    CHECK(story.box_rgb.middle == StoryColour{208, 308, 1000});
}

TEST_CASE("story: luma and chroma go there and back", "[postfx][unit]") {
    for (const StoryColour& c : {StoryColour{0, 0, 0}, StoryColour{4096, 4096, 4096},
                                 StoryColour{1000, 2000, 3000}, StoryColour{4000, 40, 400}}) {
        const StoryColour back = fromStoryYcocg(toStoryYcocg(c));
        for (size_t k = 0; k < 3; ++k) {
            CHECK(std::abs(back[k] - c[k]) <= 2);
        }
    }
}
