// What the resolve promises, on flat worlds whose right answer is known.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "postfx/taa.h"
#include "synthetic.h"

namespace {

using namespace still;
using synthetic::Colour;
using synthetic::Layer;
using synthetic::Point;
using synthetic::Pose;
using synthetic::World;

Colour texture(Point p) {
    return int(std::floor(p.y / 24)) % 2 != 0 ? synthetic::noise(p, 4) : synthetic::checker(p, 6.3);
}

Layer backdrop() {
    Layer layer;
    layer.surface = 1;
    layer.colour = texture;
    return layer;
}

Layer square(double side, std::function<Pose(int)> pose) {
    Layer layer;
    layer.surface = 2;
    layer.depth = 0.3;
    layer.pose = std::move(pose);
    layer.covers = [side](Point p) { return std::abs(p.x) < side && std::abs(p.y) < side; };
    layer.colour = [](Point) { return Colour{0.9, 0.1, 0.05}; };
    return layer;
}

World panning(double x, double y) {
    World world{112, 80, true, {backdrop()}};
    world.layers[0].pose = [=](int frame) { return Pose{{x * frame, y * frame}}; };
    return world;
}

World stillLife() {
    return {70, 66, false, {backdrop(), square(14, [](int) { return Pose{{30.3, 33.6}, 0.4}; })}};
}

struct Sequence {
    Workers workers{1};
    Taa taa;
    GBuffer gbuffer;

    void show(const World& world, int frame, bool reset, bool shading_changed = false) {
        synthetic::render(world, frame, gbuffer);
        taa.resolve(gbuffer, {.reset = reset, .shading_changed = shading_changed}, {}, workers);
    }
    double error(const std::vector<Colour>& wanted) const {
        const ColourPlanes c = taa.colour();
        return synthetic::psnr(c.red, c.green, c.blue, wanted, 10);
    }
    double rawError(const std::vector<Colour>& wanted) const {
        return synthetic::psnr(gbuffer.red.view(), gbuffer.green.view(), gbuffer.blue.view(),
                               wanted, 10);
    }
};

std::vector<uint16_t> copyOf(ImageView<const uint16_t> plane) {
    std::vector<uint16_t> pixels;
    for (int y = 0; y < plane.height; ++y) {
        pixels.insert(pixels.end(), plane.row(y), plane.row(y) + plane.width);
    }
    return pixels;
}

int pixelsWithCount(const Taa& taa, int count) {
    int n = 0;
    const ImageView<const uint8_t> plane = taa.sampleCount();
    for (int y = 0; y < plane.height; ++y) {
        n += int(std::count(plane.row(y), plane.row(y) + plane.width, uint8_t(count)));
    }
    return n;
}

bool showsRaw(const Sequence& s) {
    return copyOf(s.taa.colour().red) == copyOf(s.gbuffer.red.view()) &&
           copyOf(s.taa.colour().blue) == copyOf(s.gbuffer.blue.view());
}

}  // namespace

TEST_CASE("taa: a still scene becomes the exact integer mean of its samples, then freezes",
          "[postfx][unit]") {
    const World world = stillLife();
    Sequence s;
    std::vector<uint64_t> sum(size_t(world.width * world.height));
    for (int frame = 0; frame < 64; ++frame) {
        s.show(world, frame, frame == 0);
        CHECK_FALSE(s.taa.converged());
        const std::vector<uint16_t> sample = copyOf(s.gbuffer.red.view());
        const std::vector<uint16_t> mean = copyOf(s.taa.colour().red);
        const auto n = uint64_t(frame + 1);
        int wrong = 0;
        for (size_t i = 0; i < sum.size(); ++i) {
            sum[i] += sample[i];
            wrong += mean[i] == (2 * sum[i] + n) / (2 * n) ? 0 : 1;
        }
        CHECK(wrong == 0);
    }
    const std::vector<uint16_t> finished = copyOf(s.taa.colour().red);
    for (int frame = 64; frame < 64 + 70; ++frame) {
        s.show(world, frame, false);
        CHECK(s.taa.converged());
        REQUIRE(copyOf(s.taa.colour().red) == finished);
    }
    CHECK(pixelsWithCount(s.taa, 64) == world.width * world.height);
}

TEST_CASE("taa: the error of a still scene falls with every doubling of frames", "[postfx][unit]") {
    const World world = stillLife();
    const std::vector<Colour> wanted = synthetic::reference(world, 0, 16);
    Sequence s;
    double last = 0;
    for (int frame = 0; frame < 64; ++frame) {
        s.show(world, frame, frame == 0);
        if (frame == 0 || frame == 3 || frame == 15 || frame == 63) {
            const double now = s.error(wanted);
            INFO("frame " << frame << ": " << now << " dB, before " << last << " dB");
            CHECK(now > last + 3);
            last = now;
        }
    }
    CHECK(last > 40);
}

