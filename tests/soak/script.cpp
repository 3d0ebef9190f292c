#include "tests/soak/script.h"

#include <algorithm>
#include <map>

#include "demos/scenes/builtin.h"
#include "engine/camera.h"
#include "tests/support/test_scene.h"
#include "tests/unit/postfx/random_policy.h"

namespace still::soak {
namespace {

using test::Random;

constexpr const char* kScenes[] = {"triangle", "cubes",    "checker",      "fence",     "glass",
                                   "wires",    "depth",    "zoo",          "pan",       "lights",
                                   "cornell",  "penumbra", "moving-light", "switch-off"};
constexpr int kCycleSteps = 260;  ///< about
constexpr int kMarginSteps = 40;  ///< that a picture may be finished later than its last sample
constexpr int kLongPeriod = 256;  ///< longer ones are waited for in every fourth life only
constexpr int kFirstSamples[] = {0, 0, 17, 1000003, 0x7FFFFFFF - 90};

bool chance(Random& random, int percent) {
    return random.integer(1, 100) <= percent;
}

/// Small, often at the borders of tiles and vectors.
int randomSize(Random& random, int most) {
    constexpr int kBorders[] = {1, 2, 7, 8, 9, 31, 32, 33, 63, 64, 65};
    return chance(random, 30) ? std::min(most, kBorders[random.integer(0, 10)])
                              : random.integer(3, most);
}

Engine randomEngine(Random& random, bool alone) {
    const std::vector<SimdTarget> targets = availableSimdTargets();
    Engine engine;
    engine.simd = targets[size_t(random.integer(0, int(targets.size()) - 1))];
    engine.threads = alone ? 1 : random.integer(1, 6);
    engine.schedule = Schedule(random.integer(0, 2));
    engine.shading = chance(random, 20) ? Shading::forward : Shading::deferred;
    return engine;
}

void choosePolicy(Life& life, Random& random) {
    FrameSettings& settings = life.settings;
    const auto presets = taaPresets();
    const int choice = random.integer(0, int(presets.size()) + 7);
    if (choice < int(presets.size())) {
        life.policy = presets[size_t(choice)].name;
        settings.policy = presets[size_t(choice)].policy;
        return;
    }
    switch (choice - int(presets.size())) {
        case 0:
            life.policy = "none";
            settings.anti_aliasing = AntiAliasing::none;
            break;
        case 1:
            life.policy = "fxaa";
            settings.anti_aliasing = AntiAliasing::fxaa;
            break;
        case 2:
            life.policy = "ssaa";
            settings.anti_aliasing = AntiAliasing::ssaa;
            settings.ssaa_samples = random.integer(1, 3);
            break;
        case 3:
        case 4:
            settings.policy.ring = random.integer(1, 16);
            settings.policy.jitter = JitterPattern(random.integer(0, 13));
            life.policy = "gather of " + std::to_string(settings.policy.ring);
            break;
        default: {
            random_frames::Random policies{uint64_t(random.integer(0, 1 << 30))};
            life.policy = "any recursive";
            settings.policy = random_frames::randomPolicy(policies);
            settings.policy.ratio_fx8 = chance(random, 25) ? 384 : 256;
            break;
        }
    }
}

void chooseSettings(Life& life, Random& random) {
    FrameSettings& settings = life.settings;
    choosePolicy(life, random);
    settings.width = randomSize(random, 90);
    settings.height = randomSize(random, 70);
    settings.denoise = chance(random, 70) ? Denoise::svgf : Denoise::off;
    settings.tone_map = chance(random, 30) ? ToneMap::reinhard : ToneMap::none;
    settings.planes = {.normal = true, .motion = true};
    settings.fresh_gbuffer = chance(random, 60);
    settings.subframes = chance(random, 20) ? random.integer(2, 5) : 1;
    settings.first_sample = kFirstSamples[random.integer(0, 4)];
}

/// Draws the steps of a cycle.
class Director {
  public:
    Director(Life& life, int number, Random& random)
        : life_(life), number_(number), random_(random), scene_(sceneNamed(life.scene)) {
        ratio_fx8_ = life.settings.policy.ratio_fx8;
    }

    void direct() {
        home_ = poseAt(scene_, {}, 0);
        reach_ = glm::length(home_.eye - home_.target);
        cut(true);
        while (int(life_.steps.size()) < kCycleSteps) {
            const int what = random_.integer(0, 9);
            if (what < 4) {
                walk(random_.integer(5, 40));
            } else if (what < 6) {
                stand(chance(random_, 50) ? random_.integer(2, 30) : untilPeriodic());
            } else if (what < 8) {
                cut(chance(random_, 60));
            } else {
                change();
            }
        }
        stand(untilPeriodic());
    }

  private:
    glm::dvec3 anyDirection() {
        return {random_.real(-1, 1), random_.real(-1, 1), random_.real(-1, 1)};
    }

