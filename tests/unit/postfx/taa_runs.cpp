#include "taa_runs.h"

#include <cmath>
#include <utility>

namespace taa_runs {

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

Layer square(double half_side, std::function<Pose(int)> pose) {
    Layer layer;
    layer.surface = 2;
    layer.depth = 0.3;
    layer.pose = std::move(pose);
    layer.covers = [=](Point p) { return std::abs(p.x) < half_side && std::abs(p.y) < half_side; };
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

void Player::show(const World& world, int frame, TaaFrame facts) {
    const auto [jitter_x, jitter_y] = synthetic::jitter(frame);
    synthetic::render(world, frame, gbuffer, with_normals);
    facts.reset |= frame == 0;
    facts.jitter_x_fx8 = jitter_x;
    facts.jitter_y_fx8 = jitter_y;
    taa.resolve(gbuffer, facts, settings, workers);
}

void Player::play(const World& world, int first, int last) {
    for (int frame = first; frame <= last; ++frame) {
        show(world, frame);
    }
}

ImageView<const uint16_t> Player::channel(int c) const {
    const ColourPlanes planes = taa.colour();
    return c == 0 ? planes.red : (c == 1 ? planes.green : planes.blue);
}

ImageView<const uint16_t> Player::sample(int c) const {
    return c == 0 ? gbuffer.red.view() : (c == 1 ? gbuffer.green.view() : gbuffer.blue.view());
}

double Player::error(const std::vector<Colour>& wanted) const {
    return synthetic::psnr(channel(0), channel(1), channel(2), wanted, 10);
}

double Player::rawError(const std::vector<Colour>& wanted) const {
    return synthetic::psnr(sample(0), sample(1), sample(2), wanted, 10);
}

std::vector<uint16_t> copyOf(ImageView<const uint16_t> plane) {
    std::vector<uint16_t> pixels;
    for (int y = 0; y < plane.height; ++y) {
        pixels.insert(pixels.end(), plane.row(y), plane.row(y) + plane.width);
    }
    return pixels;
}

std::vector<uint16_t> everything(const Taa& taa) {
    std::vector<uint16_t> seen;
    for (const ImageView<const uint16_t>& plane :
         {taa.colour().red, taa.colour().green, taa.colour().blue}) {
        const std::vector<uint16_t> pixels = copyOf(plane);
        seen.insert(seen.end(), pixels.begin(), pixels.end());
    }
    const ImageView<const uint8_t> count = taa.sampleCount();
    for (int y = 0; y < count.height; ++y) {
        seen.insert(seen.end(), count.row(y), count.row(y) + count.width);
    }
    return seen;
}

int differences(const Player& a, const Player& b, const std::function<bool(int, int)>& counts) {
    int n = 0;
    for (int y = 0; y < a.gbuffer.height(); ++y) {
        for (int x = 0; x < a.gbuffer.width(); ++x) {
            if (!counts(x, y)) {
                continue;
            }
            bool differs = false;
            for (int c = 0; c < 3; ++c) {
                differs |= a.channel(c).at(x, y) != b.channel(c).at(x, y);
            }
            n += differs ? 1 : 0;
        }
    }
    return n;
}

void ExactSums::add(const Player& player) {
    size_t i = 0;
    for (int c = 0; c < 3; ++c) {
        for (const uint16_t sample : copyOf(player.sample(c))) {
            sums_[i] += sample;
            ++i;
        }
    }
    ++count_;
}

bool ExactSums::shown(const Player& player, int x, int y) const {
    const auto n = uint64_t(count_);
    bool right = true;
    for (int c = 0; c < 3; ++c) {
        const size_t plane = sums_.size() / 3 * size_t(c);
        const uint64_t sum = sums_[plane + size_t(y) * size_t(width_) + size_t(x)];
        right &= player.channel(c).at(x, y) == (2 * sum + n) / (2 * n);
    }
    return right;
}

int ExactSums::wrongPixels(const Player& player) const {
    int wrong = 0;
    for (int y = 0; y < player.gbuffer.height(); ++y) {
        for (int x = 0; x < width_; ++x) {
            wrong += shown(player, x, y) ? 0 : 1;
        }
    }
    return wrong;
}

}  // namespace taa_runs
