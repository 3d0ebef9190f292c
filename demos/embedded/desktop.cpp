// The same program on a desktop: embedded_desktop [THREADS [SIMD target]], or --targets for their
// names.

#include <cstdio>
#include <cstdlib>

#include "platform.h"
#include "run.h"
#include "spinner.h"

namespace spin {

void print(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
}

void fail(std::string_view line) {
    std::fflush(stdout);
    std::fprintf(stderr, "error: %.*s\n", int(line.size()), line.data());
    std::_Exit(1);
}

}  // namespace spin

int main(int count, char** arguments) {
    if (count == 2 && std::string_view(arguments[1]) == "--targets") {
        for (const still::SimdTarget target : still::availableSimdTargets()) {
            spin::print(still::name(target));
            spin::print("\n");
        }
        return 0;
    }
    const int threads = count > 1 ? std::atoi(arguments[1]) : 1;
    still::SimdTarget simd = still::bestSimdTarget();
    bool known = count <= 2;
    for (const still::SimdTarget target : still::availableSimdTargets()) {
        if (count == 3 && still::name(target) == arguments[2]) {
            simd = target;
            known = true;
        }
    }
    if (threads < 1 || threads > spin::kMaxThreads || !known) {
        std::fprintf(stderr, "usage: %s --targets | [THREADS, 1 ... %d [TARGET]]\n", arguments[0],
                     spin::kMaxThreads);
        return 2;
    }
    if (still::findPreset("variance")->policy != spin::kPolicy) {
        spin::fail("the preset `variance` is no longer what the board renders");
    }
    spin::run(simd, threads);
    return 0;
}
