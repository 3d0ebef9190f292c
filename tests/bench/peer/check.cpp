#include "tests/bench/peer/check.h"

#include <algorithm>
#include <cmath>

#include "engine/frame_loop.h"
#include "postfx/metrics.h"

namespace still::peer {
namespace {

constexpr int kReferenceSamples = 64;
/// What is asked of a driver. The courtyard, 640 × 360, has 37 dB without normal maps, highlights
/// and point lights, 24 dB half a pixel beside. llvmpipe reaches 40.8 dB and 99.98 %, SwiftShader,
/// which places vertices on a coarser grid, 34.1 dB and 97.8 %.
struct Bounds {
    double picture_db, motion;
};
constexpr Bounds kFine{39, 0.999}, kCoarse{33, 0.97};
constexpr float kMotionTolerance_px = 1.0f / 16;

struct OwnFrame {
    Image<Rgb8> output;
    Image<Motion> motion;
};

template <class T>
Image<T> copyOf(ImageView<const T> from) {
    Image<T> copy(from.width, from.height);
    for (int y = 0; y < from.height; ++y) {
        std::copy_n(from.row(y), from.width, copy.view().row(y));
    }
    return copy;
}

OwnFrame ownFrame(const Scene& scene, const PeerFrames& peer, int frame, int samples,
                  Workers& workers) {
    FrameSettings settings;
    settings.width = peer.width;
    settings.height = peer.height;
    settings.anti_aliasing = samples > 1 ? AntiAliasing::ssaa : AntiAliasing::none;
    settings.ssaa_samples = samples;
    settings.planes.motion = samples == 1;
    FrameLoop loop(scene, settings, workers);
    const FrameResult result = loop.render(frame);
    OwnFrame own{copyOf(result.output), {}};
    if (settings.planes.motion) {
        own.motion = copyOf(result.gbuffer->motion.view());
    }
    return own;
}

/// Of the pixels that show a surface which has a past: the peer does not move its background.
double sameMotion(const Image<Motion>& own, const Image<PeerMotion>& peer) {
    int64_t same = 0, all = 0;
    for (int y = 0; y < own.height(); ++y) {
        for (int x = 0; x < own.width(); ++x) {
            const Motion a = own.at(x, y);
            const PeerMotion b = peer.at(x, y);
            if (a.x_fx8 == kNoHistory || !b.surface) {
                continue;
            }
            const float dx = float(a.x_fx8) / 256.0f - b.x_px;
            const float dy = float(a.y_fx8) / 256.0f - b.y_px;
            same += std::fabs(dx) <= kMotionTolerance_px && std::fabs(dy) <= kMotionTolerance_px;
            ++all;
        }
    }
    return all == 0 ? 1.0 : double(same) / double(all);
}

double psnrBetween(const Image<Rgb8>& a, const Image<Rgb8>& b) {
    return psnrDb(pixelError(a.view(), b.view()));
}

}  // namespace

bool PictureCheck::passes() const {
    const Bounds& wanted = driver == Driver::llvmpipe ? kFine : kCoarse;
    return raw_db >= wanted.picture_db && motion >= wanted.motion &&
           (!still || taa_db > aliased_db);
}

Result<PictureCheck> checkPictures(PeerFrames& peer, const Scene& scene, int frame, int threads) {
    const FrameState state = frameStateAt(peer.scene, {}, frame, peer.width, peer.height);
    peer.passes.beginGbuffer(peer.scene.background);
    const View view{peer.width, peer.height, {}};
    if (auto drawn = peer.drawer.draw(peer.scene, state, view, Pass::gbuffer); !drawn) {
        return tl::make_unexpected(drawn.error());
    }
    const Image<Rgb8> raw = peer.passes.readColour();
    const Image<PeerMotion> motion = peer.passes.readMotion();
    for (int before = 0; before <= frame; ++before) {
        if (auto drawn = peer.render(before); !drawn) {
            return tl::make_unexpected(drawn.error());
        }
    }
    const Image<Rgb8> resolved = peer.passes.readHistory();
    Workers workers(threads);
    const OwnFrame own = ownFrame(scene, peer, frame, 1, workers);
    const OwnFrame reference = ownFrame(scene, peer, frame, kReferenceSamples, workers);
    return PictureCheck{.driver = peer.gl.driver,
                        .raw_db = psnrBetween(own.output, raw),
                        .motion = sameMotion(own.motion, motion),
                        .aliased_db = psnrBetween(reference.output, own.output),
                        .taa_db = psnrBetween(reference.output, resolved),
                        .still = isStill(scene, {})};
}

}  // namespace still::peer
