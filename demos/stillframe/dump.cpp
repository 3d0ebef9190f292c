#include "demos/stillframe/dump.h"

#include <algorithm>

#include "demos/inspect/paint_rows.h"
#include "demos/inspect/views.h"
#include "rasterizer/fixed.h"

namespace still::command {
namespace {

/// Numbers to be read off, other than the colour wheel that people look at.
void paintMotionValues(const GBuffer& g, ImageView<Rgb8> out, Workers& workers) {
    constexpr Rgb8 kNoHistoryColour{0, 0, 255};
    constexpr int kStepShift = 5;  // 256 units a pixel → 8 steps a pixel
    inspect::paintRows(out, workers, [&](int x, int y) {
        const Motion motion = g.motion.at(x, y);
        if (motion.x_fx8 == kNoHistory) {
            return kNoHistoryColour;
        }
        const auto shade = [](int fx8) {
            return uint8_t(std::clamp(128 + roundShift(fx8, kStepShift), 0, 255));
        };
        return Rgb8{shade(motion.x_fx8), shade(motion.y_fx8), 128};
    });
}

}  // namespace

Image<Rgb8> pictureOf(DumpPlane plane, const FrameResult& frame, const OutputTable& table) {
    const GBuffer& gbuffer = *frame.gbuffer;
    const bool of_output = plane == DumpPlane::confidence && !frame.confidence.empty();
    Image<Rgb8> picture(of_output ? frame.confidence.width : gbuffer.width(),
                        of_output ? frame.confidence.height : gbuffer.height());
    const ImageView<Rgb8> out = picture.view();
    Workers workers(1, Schedule::serial);
    switch (plane) {
        case DumpPlane::color:
            inspect::paintColour(gbuffer, table, out, workers);
            break;
        case DumpPlane::depth:
            inspect::paintDepth(gbuffer, out, workers);
            break;
        case DumpPlane::normal:
            inspect::paintNormal(gbuffer, out, workers);
            break;
        case DumpPlane::motion:
            paintMotionValues(gbuffer, out, workers);
            break;
        case DumpPlane::id:
            inspect::paintId(gbuffer, out, workers);
            break;
        case DumpPlane::confidence:
            inspect::paintConfidence(frame.confidence, frame.confidence_full, out, workers);
            break;
    }
    return picture;
}

}  // namespace still::command
