// The same as upscale_sums_reference.cpp, with what rows and columns share computed once for a
// tile. Most output pixels get no sample in a frame, so a row costs a count of its frames and the
// few pixels that do; there is little for lanes to do side by side.

#include "postfx/internal/upscale_sums.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace still::upscale {
namespace {

constexpr int kMostOutputs = kMaxUpscale * kTileSize + kMaxUpscale;

/// An output pixel of a row that gets a sample, and the frame's pixel that it comes from.
struct Hit {
    int32_t output = 0;  ///< from the tile's first
    int32_t pixel = 0;   ///< from the frame's pixel left of the tile
};

/// What an axis' output pixels of a tile have to do with the frame.
struct Span {
    int first = 0, count = 0;                 ///< output pixels
    int origin = 0;                           ///< the frame's pixel before the tile
    std::array<uint8_t, kMostOutputs> under;  ///< pixelUnder(), from the tile's first
    std::array<Hit, kTileSize + 2> hits;
    int hit_count = 0;

    Span(const Axis& axis, int begin, int end, int tile_begin, int tile_end, int jitter_fx8)
        : first(begin), count(end - begin), origin(tile_begin - 1) {
        for (int i = 0; i < count; ++i) {
            under[size_t(i)] = uint8_t(pixelUnder(axis, first + i) - tile_begin);
        }
        for (int pixel = std::max(origin, 0); pixel < std::min(tile_end + 1, axis.frame); ++pixel) {
            const int output = axis.outputOf(pixel, jitter_fx8) - first;
            if (output >= 0 && output < count) {
                hits[size_t(hit_count++)] = {output, pixel - origin};
            }
        }
    }
};

/// floor(2^44 / n) + 1. Sums of up to 4096 samples divided by their number are exact with it: (2^28
/// + 2^11) · 2^12 < 2^44, so that what it is too large by never reaches a whole one; and (2^28 +
/// 2^11) · 2^33 < 2^64 from n = 2^11 on, n · 2^16 · 2^45 / n < 2^64 before.
constexpr int kMostSamples = 4096, kReciprocalShift = 44;
constexpr std::array<uint64_t, kMostSamples + 1> makeReciprocals() {
    std::array<uint64_t, kMostSamples + 1> table{};
    for (size_t n = 1; n < table.size(); ++n) {
        table[n] = (uint64_t{1} << kReciprocalShift) / n + 1;
    }
    return table;
}
constexpr auto kReciprocals = makeReciprocals();

struct Tile {
    const Sums sums;
    const uint16_t* const samples[3];
    uint16_t* const shown[3];
    uint8_t* const shown_count;
    const int sample_cap, settled;
    const Span columns;
    SumsResult result;

    /// Adds a row's samples to pixels that are not full; `moved`: but not to these, or null.
    void addRow(ptrdiff_t at, ptrdiff_t from, const bool* moved) {
        for (int i = 0; i < columns.hit_count; ++i) {
            const Hit hit = columns.hits[size_t(i)];
            const ptrdiff_t to = at + hit.output;
            if (sums.frames[to] >= sample_cap || (moved != nullptr && moved[hit.output])) {
                continue;
            }
            const uint32_t count = sums.count[to] + 1u;
            const uint32_t past = count == 1 ? 0 : ~uint32_t{0};
            const uint64_t reciprocal = kReciprocals[count];
            const bool shows = int(count) >= settled;
            for (int c = 0; c < 3; ++c) {
                const uint32_t sum = (sums.colour[c][to] & past) + samples[c][from + hit.pixel];
                sums.colour[c][to] = sum;
                if (shows) {
                    shown[c][to] = uint16_t(((sum + count / 2) * reciprocal) >> kReciprocalShift);
                }
            }
            sums.count[to] = uint16_t(count);
            shown_count[to] = shows ? uint8_t(std::min(count, 255u)) : shown_count[to];
            result.changed = true;
        }
    }

    void forgetRow(ptrdiff_t at) {
        std::memset(sums.frames + at, 0, size_t(columns.count) * sizeof(uint16_t));
        std::memset(sums.count + at, 0, size_t(columns.count) * sizeof(uint16_t));
    }

