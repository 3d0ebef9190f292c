// The same as upscale_sums_reference.cpp, with what rows and columns share computed once for a
// tile, and rows in lanes where nothing happens.

#include "postfx/internal/upscale_sums.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace still::upscale {
namespace {

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
    std::array<Hit, kTileSize + 3> hits;
    int hit_count = 0;
    std::array<int32_t, kMostOutputs> pixel, next;  ///< see SumRow

    Span(const Axis& axis, int begin, int end, int tile_begin, int tile_end, int jitter_fx8)
        : first(begin), count(end - begin), origin(tile_begin - 1) {
        // Axis::outputOf() and pixelUnder(), with their remainders carried along instead of
        // divided.
        int64_t whole = 2 * int64_t(axis.image);
        int place = pixelUnder(axis, first);
        int64_t rest = (2 * int64_t(first) + 1) * axis.frame - whole * place;
        for (int i = 0; i < count; ++i) {
            under[size_t(i)] = uint8_t(place - tile_begin);
            rest += 2 * int64_t(axis.frame);
            place += rest >= whole ? 1 : 0;
            rest -= rest >= whole ? whole : 0;
        }
        const int begin_pixel = std::max(origin, 0);
        whole = 256 * int64_t(axis.frame);
        place = axis.outputOf(begin_pixel, jitter_fx8);
        rest = (256 * int64_t(begin_pixel) + 128 + jitter_fx8) * axis.image - whole * place;
        for (int p = begin_pixel; p < std::min(tile_end + 1, axis.frame); ++p) {
            if (place >= first && place < end) {
                hits[size_t(hit_count++)] = {place - first, p - origin};
            }
            rest += 256 * int64_t(axis.image);
            for (; rest >= whole; rest -= whole) {
                ++place;
            }
        }
    }

    void spread() {
        pixel.fill(-1);
        for (int i = 0; i < hit_count; ++i) {
            pixel[size_t(hits[size_t(i)].output)] = hits[size_t(i)].pixel;
        }
        int after = 0;
        for (size_t i = size_t(count); i-- > 0;) {
            after = pixel[i] >= 0 ? pixel[i] : after;
            next[i] = after;
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
    Span columns;
    SumKernels kernels;
    SumsResult result;

    /// Adds a row's samples to pixels that are not full; `moved`: but not to these, or null.
    /// From output pixel `begin` of the tile on.
    void addRow(ptrdiff_t at, ptrdiff_t from, const bool* moved, int begin = 0) {
        for (int i = 0; i < columns.hit_count; ++i) {
            const Hit hit = columns.hits[size_t(i)];
            if (hit.output < begin) {
                continue;
            }
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
            shown_count[to] = shows ? uint8_t(std::min<uint32_t>(count, 255)) : shown_count[to];
            result.changed = true;
        }
    }

    int addInLanes(ptrdiff_t at, ptrdiff_t from) {
        SumRow row{.colour = {sums.colour[0] + at, sums.colour[1] + at, sums.colour[2] + at},
                   .count = sums.count + at,
                   .frames = sums.frames + at,
                   .samples = {samples[0] + from, samples[1] + from, samples[2] + from},
                   .shown = {shown[0] + at, shown[1] + at, shown[2] + at},
                   .shown_count = shown_count + at,
                   .pixel = columns.pixel.data(),
                   .next = columns.next.data(),
                   .width = columns.count,
                   .sample_cap = sample_cap,
                   .settled = settled};
        const int done = kernels.add(row);
        result.changed |= row.changed;
        return done;
    }

    void forgetRow(ptrdiff_t at) {
        std::memset(sums.frames + at, 0, size_t(columns.count) * sizeof(uint16_t));
        std::memset(sums.count + at, 0, size_t(columns.count) * sizeof(uint16_t));
    }

    /// Nothing happens in the row. `from`: the frame's row of samples for it, at the pixel before
    /// the tile; −1: none.
    void growRow(ptrdiff_t at, ptrdiff_t from, bool has_samples) {
        if (has_samples) {
            const int done = kernels.add != nullptr ? addInLanes(at, from) : 0;
            addRow(at, from, nullptr, done);
        }
        ageRow(at);
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
            judge(frames, sums.count[at + i]);
        }
    }

    /// Counts the frame for a row in which nothing happens, and judges it.
    void ageRow(ptrdiff_t at) {
        AgeRow row{.frames = sums.frames + at,
                   .count = sums.count + at,
                   .width = columns.count,
                   .sample_cap = sample_cap};
        int i = kernels.age != nullptr ? kernels.age(row) : 0;
        for (; i < row.width; ++i) {
            row.frames[i] = uint16_t(row.frames[i] + (row.frames[i] < sample_cap ? 1 : 0));
            row.least_frames = std::min<int>(row.least_frames, row.frames[i]);
            row.least_count = std::min<int>(row.least_count, row.count[i]);
        }
        judge(row.least_frames, row.least_count);
    }

    void judge(int frames, int count) {
        result.finished &= frames >= sample_cap;
        result.settled &= count >= settled;
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
              // A mean of one sample is the sample, which lanes cannot divide.
              job.settled >= 2 ? job.sum_kernels : SumKernels{},
              {}};
    if (sums.kernels.add != nullptr) {
        sums.columns.spread();
    }
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
    }
    return sums.result;
}

}  // namespace still::upscale
