#pragma once
// A small picture of one flat surface that tests of the laboratory draw into.

#include <algorithm>
#include <bit>

#include "postfx/laboratory.h"
#include "rasterizer/fixed.h"

namespace lab_bench {

using namespace still;

inline constexpr int kWidth = 24, kHeight = 20;

/// Alpha 0.25, everything else off: tests switch on what they look at.
inline TaaPolicy plain() {
    TaaPolicy p;
    p.method = Method::recursive;
    p.alpha_q15 = 8192;
    p.dilation = Dilation::centre;
    p.history = HistoryFilter::bilinear;
    p.rectification = Rectification::off;
    p.space = ColourSpace::rgb;
    return p;
}

/// A picture of one flat surface that tests draw into.
struct Bench {
    GBuffer gbuffer;
    Laboratory laboratory;
    Workers workers{1, Schedule::serial};

    explicit Bench(int grey = 1000) {
        gbuffer.resize(kWidth, kHeight, {.normal = true, .motion = true});
        fill(grey);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                gbuffer.id.at(x, y) = 1;
                gbuffer.motion.at(x, y) = {};
            }
        }
        setDepth(0.25f);
        setNormal(0, 0);
    }

    void fill(int grey) { fill(grey, grey, grey); }
    void fill(int red, int green, int blue) {
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                set(x, y, red, green, blue);
            }
        }
    }
    void set(int x, int y, int red, int green, int blue) {
        gbuffer.red.at(x, y) = uint16_t(red);
        gbuffer.green.at(x, y) = uint16_t(green);
        gbuffer.blue.at(x, y) = uint16_t(blue);
    }
    void setDepth(float depth, float before = 0) {
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                gbuffer.depth.at(x, y) = std::bit_cast<uint32_t>(depth);
                gbuffer.depth_before.at(x, y) =
                    logDepth16(std::bit_cast<uint32_t>(before > 0 ? before : depth));
            }
        }
    }
    void setNormal(int x, int y) {
        for (int row = 0; row < kHeight; ++row) {
            std::fill_n(gbuffer.normal.view().row(row), kWidth,
                        (uint32_t(x) & 0xFFFF) | uint32_t(y) << 16);
        }
    }
    void setMotion(int x_fx8, int y_fx8) {
        for (int y = 0; y < kHeight; ++y) {
            std::fill_n(gbuffer.motion.view().row(y), kWidth,
                        Motion{int16_t(x_fx8), int16_t(y_fx8)});
        }
    }
    void setId(int id) {
        for (int y = 0; y < kHeight; ++y) {
            std::fill_n(gbuffer.id.view().row(y), kWidth, uint16_t(id));
        }
    }

    void show(const TaaPolicy& policy, bool reset = false) {
        laboratory.resolve(gbuffer, {.reset = reset}, policy, bestSimdTarget(), workers);
    }
    int red(int x = 10, int y = 10) const { return laboratory.colour().red.at(x, y); }
    int green(int x = 10, int y = 10) const { return laboratory.colour().green.at(x, y); }
    int blue(int x = 10, int y = 10) const { return laboratory.colour().blue.at(x, y); }
    int confidence(int x = 10, int y = 10) const { return laboratory.confidence().at(x, y); }
};

}  // namespace lab_bench
