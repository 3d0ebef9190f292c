// soak [--seed S] [--frames N] [--life K] [--control sample|drift|leak]
// Random lives of frame loops (script.h) until N frames were rendered by each of two loops with
// different engines: same bytes, finished pictures that are periodic, cycles that repeat exactly,
// memory that stays. Exit code: 0 all well, 1 something is wrong, 2 usage.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "engine/hash.h"
#include "tests/soak/memory.h"
#include "tests/soak/run.h"

namespace still::soak {
namespace {

/// The system's view of memory wavers: allocators keep some of what was freed.
constexpr int64_t kResidentSlack = 12 << 20;

struct Options {
    uint64_t seed = 1;
    int64_t frames = 3000;
    int life = -1;  ///< this one only; −1: as many as the frames need
    Control control = Control::none;
};

bool parseControl(const char* text, Control& control) {
    constexpr const char* kNames[] = {"none", "sample", "drift", "leak"};
    for (int i = 1; i < 4; ++i) {
        if (std::strcmp(text, kNames[i]) == 0) {
            control = Control(i);
            return true;
        }
    }
    return false;
}

bool parse(int argc, char** argv, Options& options) {
    for (int k = 1; k + 1 < argc; k += 2) {
        const std::string key = argv[k];
        const char* value = argv[k + 1];
        if (key == "--seed") {
            options.seed = std::strtoull(value, nullptr, 10);
        } else if (key == "--frames") {
            options.frames = std::atoll(value);
        } else if (key == "--life") {
            options.life = std::atoi(value);
        } else if (key != "--control" || !parseControl(value, options.control)) {
            return false;
        }
    }
    return argc % 2 == 1;
}

double megabytes(int64_t bytes) {
    return double(bytes) / (1 << 20);
}

void print(const Totals& t, int64_t resident_warm) {
    std::printf(
        "%lld frames by two loops in %lld lives: %lld cuts, %lld resizes, %lld loops "
        "restarted, %lld moved\n",
        (long long)t.frames, (long long)t.lives, (long long)t.cuts, (long long)t.resizes,
        (long long)t.restarts, (long long)t.moves);
    std::printf(
        "%lld cycles equal to the first of their life; %lld still segments finished, %lld "
        "of their frames equal to those a period before\n",
        (long long)t.repeated_cycles, (long long)t.still_segments, (long long)t.still_frames);
    std::printf(
        "hash %s; memory: %.2f MB allocated at most, %.2f MB after the last life; resident "
        "%.1f MB after a quarter of the run, %.1f MB at its end\n",
        hex(t.hash).c_str(), megabytes(t.most_live_bytes), megabytes(t.live_bytes),
        megabytes(resident_warm), megabytes(t.resident_bytes));
}

int run(const Options& options) {
    makeScenes();
    Totals totals;
    int64_t resident_warm = 0;
    int number = options.life < 0 ? 0 : options.life;
    for (;; ++number) {
        const Life life = makeLife(options.seed, number);
        const std::string wrong = runLife(life, options.control, totals);
        if (!wrong.empty()) {
            std::fprintf(stderr, "life %d (%s): %s\n    again: soak --seed %llu --life %d\n",
                         number, life.text().c_str(), wrong.c_str(),
                         (unsigned long long)options.seed, number);
            return 1;
        }
        if (resident_warm == 0 && totals.frames >= options.frames / 4) {
            resident_warm = totals.resident_bytes;
        }
        if (options.life >= 0 || totals.frames >= options.frames) {
            break;
        }
    }
    print(totals, resident_warm);
    if (resident_warm > 0 && totals.resident_bytes > resident_warm + kResidentSlack) {
        std::fprintf(stderr, "resident memory grew\n");
        return 1;
    }
    return 0;
}

}  // namespace
}  // namespace still::soak

int main(int argc, char** argv) {
    still::soak::Options options;
    if (!still::soak::parse(argc, argv, options)) {
        std::fprintf(stderr,
                     "usage: soak [--seed S] [--frames N] [--life K] "
                     "[--control sample|drift|leak]\n");
        return 2;
    }
    return still::soak::run(options);
}