    /// Nothing happens in the row. `from`: the frame's row of samples for it, at the pixel before
    /// the tile; −1: none.
    void growRow(ptrdiff_t at, ptrdiff_t from, bool has_samples) {
        if (has_samples) {
            addRow(at, from, nullptr);
        }
        uint16_t* __restrict frames = sums.frames + at;
        const uint16_t cap = uint16_t(sample_cap);
        for (int i = 0; i < columns.count; ++i) {
            frames[i] = uint16_t(frames[i] + uint16_t(frames[i] < cap));
        }
    }

    /// Pixels that are disturbed lose their sums; those that moved also this frame's sample.
    void growDisturbedRow(ptrdiff_t at, ptrdiff_t from, bool has_samples,
                          const uint8_t* disturbed) {
        std::array<bool, kMostOutputs> moved{};
        for (int i = 0; i < columns.count; ++i) {
            const uint8_t disturbance = disturbed[columns.under[size_t(i)]];
            uint16_t& frames = sums.frames[at + i];
            if (disturbance != 0) {
                result.changed |= frames != 0;
                frames = 0;
                sums.count[at + i] = 0;
            }
            moved[size_t(i)] = disturbance == taa::kMoved;
        }
        if (has_samples) {
            addRow(at, from, moved.data());
        }
        for (int i = 0; i < columns.count; ++i) {
            uint16_t& frames = sums.frames[at + i];
            frames = uint16_t(frames + (frames < sample_cap && !moved[size_t(i)] ? 1 : 0));
        }
    }

    void judgeRow(ptrdiff_t at) {
        const uint16_t *frames = sums.frames + at, *counts = sums.count + at;
        uint16_t least_frames = 65535, least_count = 65535;
        for (int i = 0; i < columns.count; ++i) {
            least_frames = std::min(least_frames, frames[i]);
            least_count = std::min(least_count, counts[i]);
        }
        result.finished &= least_frames >= sample_cap;
        result.settled &= least_count >= settled;
    }
};

}  // namespace

SumsResult accumulateTile(const Job& job, const TileRect& tile, Stillness stillness,
                          bool restart) noexcept {
    if (job.frame.light_age != nullptr && stillness == Stillness::tested) {
        return accumulateTileReference(job, tile, stillness, restart);  // seldom
    }
    const TileRect out = outputRect(job, tile);
    const taa::SlotOut& record = job.frame.record;
    const auto& now = job.frame.now.colour;
    Tile sums{job.sums,
              {now[0], now[1], now[2]},
              {job.shown[0], job.shown[1], job.shown[2]},
              job.shown_count,
              job.sample_cap,
              job.settled,
              Span(job.x, out.x0, out.x1, tile.x0, tile.x1, record.jitter_x_fx8),
              {}};
    const Span rows(job.y, out.y0, out.y1, tile.y0, tile.y1, record.jitter_y_fx8);
    std::array<uint8_t, kTileSize> disturbed;
    int next_hit = 0, tested = -1;
    bool any = false;
    for (int i = 0; i < rows.count; ++i) {
        const ptrdiff_t at = (rows.first + i) * job.stride + out.x0;
        const Hit& hit = rows.hits[size_t(next_hit)];
        const bool has_samples = next_hit < rows.hit_count && hit.output == i;
        const ptrdiff_t from =
            has_samples ? (rows.origin + hit.pixel) * job.frame.stride + sums.columns.origin : 0;
        next_hit += has_samples ? 1 : 0;
        if (stillness == Stillness::tested && rows.under[size_t(i)] != tested) {
            tested = rows.under[size_t(i)];
            any = taa::disturbedRow(job.frame, tile, tile.y0 + tested, disturbed.data());
        }
        if (restart) {
            sums.forgetRow(at);
        }
        if (any) {
            sums.growDisturbedRow(at, from, has_samples, disturbed.data());
        } else {
            sums.growRow(at, from, has_samples);
        }
        sums.judgeRow(at);
    }
    return sums.result;
}

}  // namespace still::upscale
