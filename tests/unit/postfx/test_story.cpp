// The story told of a pixel is what the kernels did.

#include "postfx/story.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>
#include <vector>

#include "postfx/internal/rules.h"
#include "postfx/laboratory.h"
#include "postfx/taa.h"
#include "random_frames.h"
#include "taa_runs.h"

namespace {

using namespace still;
using random_frames::Film;
using random_frames::Options;
using random_frames::Random;
using synthetic::Colour;
using synthetic::Point;
using synthetic::Pose;
using synthetic::World;
using taa_runs::backdrop;
using taa_runs::panning;
using taa_runs::Player;
using taa_runs::square;

StoryColour colourAt(const ColourPlanes& planes, int x, int y) {
    return {planes.red.at(x, y), planes.green.at(x, y), planes.blue.at(x, y)};
}

std::string place(int x, int y) {
    return "(" + std::to_string(x) + ", " + std::to_string(y) + ") ";
}

std::string text(const StoryColour& c) {
    return std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]);
}

struct Planes {
    Image<uint16_t> red, green, blue;

    Planes(int width, int height) : red(width, height), green(width, height), blue(width, height) {}
    ColourTargets targets() { return {red.view(), green.view(), blue.view()}; }
    StoryColour at(int x, int y) const { return {red.at(x, y), green.at(x, y), blue.at(x, y)}; }
};

struct Rejected {
    Image<Verdict> reason;
    Image<uint8_t> lost;

    Rejected(int width, int height) : reason(width, height), lost(width, height) {}
    RejectionTargets targets() { return {reason.view(), lost.view()}; }
};

/// Pixels whose story was of each kind.
struct Seen {
    std::array<int, 5> sources{};
    std::array<int, kVerdicts> verdicts{};
    int fitted = 0;
};

/// The mean of the taps' colours by their weights, where nothing else went into the pixel.
std::string checkWeights(const PixelStory& story) {
    int64_t total = 0;
    std::array<int64_t, 3> sum{};
    for (const PixelTap& tap : story.taps) {
        if (tap.along_far) {
            continue;
        }
        total += tap.used;
        for (size_t c = 0; c < 3; ++c) {
            sum[c] += int64_t{tap.used} * tap.colour[c];
        }
    }
    for (size_t c = 0; c < 3 && total >= 2; ++c) {
        if (std::abs((sum[c] + total / 2) / total - story.output[c]) > 1) {
            return "taps give another colour";
        }
    }
    return "";
}

std::string checkGathered(const PixelStory& story, const Taa& taa, Seen& seen) {
    if (story.output != colourAt(taa.colour(), story.x, story.y)) {
        return place(story.x, story.y) + "told " + text(story.output) + ", shown " +
               text(colourAt(taa.colour(), story.x, story.y));
    }
    if (story.count != taa.sampleCount().at(story.x, story.y)) {
        return place(story.x, story.y) + "another count";
    }
    const bool recoloured = std::any_of(story.taps.begin(), story.taps.end(),
                                        [](const PixelTap& tap) { return tap.recoloured; });
    if (story.source == PixelSource::gathered && story.spatial_q8 == 0 && !recoloured) {
        ++seen.fitted;
        const std::string wrong = checkWeights(story);
        if (!wrong.empty()) {
            return place(story.x, story.y) + wrong;
        }
    }
    ++seen.sources[size_t(story.source)];
    for (const PixelTap& tap : story.taps) {
        ++seen.verdicts[size_t(tap.verdict)];
        if (tap.verdict != Verdict::taken && tap.used != 0) {
            return place(story.x, story.y) + "a rejected tap is used";
        }
    }
    return "";
}

/// "" or the first pixel whose story is not what the picture shows, or differs from its planes'.
std::string checkPicture(const Taa& taa, const GBuffer& gbuffer, Workers& workers, Seen& seen) {
    Rejected rejected(gbuffer.width(), gbuffer.height());
    taa.rejections(gbuffer, rejected.targets(), workers);
    for (int y = 0; y < gbuffer.height(); ++y) {
        for (int x = 0; x < gbuffer.width(); ++x) {
            const PixelStory story = taa.story(gbuffer, x, y);
            const std::string wrong = checkGathered(story, taa, seen);
            if (!wrong.empty()) {
                return wrong;
            }
            if (rejected.reason.at(x, y) != story.reason || rejected.lost.at(x, y) != story.lost) {
                return place(x, y) + "another reason in the plane";
            }
        }
    }
    return "";
}

