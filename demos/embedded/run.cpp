#include "run.h"

#include "line.h"
#include "memory.h"
#include "platform.h"
#include "spinner.h"

namespace spin {

void run(still::SimdTarget simd, int threads) {
    still::Workers workers(threads);
    const size_t before = arena().used();
    Spinner spinner(simd, workers);
    const size_t used = arena().used() - before;
    sealArena();
    for (int frame = 0; frame < kFrames; ++frame) {
        const FrameHashes hashes = spinner.render(frame);
        Line line;
        (line << "frame " << size_t(frame) << " gbuffer ").hex(hashes.gbuffer);
        (line << " image ").hex(hashes.image) << "\n";
        print(line.text());
    }
    Line line;
    print((line << "arena " << used << " of " << kArenaBytes << " bytes\n").text());
}

}  // namespace spin
