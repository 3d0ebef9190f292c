#include "postfx/laboratory.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "postfx/internal/lab_job.h"
#include "postfx/internal/lab_kernels.h"
#include "postfx/internal/lab_pixel.h"
#include "postfx/internal/lab_presets.h"
#include "postfx/internal/lab_rules.h"
#include "postfx/internal/lab_weights.h"
#include "postfx/limits.h"

namespace still {
namespace {

constexpr int kStoryRows = 4, kShownRows = 16;

using lab::HistoryIn;
using lab::HistoryOut;
using lab::ResolveJob;
using lab::TileRect;

struct HistoryPlanes {
    std::array<Image<uint32_t>, 3> colour_w24;
    Image<uint8_t> memory;
    Image<uint16_t> depth, surface, normal;
    Image<Motion> motion;

    /// Planes that the policy does not read have no size.
    void resize(int width, int height, const TaaPolicy& policy) {
        const auto fit = [&](auto& plane, bool needed) {
            plane.resize(needed ? width + lab::kLeftColumns + lab::kRightColumns : 0,
                         needed ? height + 2 * lab::kMargin : 0);
        };
        for (auto& plane : colour_w24) {
            fit(plane, true);
        }
        fit(memory, lab::needsMemory(policy));
        fit(depth, lab::needsDepth(policy));
        fit(surface, policy.id_reject);
        fit(normal, lab::needsNormal(policy));
        fit(motion, lab::needsMotion(policy));
    }

    HistoryOut pointers() {
        const auto first = [](auto& plane) {
            return plane.empty() ? nullptr : &plane.at(lab::kLeftColumns, lab::kMargin);
        };
        HistoryOut p;
        for (size_t c = 0; c < 3; ++c) {
            p.colour_w24[c] = first(colour_w24[c]);
        }
        p.memory = first(memory);
        p.depth = first(depth);
        p.surface = first(surface);
        p.normal = first(normal);
        p.motion = first(motion);
        return p;
    }
};

HistoryIn readOnly(const HistoryOut& p) {
    return {{p.colour_w24[0], p.colour_w24[1], p.colour_w24[2]},
            p.memory,
            p.depth,
            p.surface,
            p.normal,
            p.motion};
}

lab::FrameConstants makeConstants(const TaaPolicy& policy, const LaboratoryFrame& frame) {
    lab::FrameConstants k;
    const auto weights = lab::sampleWeights(policy.sample, frame.jitter_x_fx8, frame.jitter_y_fx8);
    std::copy(weights.begin(), weights.end(), k.sample_weight_q12);
    k.sigma_q12 = lab::sigmaFactor(policy.sigma_fx8);
    k.sigma_still_q12 = lab::sigmaFactor(policy.sigma_still_fx8);
    k.speed_limit_fx8 = policy.sigma_speed * 256;
    k.inverse_speed = (1u << 24) / uint32_t(k.speed_limit_fx8);
    const auto cosine = uint32_t(policy.normal_reject_q15);
    k.normal_square_q15 = (cosine * cosine + 16384) >> 15;
    const auto last = uint32_t(std::max(policy.count_cap - 1, 1));
    k.count_share_q16 = (255 * 65536 + last - 1) / last;
    return k;
}

lab::Current currentPlanes(const GBuffer& gbuffer) {
    lab::Current now;
    now.colour[0] = gbuffer.red.view().data;
    now.colour[1] = gbuffer.green.view().data;
    now.colour[2] = gbuffer.blue.view().data;
    now.depth = gbuffer.depth.view().data;
    now.id = gbuffer.id.view().data;
    now.normal = gbuffer.planes.normal ? gbuffer.normal.view().data : nullptr;
    now.motion = gbuffer.motion.view().data;
    now.depth_before = gbuffer.depth_before.view().data;
    return now;
}

}  // namespace

struct Laboratory::State {
    int width = 0, height = 0;
    std::array<HistoryPlanes, 2> history;
    int written = 0;  ///< index of the planes written last
    std::array<Image<uint16_t>, 3> shown;
    Image<uint8_t> confidence;
    TaaPolicy policy;
    bool has_history = false;
    LaboratoryFrame frame;     ///< resolved last …
    bool had_history = false;  ///< … on top of a past

    void adapt(int new_width, int new_height, const TaaPolicy& wanted) {
        const TaaPolicy part = lab::resolvePart(wanted);
        if (width == new_width && height == new_height && part == policy) {
            return;
        }
        width = new_width;
        height = new_height;
        policy = part;
        has_history = false;
        if (!lab::kShowsOverPast) {
            for (auto& plane : shown) {
                plane.resize(width, height);
            }
            confidence.resize(width, height);
        }
        for (HistoryPlanes& planes : history) {
            planes.resize(width, height, policy);
        }
    }

    /// The image over the past: two bytes a pixel from the first pixel of each row.
    ImageView<uint16_t> placeOverPast(size_t c) {
        uint32_t* const first = history[size_t(1 - written)].pointers().colour_w24[c];
        return {reinterpret_cast<uint16_t*>(first), width, height,
                history[0].colour_w24[c].view().stride * 2};
    }
    /// After all tiles.
    void showOverPast(Workers& workers);