std::string checkFilm(Film film, int frames, const TaaSettings& settings, Seen& seen) {
    Workers workers(1, Schedule::serial);
    Taa taa;
    GBuffer gbuffer;
    for (int frame = 0; frame < frames; ++frame) {
        const TaaFrame facts = film.next(gbuffer);
        taa.resolve(gbuffer, facts, settings, workers);
        if (frame % 4 == 3 || frame == 0) {
            const std::string wrong = checkPicture(taa, gbuffer, workers, seen);
            if (!wrong.empty()) {
                return "frame " + std::to_string(frame) + " " + wrong;
            }
        }
    }
    return "";
}

/// Counts pixels by reason.
std::array<int, kVerdicts> reasonsOf(const Player& player) {
    Rejected rejected(player.gbuffer.width(), player.gbuffer.height());
    Workers workers(1, Schedule::serial);
    player.taa.rejections(player.gbuffer, rejected.targets(), workers);
    std::array<int, kVerdicts> counts{};
    for (int y = 0; y < player.gbuffer.height(); ++y) {
        for (int x = 0; x < player.gbuffer.width(); ++x) {
            ++counts[size_t(rejected.reason.at(x, y))];
        }
    }
    return counts;
}

int of(const std::array<int, kVerdicts>& counts, Verdict verdict) {
    return counts[size_t(verdict)];
}

}  // namespace

TEST_CASE("story: the gather's stories have the colours, counts and reasons of the picture",
          "[postfx][unit]") {
    Seen seen;
    for (uint64_t seed = 1; seed <= 10; ++seed) {
        constexpr int kRings[] = {8, 4, 2, 1, 16};
        const TaaSettings settings{.sample_cap = seed % 4 != 0 ? 64 : 3,
                                   .ring = kRings[seed % std::size(kRings)]};
        const int width = seed % 2 != 0 ? 65 : 130, height = seed % 3 != 0 ? 40 : 70;
        INFO("seed " << seed);
        CHECK(checkFilm({width, height, seed % 3 != 0, seed}, 24, settings, seen) == "");
    }
    // Long enough for tiles to rest beside others, so that their samples lie otherwise.
    for (uint64_t seed = 11; seed <= 13; ++seed) {
        INFO("seed " << seed);
        CHECK(checkFilm({200, 140, true, seed}, 48, {.sample_cap = 4}, seen) == "");
    }
    CHECK(seen.fitted > 10000);
    CHECK(seen.sources[size_t(PixelSource::first)] > 0);
    CHECK(seen.sources[size_t(PixelSource::mean)] > 0);
    CHECK(seen.sources[size_t(PixelSource::gathered)] > 0);
    for (const Verdict verdict : {Verdict::off_screen, Verdict::depth, Verdict::normal, Verdict::id,
                                  Verdict::velocity, Verdict::epoch, Verdict::seam}) {
        INFO(verdictName(verdict));
        CHECK(seen.verdicts[size_t(verdict)] > 0);
    }
}

TEST_CASE("story: asking the gather changes nothing", "[postfx][unit]") {
    Workers workers(2);
    Film film(100, 70, true, 5), same(100, 70, true, 5);
    Taa asked, silent;
    GBuffer a, b;
    Planes planes(100, 70);
    for (int frame = 0; frame < 20; ++frame) {
        asked.resolve(a, film.next(a), {}, workers);
        silent.resolve(b, same.next(b), {}, workers);
        (void)asked.story(a, frame, frame);
        asked.storyPlane(a, StoryPlane::reprojected, planes.targets(), workers);
        REQUIRE(taa_runs::everything(asked) == taa_runs::everything(silent));
    }
}

