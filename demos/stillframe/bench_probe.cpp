#include "demos/stillframe/bench_probe.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "demos/stillframe/bench_probe_kernels.h"
#include "demos/stillframe/clock.h"
#include "rasterizer/workers.h"

namespace still::command {
namespace {

constexpr size_t kMemoryBytes = size_t{96} << 20;  ///< read, and as much written, by all threads
constexpr size_t kL3Bytes = size_t{4} << 20, kL2Bytes = size_t{256} << 10;  ///< per thread
constexpr int kRepeats = 5;

struct Free {
    void operator()(uint8_t* bytes) const { std::free(bytes); }
};
using Block = std::unique_ptr<uint8_t, Free>;

Block makeBlock(size_t bytes) {
    Block block(static_cast<uint8_t*>(std::aligned_alloc(4096, bytes)));
    std::memset(block.get(), 1, bytes);
    return block;
}

/// Runs `task(worker)`, which returns how much it did, on all threads at once; the best of a few
/// rounds, in billions a second.
template <class Task>
double bestRate(Workers& workers, Task&& task) {
    double best = 0;
    std::vector<double> done(size_t(workers.threads()));
    for (int i = 0; i < kRepeats; ++i) {
        const double start_ms = nowMs();
        workers.parallelFor(workers.threads(), 1,
                            [&](int share, int, int) { done[size_t(share)] = task(share); });
        const double time_ms = nowMs() - start_ms;
        double sum = 0;
        for (double each : done) {
            sum += each;
        }
        best = std::max(best, sum / time_ms * 1e-6);
    }
    return best;
}

/// Every thread copies its share of `bytes` so often.
double copyRate(Workers& workers, void (*copy)(const uint8_t*, uint8_t*, size_t), uint8_t* from,
                uint8_t* to, size_t share_bytes, int times) {
    return bestRate(workers, [&](int share) {
        for (int i = 0; i < times; ++i) {
            copy(from + size_t(share) * share_bytes, to + size_t(share) * share_bytes, share_bytes);
        }
        return 2.0 * double(share_bytes) * times;
    });
}

/// Numbers for the arithmetic loops, one set for each thread.
struct alignas(64) Sinks {
    int16_t shorts[128];
    float floats[128];
    int32_t words[64];
    Sinks() {
        std::fill_n(shorts, 128, int16_t(257));
        std::fill_n(floats, 128, 1.0000001f);
        std::fill_n(words, 64, 0);
    }
};

MachineLimits measure(int threads) {
    const ProbeKernels& kernels = probeKernels();
    Workers workers(threads);
    const size_t small_bytes = kL3Bytes * size_t(threads);
    const size_t bytes = std::max(kMemoryBytes, small_bytes);
    const Block from = makeBlock(bytes), to = makeBlock(bytes);
    const size_t share = kMemoryBytes / size_t(threads) / 4096 * 4096;
    const auto rate = [&](auto copy, size_t share_bytes, int times) {
        return copyRate(workers, copy, from.get(), to.get(), share_bytes, times);
    };
    std::vector<Sinks> sinks(static_cast<size_t>(threads));
    const std::vector<int32_t> texels(kProbeTexels, 1);
    constexpr int kRounds = 1000000;
    MachineLimits limits{.threads = threads};
    limits.copy = rate(kernels.copy, share, 1);
    limits.stream = rate(kernels.stream, share, 1);
    limits.l3_copy = rate(kernels.copy, kL3Bytes, 4);
    limits.l2_copy = rate(kernels.copy, kL2Bytes, 64);
    limits.mul_high =
        bestRate(workers, [&](int i) { return kernels.mulHigh(kRounds, sinks[size_t(i)].shorts); });
    limits.add =
        bestRate(workers, [&](int i) { return kernels.add(kRounds, sinks[size_t(i)].shorts); });
    limits.divide = bestRate(
        workers, [&](int i) { return kernels.divide(kRounds / 4, sinks[size_t(i)].floats); });
    limits.gather = bestRate(workers, [&](int i) {
        return kernels.gather(texels.data(), kRounds / 2, sinks[size_t(i)].words);
    });
    return limits;
}

}  // namespace

std::vector<MachineLimits> measureMachine(const std::vector<int>& threads) {
    std::vector<MachineLimits> all;
    for (int count : threads) {
        all.push_back(measure(count));
    }
    return all;
}

}  // namespace still::command
