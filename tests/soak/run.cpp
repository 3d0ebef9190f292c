#include "tests/soak/run.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>

#include "engine/hash.h"
#include "engine/stage_hash.h"
#include "tests/soak/memory.h"

namespace still::soak {
namespace {

/// A frame loop with its own workers.
class Player {
  public:
    Player(const Scene& scene, FrameSettings settings, const Engine& engine)
        : workers_(engine.threads, engine.schedule, 7) {
        settings.simd = engine.simd;
        settings.shading = engine.shading;
        loop_.emplace(scene, settings, workers_);
    }

    FrameResult play(const Step& step, int frame) {
        if (step.resize) {
            loop_->resize(step.width, step.height);
        }
        if (step.ratio_fx8 != 0) {
            loop_->setRatio(step.ratio_fx8);
        }
        return loop_->render(frame);
    }

    void move() {
        FrameLoop elsewhere(std::move(*loop_));
        loop_.emplace(std::move(elsewhere));
    }

  private:
    Workers workers_;
    std::optional<FrameLoop> loop_;
};

struct Seen {
    uint64_t all = 0, output = 0;
};

Seen seenOf(const StageHashes& stages) {
    Seen seen;
    for (const StageHash& stage : stages) {
        seen.all = (seen.all ^ stage.whole) * 0x9E3779B97F4A7C15u + 1;
    }
    seen.output = stages[size_t(Stage::output)].whole;
    return seen;
}

/// Where two frames differ, or empty.
std::string differenceOf(const StageHashes& first, const StageHashes& second, int width) {
    const auto difference = firstDifference(first, second);
    if (!difference) {
        return {};
    }
    std::string text = std::string("stage ") + name(difference->stage);
    if (!difference->tiles.empty()) {
        const int tiles_x = (width + kTileSize - 1) / kTileSize, tile = difference->tiles.front();
        text += ", tile (" + std::to_string(tile % tiles_x) + ", " +
                std::to_string(tile / tiles_x) + ")";
    }
    return text;
}

bool hasStochastic(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return m.alpha_mode == AlphaMode::stochastic; });
}

/// While nothing changes, the picture of a gather must be finished in time; from then on it stays,
/// and all planes come again after a period.
class Stillness {
  public:
    explicit Stillness(const Life& life)
        : policy_(life.settings.policy),
          gathers_(life.settings.anti_aliasing == AntiAliasing::taa &&
                   policy_.method == Method::gather),
          margin_(sceneNamed(life.scene).lights.sampled() ? policyPeriod(policy_) : 8),
          samples_stochastic_(hasStochastic(sceneNamed(life.scene))) {}

    /// What is wrong, or empty.
    std::string watch(const Step& step, const Seen& seen, bool converged, Totals& totals) {
        policy_.ratio_fx8 = step.ratio_fx8 != 0 ? step.ratio_fx8 : policy_.ratio_fx8;
        if (!step.repeats) {
            frames_.clear();
            return {};
        }
        frames_.push_back(seen);
        if (!gathers_) {
            return {};
        }
        const size_t period = policyPeriod(policy_), done = frames_.size();
        if (!converged) {
            finished_ = done;
            return done <= period + margin_ ? "" : "is not finished a period after it stood still";
        }
        if (done > finished_ + 1 && frames_[done - 2].output != seen.output) {
            return "changes a finished picture";
        }
        if (done > finished_ + period) {
            totals.still_segments += done == finished_ + period + 1 ? 1 : 0;
            ++totals.still_frames;
            const bool same = frames_[done - 1 - period].all == seen.all;
            return same || samples_stochastic_ ? "" : "differs from the one a period before";
        }
        return {};
    }

  private:
    TaaPolicy policy_;
    bool gathers_;
    /// Frames that a picture may take longer than its samples. Light that is sampled is old enough
    /// only some time after a surface came into view.
    size_t margin_;
    /// Which of a stochastic surface's samples exist never repeats; only the picture is finished.
    bool samples_stochastic_;
    std::vector<Seen> frames_;  ///< since everything stands still
    size_t finished_ = 0;       ///< how many of them were not
};

class Run {
  public:
    Run(const Life& life, Control control, Totals& totals)
        : life_(life),
          control_(control),
          totals_(totals),
          scene_(sceneNamed(life.scene)),
          settings_(life.settings),
          stillness_(life) {
        cameras_.frames.reserve(life.steps.size() * size_t(life.cycles));
        first_cycle_.reserve(life.steps.size());
        settings_.camera.file = &cameras_;
        first_.emplace(scene_, settings_, life.engines[0]);
    }

