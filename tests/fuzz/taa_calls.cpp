// Random sequences of calls: a whole frame loop, or one of the temporal filters alone. Two of each
// get the same calls, one with scalar kernels on one thread, the other with the best SIMD ones on
// two; after each call they must agree.

#include <array>
#include <cstring>
#include <optional>
#include <string>

#include "engine/frame_loop.h"
#include "engine/shapes.h"
#include "postfx/denoise.h"
#include "postfx/laboratory.h"
#include "postfx/upscale.h"
#include "tests/fuzz/fuzz.h"
#include "tests/unit/postfx/random_frames.h"

namespace {

using namespace still;
using fuzz::Bytes;
using fuzz::require;

constexpr int kMaxCalls = 12;

Workers& workersOf(int lane) {
    static Workers one(1), two(2);
    return lane == 0 ? one : two;
}

SimdTarget simdOf(int lane) {
    return lane == 0 ? SimdTarget::scalar : bestSimdTarget();
}

struct Size {
    int width = 8, height = 8;
};

/// Mostly tiny, now and then of two tiles.
Size sizeFrom(Bytes& in) {
    const uint8_t byte = in.byte();
    if (byte >= 0xF0) {
        return {8 + in.below(63), 8 + in.below(33)};
    }
    return {1 + (byte & 15), 1 + (byte >> 4)};
}

int between(Bytes& in, int low, int high) {
    return low + int(in.word() % uint32_t(high - low + 1));
}

TaaPolicy policyFrom(Bytes& in) {
    const std::span<const TaaPreset> presets = taaPresets();
    TaaPolicy policy = presets[in.byte() % presets.size()].policy;
    const std::span<const TaaPolicyKey> keys = taaPolicyKeys();
    for (int changes = in.below(6); changes > 0; --changes) {
        const TaaPolicyKey& key = keys[in.byte() % keys.size()];
        setPolicyNumber(policy, key, between(in, key.low, key.high));
    }
    return policy;
}

template <class T>
void compare(ImageView<const T> a, ImageView<const T> b, const char* plane) {
    require(a.width == b.width && a.height == b.height, plane);
    for (int y = 0; y < a.height; ++y) {
        require(std::memcmp(a.row(y), b.row(y), size_t(a.width) * sizeof(T)) == 0,
                std::string(plane) + " differs in row " + std::to_string(y));
    }
}

void compare(const ColourPlanes& a, const ColourPlanes& b) {
    compare(a.red, b.red, "red");
    compare(a.green, b.green, "green");
    compare(a.blue, b.blue, "blue");
}

// ---- the frame loop --------------------------------------------------------------------------

Scene makeScene(bool sampled) {
    Scene scene;
    scene.meshes = {shapes::plane(3, 3, 1, 1, 4), shapes::box(0.5f, 0.5f, 0.5f),
                    shapes::box(0.02f, 2.0f, 0.02f)};
    scene.mesh_names = {"floor", "box", "pole"};
    scene.materials.resize(3);
    scene.materials[1] = {.diffuse = {0.9f, 0.2f, 0.1f}, .specular = {0.5f, 0.5f, 0.5f}};
    scene.materials[2] = {
        .diffuse = {0.2f, 0.9f, 0.9f}, .opacity = 0.5f, .alpha_mode = AlphaMode::stochastic};
    scene.objects.resize(3);
    for (uint32_t i = 0; i < 3; ++i) {
        scene.meshes[i].parts[0].material = i;
        scene.objects[i].mesh = i;
    }
    scene.objects[1].tracks.translation.keys = {{2, {0, 0.6, 0}}, {8, {1, 0.6, 1}}};
    scene.objects[1].tracks.rotation_deg.keys = {{4, 0}, {8, 90}};
    scene.objects[2].tracks.translation.keys = {{0, {-1, 1, 0}}};
    scene.material_tracks = {{.material = 0, .offset = {}, .swaps = {{3, 1}}}};
    scene.camera.eye.keys = {{0, {0, 2, 5}}, {5, {0, 2, 5}}, {9, {1, 2, 4}}};
    scene.cuts = {7};
    scene.lights.sun = {.direction = {0.6f, -0.8f, 0.0f}, .colour = {1, 1, 0.9f}};
    scene.lights.sun_intensity.keys = {{0, 1}, {6, 1}, {7, 0.5}};
    if (sampled) {
        scene.lights.sun_shadow = SunShadow::traced;
        scene.lights.ambient_light = AmbientLight::traced_occlusion;
    }
    return scene;
}

FrameSettings frameSettings(Bytes& in) {
    FrameSettings settings;
    const Size size = sizeFrom(in);
    settings.width = size.width;
    settings.height = size.height;
    const uint8_t kind = in.byte();
    constexpr std::array kModes{AntiAliasing::taa,  AntiAliasing::taa, AntiAliasing::taa,
                                AntiAliasing::taa,  AntiAliasing::taa, AntiAliasing::none,
                                AntiAliasing::fxaa, AntiAliasing::ssaa};
    settings.anti_aliasing = kModes[kind & 7];
    settings.policy = policyFrom(in);
    settings.ssaa_samples = 1 + (kind >> 3 & 3);
    settings.denoise = (kind & 32) != 0 ? Denoise::off : Denoise::svgf;
    settings.fresh_gbuffer = (kind & 64) != 0;
    settings.subframes = (kind & 128) != 0 ? 1 + in.below(3) : 1;
    settings.first_sample = in.flag() ? in.byte() : 0;
    return settings;
}

void askForStory(const std::array<FrameLoop*, 2>& loops, Bytes& in, Size size) {
    const int x = in.below(80), y = in.below(80);
    require(loops[0]->story(x, y).has_value() == loops[1]->story(x, y).has_value(), "story");
    Image<Verdict> reason(size.width, size.height);
    Image<uint8_t> lost(size.width, size.height);
    static_cast<void>(loops[in.byte() & 1]->rejections({reason.view(), lost.view()}));
    require(loops[0]->tileWork().size() == loops[1]->tileWork().size(), "tile work");
}

/// Returns the size that stories have, or none.
void render(const std::array<FrameLoop*, 2>& loops, int frame) {
    const FrameResult a = loops[0]->render(frame), b = loops[1]->render(frame);
    compare(a.output, b.output, "output");
    compare(a.linear, b.linear);
    compare(a.sample_count, b.sample_count, "sample count");
    compare(a.confidence, b.confidence, "confidence");
    require(a.converged == b.converged, "converged");
}

void callFrameLoop(Bytes& in, bool sampled) {
    static const std::array<Scene, 2> scenes{makeScene(false), makeScene(true)};
    FrameSettings settings = frameSettings(in);
    std::array<std::optional<FrameLoop>, 2> loops;
    for (int lane = 0; lane < 2; ++lane) {
        settings.simd = simdOf(lane);
        loops[size_t(lane)].emplace(scenes[sampled ? 1 : 0], settings, workersOf(lane));
    }
    const std::array both{&*loops[0], &*loops[1]};
    int frame = -1;
    Size size{settings.width, settings.height};
    for (int call = 0; call < kMaxCalls && !in.empty(); ++call) {
        const uint8_t what = in.byte();
        if (what < 0x90) {
            frame = frame < 11 ? frame + 1 : 0;
            render(both, frame);
        } else if (what < 0xA8) {
            frame = in.below(10);
            render(both, frame);
        } else if (what < 0xC0) {
            size = sizeFrom(in);
            both[0]->resize(size.width, size.height);
            both[1]->resize(size.width, size.height);
            render(both, frame = std::max(frame, 0));
        } else if (what < 0xE0) {
            const int ratio_fx8 = between(in, kNativeRatio_fx8, kMaxRatio_fx8);
            if (settings.anti_aliasing == AntiAliasing::taa && upscalesInTime(settings.policy)) {
                both[0]->setRatio(ratio_fx8);
                both[1]->setRatio(ratio_fx8);
            }
        } else if (!upscales(settings.policy)) {
            askForStory(both, in, size);
        }
    }
}

// ---- the filters alone -----------------------------------------------------------------------

/// What a frame is made of, with the caller's whims added.
class Frames {
  public:
    Frames(Bytes& in, bool normals) : in_(in), normals_(normals) { restart(sizeFrom(in)); }