    /// On top of the planes `past`, into the others.
    ResolveJob makeJob(const GBuffer& gbuffer, int past) {
        ResolveJob job;
        job.width = width;
        job.height = height;
        job.stride = gbuffer.red.view().stride;
        job.history_stride = history[0].colour_w24[0].view().stride;
        job.now = currentPlanes(gbuffer);
        job.before = readOnly(history[size_t(past)].pointers());
        job.next = history[size_t(1 - past)].pointers();
        for (size_t c = 0; c < 3; ++c) {
            job.shown[c] = lab::kShowsOverPast ? nullptr : shown[c].view().data;
        }
        job.confidence = lab::kShowsOverPast ? nullptr : confidence.view().data;
        job.policy = policy;
        job.constants = makeConstants(policy, frame);
        job.has_history = had_history;
        return job;
    }

    TileRect rectOf(int tile, int tiles_x) const {
        const int x0 = tile % tiles_x * kTileSize, y0 = tile / tiles_x * kTileSize;
        return {x0, y0, std::min(x0 + kTileSize, width), std::min(y0 + kTileSize, height)};
    }
};

void Laboratory::State::showOverPast(Workers& workers) {
    const HistoryOut resolved = history[size_t(written)].pointers();
    const ptrdiff_t stride = history[0].colour_w24[0].view().stride;
    const ImageView<uint16_t> out[3] = {placeOverPast(0), placeOverPast(1), placeOverPast(2)};
    workers.parallelFor(height, kShownRows, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < width; ++x) {
                lab::Rgb colour_w24;
                for (int c = 0; c < 3; ++c) {
                    colour_w24.v[c] = int32_t(resolved.colour_w24[c][y * stride + x]);
                }
                const lab::Rgb linear = lab::linearOf(policy, lab::rounded(colour_w24));
                for (int c = 0; c < 3; ++c) {
                    out[c].row(y)[x] = uint16_t(linear.v[c]);
                }
            }
        }
    });
}

Laboratory::Laboratory() : state_(std::make_unique<State>()) {}
Laboratory::~Laboratory() = default;
Laboratory::Laboratory(Laboratory&&) noexcept = default;
Laboratory& Laboratory::operator=(Laboratory&&) noexcept = default;

void Laboratory::reserve(int width, int height, const TaaPolicy& policy) {
    static_assert(sizeof(State) <= lab::kStateBytes);
    state_->adapt(width, height, policy);
}

void Laboratory::resolve(const GBuffer& gbuffer, const LaboratoryFrame& frame,
                         const TaaPolicy& policy, SimdTarget simd, Workers& workers) {
    assert(policy.method == Method::recursive);
    assert(gbuffer.planes.motion);
    assert(!lab::needsNormal(policy) || gbuffer.planes.normal);
    State& s = *state_;
    s.adapt(gbuffer.width(), gbuffer.height(), policy);
    s.frame = frame;
    s.had_history = s.has_history && !frame.reset;
    const ResolveJob job = s.makeJob(gbuffer, s.written);
    const lab::TileKernel kernel = lab::tileKernel(simd, s.policy);
    workers.parallelFor(int(gbuffer.tiles.size()), 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) {
            kernel(job, s.rectOf(tile, gbuffer.tiles_x));
        }
    });
    s.written = 1 - s.written;
    s.has_history = true;
    if constexpr (lab::kShowsOverPast) {
        s.showOverPast(workers);
    }
}

ColourPlanes Laboratory::colour() const {
    State& s = *state_;
    if constexpr (lab::kShowsOverPast) {
        return {s.placeOverPast(0), s.placeOverPast(1), s.placeOverPast(2)};
    }
    return {std::as_const(s.shown[0]).view(), std::as_const(s.shown[1]).view(),
            std::as_const(s.shown[2]).view()};
}

#if !STILL_BOARD

// The frame's past is in the planes that the next frame will write.
PixelStory Laboratory::story(const GBuffer& gbuffer, int x, int y) const {
    State& s = *state_;
    return lab::tellPixel(s.makeJob(gbuffer, 1 - s.written), s.frame.jitter_x_fx8,
                          s.frame.jitter_y_fx8, x, y);
}

void Laboratory::storyPlane(const GBuffer& gbuffer, StoryPlane plane, ColourTargets out,
                            Workers& workers) const {
    const ResolveJob job = state_->makeJob(gbuffer, 1 - state_->written);
    workers.parallelFor(job.height, kStoryRows, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            uint16_t* const rows[3] = {out.red.row(y), out.green.row(y), out.blue.row(y)};
            lab::tellRow(job, plane, y, rows);
        }
    });
}

void Laboratory::rejections(const GBuffer& gbuffer, const RejectionTargets& out,
                            Workers& workers) const {
    const ResolveJob job = state_->makeJob(gbuffer, 1 - state_->written);
    workers.parallelFor(job.height, kStoryRows, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            lab::tellRejections(job, y, out.reason.row(y), out.lost.row(y));
        }
    });
}

ImageView<const uint8_t> Laboratory::confidence() const {
    return state_->confidence.view();
}

#endif

}  // namespace still
