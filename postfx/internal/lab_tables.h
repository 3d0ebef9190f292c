#pragma once
// Tables that replace roots, logarithms and divisions. Made by the compiler from integers, so they
// are the same everywhere.

#include <cstdint>

namespace still::lab {

/// √i in 1/8, rounded to nearest.
struct RootTable {
    static constexpr int kSize = 4096;
    uint32_t of[kSize];
};
constexpr RootTable makeRootTable() {
    RootTable table{};
    uint32_t root = 0;
    for (uint32_t i = 0; i < RootTable::kSize; ++i) {
        while ((2 * root + 1) * (2 * root + 1) <= 4 * 64 * i) {
            ++root;
        }
        table.of[i] = root;
    }
    return table;
}
alignas(64) inline constexpr RootTable kRoots = makeRootTable();

/// ceil(2^32 / n): (v · of[n]) >> 32 is floor(v / n) exactly while n · v < 2^32, n ≥ 2. of[1] is
/// one too small to fit, so that it yields v − 1.
struct ReciprocalTable {
    uint32_t of[257];
};
constexpr ReciprocalTable makeReciprocalTable() {
    ReciprocalTable table{};
    table.of[1] = UINT32_MAX;
    for (uint64_t n = 2; n <= 256; ++n) {
        table.of[n] = uint32_t(((uint64_t{1} << 32) + n - 1) / n);
    }
    return table;
}
alignas(64) inline constexpr ReciprocalTable kReciprocals = makeReciprocalTable();

/// 2^27 / x, rounded to nearest, for x = kFirst + i · kStep: to be interpolated.
template <int kFirst, int kStep, int kCount>
struct InverseTable {
    uint32_t of[kCount];
};
template <int kFirst, int kStep, int kCount>
constexpr auto makeInverseTable() {
    InverseTable<kFirst, kStep, kCount> table{};
    for (int i = 0; i < kCount; ++i) {
        const auto x = uint32_t(kFirst + i * kStep);
        table.of[i] = ((uint32_t{1} << 27) + x / 2) / x;
    }
    return table;
}
/// For 1 + max, max in fx12, and 1 − max, max in fx15, up to 16.0 each.
alignas(64) inline constexpr auto kToneIn = makeInverseTable<4096, 64, 1025>();
alignas(64) inline constexpr auto kToneOut = makeInverseTable<32768, -32, 965>();

/// 1 / n in 2^-15, rounded to nearest; n ≥ 1.
struct MeanAlphaTable {
    uint32_t of[256];
};
constexpr MeanAlphaTable makeMeanAlphaTable() {
    MeanAlphaTable table{};
    for (uint32_t n = 1; n < 256; ++n) {
        table.of[n] = (65536 + n) / (2 * n);
    }
    return table;
}
alignas(64) inline constexpr MeanAlphaTable kMeanAlphas = makeMeanAlphaTable();

/// 4096 · (1 + log2(1 + i / 64)), rounded down.
struct LogTable {
    uint32_t of[1025];
};
constexpr LogTable makeLogTable() {
    LogTable table{};
    for (uint32_t i = 0; i <= 1024; ++i) {
        uint64_t v = uint64_t{64 + i} << 24, log = 4096;  // v in 2^-30
        for (; v >= uint64_t{2} << 30; v >>= 1) {
            log += 4096;
        }
        for (uint64_t bit = 2048; bit != 0; bit >>= 1) {
            v = v * v >> 30;
            if (v >= uint64_t{2} << 30) {
                v >>= 1;
                log += bit;
            }
        }
        table.of[i] = uint32_t(log);
    }
    return table;
}
alignas(64) inline constexpr LogTable kLogs = makeLogTable();

}  // namespace still::lab