    void restart(Size size) {
        size_ = size;
        film_.emplace(size.width, size.height, normals_, in_.word());
    }
    Size size() const { return size_; }

    TaaFrame next(uint8_t how) {
        TaaFrame frame = film_->next(gbuffer);
        frame.reset |= (how & 0x70) == 0x70;
        frame.looked_at = (how & 4) == 0;
        frame.repeats = (how & 0x0C) == 0x0C ? 1 + in_.below(4) : 0;
        if ((how & 3) == 3) {
            age_.resize(size_.width, size_.height);
            for (int y = 0; y < size_.height; ++y) {
                std::memset(age_.view().row(y), in_.byte(), size_t(size_.width));
            }
            frame.light_age = age_.view();
        }
        return frame;
    }

    GBuffer gbuffer;

  private:
    Bytes& in_;
    bool normals_;
    Size size_;
    std::optional<random_frames::Film> film_;
    Image<uint8_t> age_;
};

void callTaa(Bytes& in) {
    Frames frames(in, in.flag());
    std::array<Taa, 2> taa;
    std::array<TaaSettings, 2> settings;
    for (int call = 0; call < kMaxCalls && !in.empty(); ++call) {
        const uint8_t what = in.byte(), how = in.byte();
        if (what >= 0xF0) {
            frames.restart(sizeFrom(in));
        } else if (what >= 0xE0) {
            for (TaaSettings& each : settings) {
                each.sample_cap = 1 + how % 255;
                each.ring = 1 + what % kMaxRing;
            }
        }
        const bool rests = what >= 0xC0 && what < 0xE0 && call > 0;
        const TaaFrame frame = rests ? TaaFrame{} : frames.next(how);
        for (size_t lane = 0; lane < 2; ++lane) {
            settings[lane].simd = simdOf(int(lane));
            const GBuffer& g = frames.gbuffer;
            if (rests) {
                static_cast<void>(taa[lane].rest(settings[lane]));
                continue;
            }
            if ((what & 1) != 0) {
                taa[lane].plan(g.width(), g.height(), g.tiles, frame, settings[lane]);
            }
            taa[lane].resolve(g, frame, settings[lane], workersOf(int(lane)));
        }
        compare(taa[0].colour(), taa[1].colour());
        compare(taa[0].sampleCount(), taa[1].sampleCount(), "sample count");
        require(taa[0].converged() == taa[1].converged(), "converged");
        if ((what & 6) == 6 && frame.looked_at && !rests) {
            static_cast<void>(taa[0].story(frames.gbuffer, how % frames.size().width,
                                           what % frames.size().height));
        }
    }
}

void callUpscaler(Bytes& in) {
    Frames frames(in, in.flag());
    std::array<TemporalUpscaler, 2> upscalers;
    UpscaleSettings settings;
    int ratio_fx8 = 512;
    for (int call = 0; call < kMaxCalls && !in.empty(); ++call) {
        const uint8_t what = in.byte(), how = in.byte();
        if (what >= 0xF8 || call == 0) {
            const Size size = sizeFrom(in);
            settings.width = size.width;
            settings.height = size.height;
        }
        if (what >= 0xE0 || call == 0) {
            settings.sample_cap = between(in, 1, 4096);
            settings.ring = 1 + what % kMaxRing;
            ratio_fx8 = between(in, kNativeRatio_fx8, kMaxRatio_fx8);
            frames.restart({renderedSize(settings.width, ratio_fx8),
                            renderedSize(settings.height, ratio_fx8)});
        }
        const bool rests = what >= 0xC0 && what < 0xE0 && call > 0;
        const TaaFrame frame = rests ? TaaFrame{} : frames.next(how);
        for (size_t lane = 0; lane < 2; ++lane) {
            settings.simd = simdOf(int(lane));
            const GBuffer& g = frames.gbuffer;
            if (rests) {
                static_cast<void>(upscalers[lane].rest(g.width(), g.height(), settings));
                continue;
            }
            if ((what & 1) != 0) {
                upscalers[lane].plan(g.width(), g.height(), g.tiles, frame, settings);
            }
            upscalers[lane].resolve(g, frame, settings, workersOf(int(lane)));
        }
        compare(upscalers[0].colour(), upscalers[1].colour());
        compare(upscalers[0].sampleCount(), upscalers[1].sampleCount(), "sample count");
        require(upscalers[0].converged() == upscalers[1].converged(), "converged");
    }
}

void callLaboratory(Bytes& in) {
    Frames frames(in, true);
    TaaPolicy policy = policyFrom(in);
    std::array<Laboratory, 2> laboratories;
    for (int call = 0; call < kMaxCalls && !in.empty(); ++call) {
        const uint8_t what = in.byte(), how = in.byte();
        if (what >= 0xF0) {
            frames.restart(sizeFrom(in));
        } else if (what >= 0xE0) {
            policy = policyFrom(in);
        }
        policy.method = Method::recursive;
        const TaaFrame frame = frames.next(how & 0xF0);
        for (size_t lane = 0; lane < 2; ++lane) {
            laboratories[lane].resolve(frames.gbuffer,
                                       {.reset = frame.reset,
                                        .jitter_x_fx8 = frame.jitter_x_fx8,
                                        .jitter_y_fx8 = frame.jitter_y_fx8},
                                       policy, simdOf(int(lane)), workersOf(int(lane)));
        }
        compare(laboratories[0].colour(), laboratories[1].colour());
        compare(laboratories[0].confidence(), laboratories[1].confidence(), "confidence");
        if ((what & 6) == 6) {
            static_cast<void>(laboratories[0].story(frames.gbuffer, how % frames.size().width,
                                                    what % frames.size().height));
        }
    }
}

/// The G-buffer's colours, turned about, do for light.
void callDenoiser(Bytes& in) {
    Frames frames(in, true);
    std::array<Denoiser, 2> denoisers;
    for (int call = 0; call < kMaxCalls && !in.empty(); ++call) {
        const uint8_t what = in.byte(), how = in.byte();
        if (what >= 0xF0) {
            frames.restart(sizeFrom(in));
        }
        const TaaFrame frame = frames.next(how & 0xF0);
        const GBuffer& g = frames.gbuffer;
        const LightPlanes noisy{{g.red.view(), g.green.view(), g.blue.view()},
                                {g.blue.view(), g.red.view(), g.green.view()}};
        LightChangeImages change;
        change.resize(g.width(), g.height());
        for (Image<uint16_t>* plane : {&change.direct_now, &change.indirect_before}) {
            for (int y = 0; y < plane->height() && (what & 1) != 0; ++y) {
                std::memset(plane->view().row(y), in.byte(), size_t(plane->width()) * 2);
            }
        }
        DenoiseFrame facts{.reset = frame.reset, .change = {}};
        if ((what & 2) != 0) {
            facts.change = {change.direct_before.view(), change.direct_now.view(),
                            change.indirect_before.view(), change.indirect_now.view()};
        }
        for (size_t lane = 0; lane < 2; ++lane) {
            denoisers[lane].run(g, noisy, facts, simdOf(int(lane)), workersOf(int(lane)));
        }
        compare(denoisers[0].light().direct, denoisers[1].light().direct);
        compare(denoisers[0].light().indirect, denoisers[1].light().indirect);
        compare(denoisers[0].lightAge(), denoisers[1].lightAge(), "light age");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    Bytes in({data, size});
    switch (in.byte() % 6) {
        case 0:
        case 1:
            callFrameLoop(in, in.below(8) == 0);
            break;
        case 2:
            callTaa(in);
            break;
        case 3:
            callUpscaler(in);
            break;
        case 4:
            callLaboratory(in);
            break;
        default:
            callDenoiser(in);
            break;
    }
    return 0;
}
