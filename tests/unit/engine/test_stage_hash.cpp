#include <catch2/catch.hpp>

#include "engine/stage_hash.h"
#include "tests/support/test_scene.h"

using namespace still;

namespace {

constexpr int kWidth = 150, kHeight = 70;  // 3 × 2 tiles, the last ones cut

/// A frame whose planes are filled with numbers.
struct Planes {
    GBuffer gbuffer;
    Image<uint16_t> red{kWidth, kHeight}, green{kWidth, kHeight}, blue{kWidth, kHeight};
    LightImages light, denoised;
    Image<Rgb8> output{kWidth, kHeight};

    Planes() {
        gbuffer.resize(kWidth, kHeight, test::kAllPlanes);
        light.resize(kWidth, kHeight);
        denoised.resize(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                gbuffer.depth.at(x, y) = uint32_t(x * y);
                gbuffer.red.at(x, y) = uint16_t(x + y);
                output.at(x, y) = {uint8_t(x), uint8_t(y), 7};
            }
        }
    }
    static LightPlanes planesOf(const LightImages& i) {
        return {{i.direct_red.view(), i.direct_green.view(), i.direct_blue.view()},
                {i.indirect_red.view(), i.indirect_green.view(), i.indirect_blue.view()}};
    }
    StageHashes hashes() const {
        FrameResult frame;
        frame.gbuffer = &gbuffer;
        frame.light = planesOf(light);
        frame.denoised = planesOf(denoised);
        frame.output = output.view();
        frame.linear = {red.view(), green.view(), blue.view()};
        return hashStages(frame);
    }
};

/// Flips one bit of one plane of `planes` at a pixel; which plane belongs to which stage.
struct Flip {
    Stage stage;
    void (*flip)(Planes& planes, int x, int y, int bit);
};
const Flip kFlips[] = {
    {Stage::depth, [](Planes& p, int x, int y, int bit) { p.gbuffer.depth.at(x, y) ^= 1u << bit; }},
    {Stage::id,
     [](Planes& p, int x, int y, int bit) { p.gbuffer.id.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::normal,
     [](Planes& p, int x, int y, int bit) { p.gbuffer.normal.at(x, y) ^= 1u << bit; }},
    {Stage::motion,
     [](Planes& p, int x, int y, int bit) {
         int16_t& axis =
             bit < 16 ? p.gbuffer.motion.at(x, y).x_fx8 : p.gbuffer.motion.at(x, y).y_fx8;
         axis = int16_t(axis ^ (1 << bit % 16));
     }},
    {Stage::motion, [](Planes& p, int x, int y,
                       int bit) { p.gbuffer.depth_before.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::albedo, [](Planes& p, int x, int y,
                       int bit) { p.gbuffer.albedo_green.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::light, [](Planes& p, int x, int y,
                      int bit) { p.light.indirect_red.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::denoised, [](Planes& p, int x, int y,
                         int bit) { p.denoised.direct_blue.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::color,
     [](Planes& p, int x, int y, int bit) { p.gbuffer.red.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::color,
     [](Planes& p, int x, int y, int bit) { p.gbuffer.green.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::color,
     [](Planes& p, int x, int y, int bit) { p.gbuffer.blue.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::linear,
     [](Planes& p, int x, int y, int bit) { p.red.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::linear,
     [](Planes& p, int x, int y, int bit) { p.green.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::linear,
     [](Planes& p, int x, int y, int bit) { p.blue.at(x, y) ^= uint16_t(1 << bit % 16); }},
    {Stage::output,
     [](Planes& p, int x, int y, int bit) { p.output.at(x, y).g ^= uint8_t(1 << bit % 8); }},
};

}  // namespace

TEST_CASE("stage hash: one bit in any plane names its stage and its tile, and nothing else",
          "[unit][hash]") {
    Planes planes;
    const StageHashes expected = planes.hashes();
    CHECK_FALSE(firstDifference(expected, planes.hashes()));
    test::Random random(5);
    for (const Flip& flip : kFlips) {
        for (int k = 0; k < 24; ++k) {
            const int x = random.integer(0, kWidth - 1), y = random.integer(0, kHeight - 1);
            const int bit = random.integer(0, 31);
            flip.flip(planes, x, y, bit);
            const auto difference = firstDifference(expected, planes.hashes());
            INFO(name(flip.stage) << " at " << x << ", " << y << ", bit " << bit);
            REQUIRE(difference);
            CHECK(difference->stage == flip.stage);
            CHECK(difference->tiles == std::vector<int>{y / kTileSize * 3 + x / kTileSize});
            flip.flip(planes, x, y, bit);
        }
    }
    CHECK_FALSE(firstDifference(expected, planes.hashes()));
}

TEST_CASE(
    "stage hash: of several stages the first one of the pipeline is named, with all its tiles",
    "[unit][hash]") {
    Planes planes;
    const StageHashes expected = planes.hashes();
    planes.output.at(0, 0).r ^= 1;
    planes.gbuffer.normal.at(149, 69) ^= 1;
    planes.gbuffer.normal.at(64, 0) ^= 1;
    planes.gbuffer.red.at(3, 3) ^= 1;
    const auto difference = firstDifference(expected, planes.hashes());
    REQUIRE(difference);
    CHECK(difference->stage == Stage::normal);
    CHECK(difference->tiles == std::vector<int>{1, 5});
}

TEST_CASE("stage hash: planes that are not there have no tiles", "[unit][hash]") {
    Planes planes;
    planes.gbuffer.resize(kWidth, kHeight, {});
    const StageHashes hashes = planes.hashes();
    CHECK(hashes[size_t(Stage::normal)] == StageHash{});
    CHECK(hashes[size_t(Stage::motion)] == StageHash{});
    CHECK(hashes[size_t(Stage::depth)].tiles.size() == 6);
}
