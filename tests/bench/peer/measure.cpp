#include "tests/bench/peer/measure.h"

#include "demos/stillframe/clock.h"
#include "engine/jitter.h"

namespace still::peer {
namespace {

using command::nowMs;

/// The driver compiles and allocates in the first frames.
constexpr int kWarmUp = 4;

/// A frame whose state is known: that is not the driver's work, so it is not measured.
struct Prepared {
    FrameState state;
    View view;
};

Prepared prepare(const PeerFrames& peer, int frame) {
    return {frameStateAt(peer.scene, {}, frame, peer.width, peer.height),
            {peer.width, peer.height, taaSample(uint32_t(frame))}};
}

Result<void> drawGbuffer(PeerFrames& peer, const Prepared& frame, Pass pass) {
    peer.passes.beginGbuffer(peer.scene.background);
    return peer.drawer.draw(peer.scene, frame.state, frame.view, pass);
}

/// Runs `stage`, which returns a Result, until the driver has finished; adds the time.
template <class Stage>
Result<void> timed(const Gl& gl, bool counts, std::vector<double>& times_ms, Stage&& stage) {
    gl.glFinish();
    const double start_ms = nowMs();
    Result<void> done = stage();
    gl.glFinish();
    if (counts) {
        times_ms.push_back(nowMs() - start_ms);
    }
    return done;
}

Result<void> measureStages(PeerFrames& peer, const Prepared& frame, bool counts, bool reset,
                           PeerTimes& out) {
    const auto gbuffer = [&] { return drawGbuffer(peer, frame, Pass::gbuffer); };
    const auto resolve = [&]() -> Result<void> {
        peer.passes.resolve(reset);
        return {};
    };
    const auto output = [&]() -> Result<void> {
        peer.passes.output();
        return {};
    };
    if (auto done = timed(peer.gl, counts, out.gbuffer_ms, gbuffer); !done) {
        return done;
    }
    return timed(peer.gl, counts, out.taa_ms, resolve).and_then([&] {
        return timed(peer.gl, counts, out.output_ms, output);
    });
}

Result<void> measureParts(PeerFrames& peer, const Prepared& frame, bool counts, PeerTimes& out) {
    const auto depth = [&] {
        peer.passes.beginDepth();
        return peer.drawer.draw(peer.scene, frame.state, frame.view, Pass::depth);
    };
    const auto lambert = [&] { return drawGbuffer(peer, frame, Pass::lambert); };
    return timed(peer.gl, counts, out.depth_ms, depth).and_then([&] {
        return timed(peer.gl, counts, out.lambert_ms, lambert);
    });
}

Result<void> measureMultisampled(PeerFrames& peer, const Prepared& frame, bool counts,
                                 PeerTimes& out) {
    return timed(peer.gl, counts, out.msaa_ms, [&] {
        return peer.passes.beginMultisampled(kMultisamples, peer.scene.background)
            .and_then([&] {
                return peer.drawer.draw(peer.scene, frame.state, frame.view, Pass::gbuffer);
            })
            .map([&] { peer.passes.averageSamples(); });
    });
}

/// Calls run(frame, counts) for the warm-up frames and then for those that count.
template <class Run>
Result<void> eachFrame(int frames, Run&& run) {
    for (int frame = 0; frame < kWarmUp + frames; ++frame) {
        if (Result<void> done = run(frame, frame >= kWarmUp); !done) {
            return done;
        }
    }
    return {};
}

}  // namespace

Result<void> PeerFrames::render(int frame, Pass pass) {
    const Prepared prepared = prepare(*this, frame);
    return drawGbuffer(*this, prepared, pass).map([&] { passes.resolve(frame == 0); });
}

Result<PeerTimes> measure(PeerFrames& peer, int frames, bool multisampling) {
    PeerTimes times;
    const auto stages = [&](int frame, bool counts) {
        return measureStages(peer, prepare(peer, frame), counts, frame == 0, times);
    };
    const auto whole = [&](int frame, bool counts) {
        const Prepared prepared = prepare(peer, frame);
        return timed(peer.gl, counts, times.frame_ms, [&] {
            return drawGbuffer(peer, prepared, Pass::gbuffer).map([&] {
                peer.passes.resolve(frame == 0);
            });
        });
    };
    const auto parts = [&](int frame, bool counts) {
        return measureParts(peer, prepare(peer, frame), counts, times);
    };
    const auto multisampled = [&](int frame, bool counts) {
        return measureMultisampled(peer, prepare(peer, frame), counts, times);
    };
    Result<void> done =
        eachFrame(frames, stages).and_then([&] { return eachFrame(frames, whole); }).and_then([&] {
            return eachFrame(frames, parts);
        });
    if (done && multisampling) {
        done = eachFrame(frames, multisampled);
    }
    return done.map([&] { return times; });
}

}  // namespace still::peer