    std::string run() {
        for (int cycle = 0; cycle < life_.cycles; ++cycle) {
            for (size_t i = 0; i < life_.steps.size(); ++i) {
                if (std::string wrong = frame(cycle, i); !wrong.empty()) {
                    return "frame " + std::to_string(cameras_.frames.size() - 1) + " (cycle " +
                           std::to_string(cycle) + ", step " + std::to_string(i) + ") " + wrong;
                }
            }
            totals_.repeated_cycles += cycle > 0 ? 1 : 0;
            if (std::string wrong = growth(cycle); !wrong.empty()) {
                return wrong;
            }
        }
        return {};
    }

  private:
    void begin(int cycle, const Step& step) {
        CameraFileFrame& camera = cameras_.frames.emplace_back(step.camera);
        if (control_ == Control::drift) {
            *camera.scene_frame += cycle;
        }
        if (step.restart) {
            second_.reset();
            FrameSettings settings = settings_;
            settings.width = step.width;
            settings.height = step.height;
            settings.first_sample += control_ == Control::sample ? 1 : 0;
            second_.emplace(scene_, settings, step.engine);
        }
        if (step.move) {
            first_->move();
        }
        totals_.restarts += step.restart ? 1 : 0;
        totals_.moves += step.move ? 1 : 0;
        totals_.resizes += step.resize ? 1 : 0;
        totals_.cuts += step.camera.cut ? 1 : 0;
    }

    /// After the second cycle all buffers are as large as they get, but for those of threads that
    /// share the work anew each time; and loops remember at which frames their ratio changed.
    std::string growth(int cycle) {
        if (control_ == Control::leak) {
            leaked_.push_back(std::make_unique<char[]>(4096));
        }
        const int64_t live = liveBytes();
        if (cycle <= 1) {
            after_second_cycle_ = live;
            return {};
        }
        constexpr int64_t kThreadsBytes = 1 << 20, kBytesPerChange = 2 * 2 * 8;
        const auto changes = std::count_if(life_.steps.begin(), life_.steps.end(),
                                           [](const Step& step) { return step.ratio_fx8 != 0; });
        const int64_t allowed =
            (life_.alone ? 0 : kThreadsBytes) + changes * (cycle + 1) * kBytesPerChange;
        const int64_t grown = live - after_second_cycle_;
        const bool flat = grown <= allowed;
        return flat ? std::string()
                    : "memory grew by " + std::to_string(grown) + " bytes from cycle 1 to cycle " +
                          std::to_string(cycle);
    }

    std::string frame(int cycle, size_t index) {
        const Step& step = life_.steps[index];
        begin(cycle, step);
        const int number = int(cameras_.frames.size()) - 1;
        const FrameResult result = first_->play(step, number);
        const StageHashes stages = hashStages(result);
        const StageHashes others = hashStages(second_->play(step, number));
        if (std::string text = differenceOf(stages, others, step.width); !text.empty()) {
            return "differs between the two loops: " + text;
        }
        const Seen seen = seenOf(stages);
        ++totals_.frames;
        totals_.hash = (totals_.hash ^ seen.all) * 0x9E3779B97F4A7C15u + 1;
        if (cycle == 0) {
            first_cycle_.push_back(seen.all);
        } else if (first_cycle_[index] != seen.all) {
            return "differs from that of the first cycle";
        }
        totals_.most_live_bytes = std::max(totals_.most_live_bytes, liveBytes());
        return stillness_.watch(step, seen, result.converged, totals_);
    }

    const Life& life_;
    Control control_;
    Totals& totals_;
    const Scene& scene_;
    FrameSettings settings_;
    CameraFile cameras_;
    Stillness stillness_;
    std::optional<Player> first_, second_;
    std::vector<uint64_t> first_cycle_;
    int64_t after_second_cycle_ = 0;
    std::vector<std::unique_ptr<char[]>> leaked_;
};

}  // namespace

std::string runLife(const Life& life, Control control, Totals& totals) {
    const int64_t before = liveBytes();
    std::string wrong = Run(life, control, totals).run();
    ++totals.lives;
    totals.live_bytes = liveBytes();
    totals.resident_bytes = residentBytes();
    const int64_t kept = totals.live_bytes - before - int64_t(wrong.capacity());
    if (wrong.empty() && kept > 0) {
        wrong = "leaves " + std::to_string(kept) + " bytes behind";
    }
    return wrong;
}

}  // namespace still::soak