    Step& add() {
        const double aspect = double(width_) / height_;
        Step step;
        step.camera = cameraFrame(pose_, scene_.camera.near, scene_.camera.far, aspect);
        step.camera.scene_frame = instant_;
        step.width = width_;
        step.height = height_;
        step.move = chance(random_, 2);
        return life_.steps.emplace_back(step);
    }

    /// A new place and time, often with a new size, sometimes with a new second loop.
    void cut(bool resize) {
        pose_ = home_;
        pose_.eye += anyDirection() * (reach_ * 0.4);
        pose_.target += anyDirection() * (reach_ * 0.2);
        pose_.fov_y_deg = random_.real(20, 80);
        instant_ = random_.integer(0, 120);
        const bool first = life_.steps.empty();
        if (resize && !first) {
            width_ = randomSize(random_, 90);
            height_ = randomSize(random_, 70);
        }
        Step& step = add();
        step.camera.cut = true;
        step.resize = resize;
        step.restart = first || chance(random_, 40);
        step.engine = first ? life_.engines[1] : randomEngine(random_, life_.alone);
        step.ratio_fx8 = step.restart && upscalesInTime(life_.settings.policy) ? ratio_fx8_ : 0;
    }

    /// The camera glides or jumps about, the scene's time goes on, stands or skips.
    void walk(int frames) {
        const double speed = reach_ * random_.real(0.5, 1) / (4 << random_.integer(0, 9));
        const glm::dvec3 eye = anyDirection() * speed, target = anyDirection() * speed;
        const bool jumps = chance(random_, 15);
        const int pace = chance(random_, 70) ? 1 : random_.integer(0, 3);
        for (int i = 0; i < frames; ++i) {
            pose_.eye += jumps ? anyDirection() * (reach_ * 0.2) : eye;
            pose_.target += target;
            instant_ += pace;
            add();
        }
    }

    void stand(int frames) {
        for (int i = 0; i < frames; ++i) {
            add().repeats = i > 0;
        }
    }

    /// Of the size or the ratio, in the middle of things.
    void change() {
        if (upscalesInTime(life_.settings.policy) && chance(random_, 60)) {
            ratio_fx8_ = random_.integer(kNativeRatio_fx8, 512);
            add().ratio_fx8 = ratio_fx8_;
            return;
        }
        width_ = randomSize(random_, 90);
        height_ = randomSize(random_, 70);
        add().resize = true;
    }

    int untilPeriodic() const {
        TaaPolicy policy = life_.settings.policy;
        policy.ratio_fx8 = ratio_fx8_;
        const int period = int(policyPeriod(policy));
        if (period > kLongPeriod && number_ % 4 != 0) {
            return kMarginSteps;
        }
        return (scene_.lights.sampled() ? 3 : 2) * period + kMarginSteps;
    }

    Life& life_;
    int number_;
    Random& random_;
    const Scene& scene_;
    CameraPose home_, pose_;
    double reach_ = 1;
    int instant_ = 0;
    int width_ = life_.settings.width, height_ = life_.settings.height;
    int ratio_fx8_ = 256;
};

}  // namespace

std::string Engine::text() const {
    constexpr const char* kSchedules[] = {"pooled", "serial", "shuffled"};
    return std::string(name(simd)) + " " + kSchedules[int(schedule)] + " " +
           std::to_string(threads) + (shading == Shading::forward ? " forward" : "");
}

std::string Life::text() const {
    const FrameSettings& s = settings;
    return scene + ", " + policy + ", " + std::to_string(s.width) + "x" + std::to_string(s.height) +
           ", " + std::to_string(s.subframes) + " sub-frames, from sample " +
           std::to_string(s.first_sample) + (s.fresh_gbuffer ? ", fresh G-buffer" : "") +
           (s.denoise == Denoise::svgf ? "" : ", no denoiser") + "; " + engines[0].text() + " | " +
           engines[1].text();
}

Life makeLife(uint64_t seed, int number) {
    Random random(seed * 1000003 + uint64_t(number));
    Life life;
    life.scene = kScenes[random.integer(0, int(std::size(kScenes)) - 1)];
    life.alone = chance(random, 40);
    life.engines[0] = {bestSimdTarget(), life.alone ? 1 : random.integer(1, 3)};
    life.engines[1] = randomEngine(random, life.alone);
    chooseSettings(life, random);
    life.cycles = number % 8 == 7 ? 12 : 3;
    Director(life, number, random).direct();
    return life;
}

static std::map<std::string, Scene>& madeScenes() {
    static std::map<std::string, Scene> scenes;
    return scenes;
}

void makeScenes() {
    for (const char* name : kScenes) {
        madeScenes().emplace(name, builtinScene(name).value());
    }
}

const Scene& sceneNamed(const std::string& name) {
    return madeScenes().at(name);
}

}  // namespace still::soak
