// Histories that are moved to another place between frames.

#include <catch2/catch.hpp>
#include <vector>

#include "postfx/laboratory.h"
#include "postfx/upscale.h"
#include "random_frames.h"
#include "rasterizer/workers.h"

using namespace still;
using random_frames::Film;

namespace {

constexpr int kWidth = 75, kHeight = 70, kFrames = 20;

void append(std::vector<uint16_t>& bytes, const ColourPlanes& picture) {
    for (const auto* plane : {&picture.red, &picture.green, &picture.blue}) {
        for (int y = 0; y < plane->height; ++y) {
            bytes.insert(bytes.end(), plane->row(y), plane->row(y) + plane->width);
        }
    }
}

/// All pictures of a film, made by a History that moves before every third frame, or never.
template <class History, class Resolve>
std::vector<uint16_t> pictures(bool moves, const Resolve& resolve) {
    Film film(kWidth, kHeight, true, 3);
    GBuffer gbuffer;
    Workers workers(1, Schedule::serial);
    History history;
    std::vector<uint16_t> bytes;
    for (int frame = 0; frame < kFrames; ++frame) {
        TaaFrame facts = film.next(gbuffer);
        facts.reset |= frame == 0;
        if (moves && frame % 3 == 2) {
            History elsewhere(std::move(history));
            History used;
            resolve(used, gbuffer, facts, workers);
            used = std::move(elsewhere);
            history = std::move(used);
        }
        resolve(history, gbuffer, facts, workers);
        append(bytes, history.colour());
    }
    return bytes;
}

template <class History, class Resolve>
void checkMoves(const Resolve& resolve) {
    CHECK(pictures<History>(true, resolve) == pictures<History>(false, resolve));
}

}  // namespace

TEST_CASE("moves: a history goes on wherever it is moved", "[moves]") {
    checkMoves<Taa>([](Taa& taa, const GBuffer& g, const TaaFrame& frame, Workers& workers) {
        taa.resolve(g, frame, {}, workers);
    });
    checkMoves<Laboratory>(
        [](Laboratory& lab, const GBuffer& g, const TaaFrame& frame, Workers& workers) {
            lab.resolve(g, {frame.reset, frame.jitter_x_fx8, frame.jitter_y_fx8},
                        findPreset("variance")->policy, bestSimdTarget(), workers);
        });
    checkMoves<TemporalUpscaler>(
        [](TemporalUpscaler& upscaler, const GBuffer& g, const TaaFrame& frame, Workers& workers) {
            upscaler.resolve(g, frame, {.width = 2 * kWidth, .height = 2 * kHeight}, workers);
        });
}