TEST_CASE("taa: panning, turning and zooming pictures gain over raw frames", "[postfx][unit]") {
    struct Case {
        const char* name;
        World world;
        double gain_db;
    };
    World turning = panning(0, 0), zooming = panning(0, 0);
    turning.layers[0].pose = [](int f) { return Pose{{56, 40}, 0.005 * f}; };
    zooming.layers[0].pose = [](int f) { return Pose{{56, 40}, 0, std::pow(1.004, f)}; };
    const Case cases[] = {{"whole pixels", panning(1, 0), 15},
                          {"half pixels", panning(0.5, 0), 7},
                          {"both halves", panning(0.5, 0.5), 5},
                          {"slow", panning(0.0625, 0), 9},
                          {"odd", panning(0.8125, 0.40625), 5},
                          {"turning", turning, 7},
                          {"zooming", zooming, 7}};
    for (const Case& c : cases) {
        Sequence s;
        for (int frame = 0; frame < 32; ++frame) {
            s.show(c.world, frame, frame == 0);
        }
        const std::vector<Colour> wanted = synthetic::reference(c.world, 31, 8);
        INFO(c.name << ": raw " << s.rawError(wanted) << " dB, resolved " << s.error(wanted));
        CHECK(s.error(wanted) > s.rawError(wanted) + c.gain_db);
    }
}

TEST_CASE("taa: a moving square leaves no ghost on what it uncovers", "[postfx][unit]") {
    for (const Point speed : {Point{1, 0}, Point{2.3, 1.1}, Point{7.5, -3}, Point{0.3, 0.2}}) {
        const auto pose = [=](int f) { return Pose{{40 + speed.x * f, 40 + speed.y * f}}; };
        World world{140, 90, false, {backdrop(), square(12, pose)}};
        world.layers[0].colour = [](Point) { return Colour{0.2, 0.4, 0.6}; };
        world.layers[1].moves = true;
        Sequence s;
        int ghosts = 0;
        for (int frame = 0; frame < 12; ++frame) {
            s.show(world, frame, frame == 0);
            const Point centre = pose(frame).offset;
            for (int y = 0; y < world.height; ++y) {
                for (int x = 0; x < world.width; ++x) {
                    const bool clear =
                        std::max(std::abs(x - centre.x), std::abs(y - centre.y)) > 13.6;
                    ghosts += clear && s.taa.colour().red.at(x, y) != 819 ? 1 : 0;
                }
            }
        }
        INFO("speed " << speed.x << ", " << speed.y);
        CHECK(ghosts == 0);
    }
}

TEST_CASE("taa: reset, resize and the first frame show the bare samples", "[postfx][unit]") {
    Sequence s;
    World world = stillLife();
    s.show(world, 0, false);
    CHECK(showsRaw(s));
    s.show(world, 1, false);
    CHECK_FALSE(showsRaw(s));
    s.show(world, 2, true);
    CHECK(showsRaw(s));
    CHECK(pixelsWithCount(s.taa, 1) == world.width * world.height);
    world.width = 131;
    s.show(world, 3, false);
    CHECK(showsRaw(s));
    CHECK(s.taa.colour().red.width == 131);
    s.show(world, 4, false);
    CHECK(pixelsWithCount(s.taa, 2) == world.width * world.height);
}

TEST_CASE("taa: what comes in from outside the picture starts with its own sample",
          "[postfx][unit]") {
    Sequence s;
    const World world = panning(-6, 0);  // the right edge shows six new columns in each frame
    for (int frame = 0; frame < 5; ++frame) {
        s.show(world, frame, frame == 0);
    }
    int wrong = 0;
    for (int y = 0; y < world.height; ++y) {
        for (int x = 0; x < world.width; ++x) {
            const bool fresh = x >= world.width - 6;
            const int wanted = fresh ? 1 : std::min(5, 1 + (world.width - 1 - x) / 6);
            wrong += s.taa.sampleCount().at(x, y) == wanted ? 0 : 1;
            wrong += fresh && s.taa.colour().green.at(x, y) != s.gbuffer.green.at(x, y) ? 1 : 0;
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("taa: a step of the light is followed at once when it is announced", "[postfx][unit]") {
    World world{64, 64, false, {backdrop()}};
    Sequence s;
    for (int frame = 0; frame < 20; ++frame) {
        const double light = frame < 10 ? 0.25 : 0.75;
        world.layers[0].colour = [=](Point) { return Colour{light, light, light}; };
        s.show(world, frame, frame == 0, frame == 10);
    }
    CHECK(s.taa.colour().red.at(30, 30) == 3072);
}

TEST_CASE("taa: an object that comes to rest is refined to the exact mean like everything else",
          "[postfx][unit]") {
    const auto pose = [](int f) { return Pose{{30 + 2.5 * std::min(f, 6), 40}}; };
    World world{100, 80, false, {backdrop(), square(12, pose)}};
    world.layers[1].moves = true;
    Sequence s;
    for (int frame = 0; frame < 7 + 128; ++frame) {
        s.show(world, frame, frame == 0);
    }
    CHECK(s.taa.converged());
    CHECK(s.error(synthetic::reference(world, 6, 16)) > 38);
}