TEST_CASE("story: a pixel at rest is the exact mean of its samples", "[postfx][unit]") {
    Player player;
    const World world = taa_runs::stillLife();
    player.play(world, 0, 19);
    CHECK(player.taa.story(player.gbuffer, 5, 5).source == PixelSource::mean);
    CHECK(player.taa.story(player.gbuffer, 5, 5).count == 20);
    CHECK_FALSE(player.taa.story(player.gbuffer, 5, 5).finished);
    player.play(world, 20, 70);
    const PixelStory story = player.taa.story(player.gbuffer, 5, 5);
    CHECK(story.source == PixelSource::mean);
    CHECK(story.finished);
    CHECK(story.count == 64);
    CHECK(story.output == colourAt(player.taa.colour(), 5, 5));
    CHECK(story.reason == Verdict::taken);
    for (const TileWork& work : player.taa.tileWork()) {
        CHECK(work.finished);
        CHECK_FALSE((work.drawn || work.recorded || work.summed || work.resolved));
    }
}

TEST_CASE("story: the work of tiles is what the plan asks to be drawn", "[postfx][unit]") {
    Workers workers(1, Schedule::serial);
    std::array<int, 5> counts{};
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Film film(200, 140, true, seed);
        Taa taa;
        GBuffer gbuffer;
        for (int frame = 0; frame < 60; ++frame) {
            const TaaFrame facts = film.next(gbuffer);
            const TaaSettings settings{.sample_cap = 8};
            const auto planned =
                taa.plan(gbuffer.width(), gbuffer.height(), gbuffer.tiles, facts, settings);
            const std::vector<uint8_t> wanted(planned.begin(), planned.end());
            taa.resolve(gbuffer, facts, settings, workers);
            const std::vector<TileWork> work = taa.tileWork();
            REQUIRE(work.size() == wanted.size());
            for (size_t i = 0; i < work.size(); ++i) {
                INFO("seed " << seed << " frame " << frame << " tile " << i);
                CHECK(work[i].drawn == (wanted[i] != 0));
                counts[0] += work[i].drawn ? 1 : 0;
                counts[1] += work[i].recorded ? 1 : 0;
                counts[2] += work[i].summed ? 1 : 0;
                counts[3] += work[i].resolved ? 1 : 0;
                counts[4] += work[i].finished && !work[i].drawn ? 1 : 0;
            }
        }
    }
    for (const int count : counts) {
        CHECK(count > 0);
    }
}

TEST_CASE("story: the gather names why the past does not count", "[postfx][unit]") {
    SECTION("a first frame has no past") {
        Player player;
        player.play(panning(1.3, 0), 0, 0);
        CHECK(of(reasonsOf(player), Verdict::no_history) == 112 * 80);
        CHECK(player.taa.story(player.gbuffer, 50, 40).source == PixelSource::first);
    }
    SECTION("a pan of 4 pixels leaves a strip of 28 whose past lies beside the picture") {
        Player player;
        player.play(panning(4, 0), 0, 9);
        const auto counts = reasonsOf(player);
        CHECK(of(counts, Verdict::off_screen) > 80 * 20);
        CHECK(of(counts, Verdict::off_screen) <= 80 * 29);
        CHECK(of(counts, Verdict::taken) > 80 * 80);
        const PixelStory story = player.taa.story(player.gbuffer, 2, 40);
        CHECK(story.reason == Verdict::off_screen);
        CHECK(story.lost > 200);
    }
    SECTION("what a square uncovers was hidden by something nearer") {
        const auto sliding = [](int frame) { return Pose{{20 + 3.0 * frame, 40}}; };
        const World world{112, 80, false, {backdrop(), square(8, sliding)}};
        World moving = world;
        moving.layers[1].moves = true;
        Player player;
        player.play(moving, 0, 9);
        // Left edge at 20 + 27 − 8 = 39, 3 pixels farther left a frame ago.
        const PixelStory story = player.taa.story(player.gbuffer, 37, 40);
        CHECK(story.owner.surface == 1);
        CHECK(story.reason == Verdict::depth);
        const bool nearer =
            std::any_of(story.taps.begin(), story.taps.end(), [](const PixelTap& tap) {
                return tap.verdict == Verdict::depth && tap.layer == TapLayer::nearer &&
                       tap.surface == 2;
            });
        CHECK(nearer);
    }
    SECTION("what a thing left that began to move is its own old place") {
        World world{112, 80, false, {backdrop(), square(8, [](int) { return Pose{{40, 40}}; })}};
        Player player;
        player.play(world, 0, 9);
        world.layers[1].pose = [](int frame) { return Pose{{40.0 + (frame - 9) * 4, 40}}; };
        world.layers[1].moves = true;
        player.play(world, 10, 10);
        const PixelStory story = player.taa.story(player.gbuffer, 34, 40);
        CHECK(story.owner.surface == 1);
        CHECK(story.reason == Verdict::velocity);
        CHECK(story.lost > 200);
    }
    SECTION("a change of light makes the past old, a change of one surface only its own") {
        Player player;
        player.play(panning(1.3, 0), 0, 8);
        player.show(panning(1.3, 0), 9, {.shading_changed = true});
        CHECK(of(reasonsOf(player), Verdict::epoch) > 112 * 80 * 9 / 10);
        player.play(panning(1.3, 0), 10, 18);
        const uint64_t other = 1 << 5;
        player.show(panning(1.3, 0), 19, {.changed_surfaces = {&other, 1}});
        CHECK(of(reasonsOf(player), Verdict::epoch) == 0);
    }
    SECTION("a moved surface that turned its normal was lit otherwise") {
        World world = panning(1.3, 0);
        world.layers[0].moves = true;
        world.layers[0].normal = 0x0000'0001;
        Player player;
        player.play(world, 0, 8);
        world.layers[0].normal = 0x4000'4000;
        player.play(world, 9, 9);
        CHECK(of(reasonsOf(player), Verdict::normal) > 112 * 80 * 9 / 10);
    }
}

