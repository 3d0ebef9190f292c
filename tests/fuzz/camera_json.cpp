// A camera file. What is read is written and read again as the same numbers, and makes finite
// cameras.

#include <cmath>

#include "engine/camera.h"
#include "engine/load.h"
#include "engine/timeline.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace still;

bool same(const CameraFile& a, const CameraFile& b) {
    bool equal = a.width == b.width && a.height == b.height && a.frames.size() == b.frames.size();
    for (size_t i = 0; equal && i < a.frames.size(); ++i) {
        const CameraFileFrame &p = a.frames[i], &q = b.frames[i];
        equal = p.view == q.view && p.projection == q.projection && p.jitter_fx8 == q.jitter_fx8 &&
                p.scene_frame == q.scene_frame && p.cut == q.cut;
    }
    return equal;
}

void checkFrames(const CameraFile& cameras) {
    const Scene empty;
    const CameraChoice choice{.file = &cameras};
    const int last = int(cameras.frames.size()) - 1;
    for (const int frame : {0, last / 2, last, last + 1}) {
        const FrameState state = frameStateAt(empty, choice, frame, cameras.width, cameras.height);
        for (int i = 0; i < 16; ++i) {
            fuzz::require(std::isfinite(state.camera.view_projection[i / 4][i % 4]),
                          "a loaded camera is finite");
        }
        fuzz::require(lastCut(empty, choice, frame) <= frame, "a cut lies before its frame");
    }
    static_cast<void>(isStill(empty, choice));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const auto file = fuzz::scratchFolder() / "fuzz.json";
    fuzz::writeScratch("fuzz.json", fuzz::textOf({data, size}));
    const Result<CameraFile> cameras = loadCameraFile(file);
    if (!cameras) {
        return 0;
    }
    checkFrames(*cameras);
    fuzz::writeScratch("fuzz.json", cameraFileText(*cameras));
    const Result<CameraFile> again = loadCameraFile(file);
    fuzz::require(again && same(*cameras, *again), "a camera file reads back as it was written");
    return 0;
}