TEST_CASE("story: the gather's image from the past does not know this frame", "[postfx][unit]") {
    World world = panning(1.3, 0.4);
    const Colour before{0.25, 0.5, 0.125}, flash{1, 1, 1};
    world.layers[0].colour = [=](Point) { return before; };
    Player player;
    player.play(world, 0, 8);
    world.layers[0].colour = [=](Point) { return flash; };
    player.play(world, 9, 9);
    Workers workers(1, Schedule::serial);
    Planes past(112, 80), history(112, 80);
    player.taa.storyPlane(player.gbuffer, StoryPlane::reprojected, past.targets(), workers);
    player.taa.storyPlane(player.gbuffer, StoryPlane::history, history.targets(), workers);
    const StoryColour old{1024, 2048, 512};
    for (int y = 8; y < 72; ++y) {
        for (int x = 8; x < 104; ++x) {
            INFO(place(x, y));
            REQUIRE(past.at(x, y) == old);
            REQUIRE(history.at(x, y) == old);
            REQUIRE(colourAt(player.taa.colour(), x, y) != old);
        }
    }
}

TEST_CASE("story: the box of the gather's window is that of its nine samples", "[postfx][unit]") {
    Player player;
    player.play(panning(1.3, 0.4), 0, 3);
    const GBuffer& g = player.gbuffer;
    Workers workers(1, Schedule::serial);
    Planes lows(112, 80), middles(112, 80), highs(112, 80);
    player.taa.storyPlane(g, StoryPlane::box_low, lows.targets(), workers);
    player.taa.storyPlane(g, StoryPlane::box_middle, middles.targets(), workers);
    player.taa.storyPlane(g, StoryPlane::box_high, highs.targets(), workers);
    for (const auto& [x, y] : {std::array{0, 0}, std::array{50, 31}, std::array{111, 79}}) {
        const PixelStory story = player.taa.story(g, x, y);
        StoryColour low{65535, 65535, 65535}, high{};
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, 79); ++j) {
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, 111); ++i) {
                for (int c = 0; c < 3; ++c) {
                    low[size_t(c)] = std::min<int>(low[size_t(c)], player.sample(c).at(i, j));
                    high[size_t(c)] = std::max<int>(high[size_t(c)], player.sample(c).at(i, j));
                }
            }
        }
        CHECK(story.box_rgb.low == low);
        CHECK(story.box_rgb.high == high);
        CHECK(story.window[4] == story.raw);
        CHECK(lows.at(x, y) == low);
        CHECK(middles.at(x, y) == story.box_rgb.middle);
        CHECK(highs.at(x, y) == high);
    }
}
