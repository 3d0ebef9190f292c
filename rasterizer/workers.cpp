#include "rasterizer/workers.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <vector>

#if !STILL_BOARD
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#endif

namespace still {

namespace {

struct Job {
    int count = 0;
    int grain = 1;
    void (*call)(void*, int, int, int) = nullptr;
    void* body = nullptr;
    WorkObserver* observer = nullptr;

    int grains() const { return (count + grain - 1) / grain; }
    void runGrain(int index, int worker) const {
        const int begin = index * grain;
        if (observer != nullptr) {
            observer->grainBegins(index);
        }
        call(body, begin, std::min(begin + grain, count), worker);
        if (observer != nullptr) {
            observer->grainEnds(index);
        }
    }
};

/// SplitMix64 (Steele, Lea, Flood 2014): a permutation per seed, the same everywhere.
uint64_t nextRandom(uint64_t& state) {
    state += 0x9E3779B97F4A7C15u;
    uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

#if STILL_BOARD

/// One thread is all there is, and all that is compiled.
class Pool {
  public:
    int start(int) { return 1; }
    int takeTurn() { return 0; }
    void run(const Job&) {}
};

#else

class Pool {
  public:
    ~Pool() {
        {
            std::lock_guard lock(mutex_);
            stop_ = true;
        }
        start_.notify_all();
        for (std::thread& thread : others_) {
            thread.join();
        }
    }

    /// `threads` counts the calling one. Returns how many there are.
    int start(int threads) {
        for (int worker = 1; worker < threads; ++worker) {
            others_.emplace_back([this, worker] { work(worker); });
        }
        return threads;
    }

    /// Held by the thread whose parallelFor runs.
    std::unique_lock<std::mutex> takeTurn() { return std::unique_lock(turn_); }

    void run(const Job& job) {
        {
            std::lock_guard lock(mutex_);
            job_ = job;
            next_grain_ = 0;
            busy_ = int(others_.size());
            ++generation_;
        }
        start_.notify_all();
        takeGrains(0);
        std::unique_lock lock(mutex_);
        done_.wait(lock, [&] { return busy_ == 0; });
    }

  private:
    void takeGrains(int worker) {
        const int grains = job_.grains();
        for (int g = next_grain_.fetch_add(1); g < grains; g = next_grain_.fetch_add(1)) {
            job_.runGrain(g, worker);
        }
    }

    void work(int worker) {
        uint64_t seen = 0;
        for (;;) {
            {
                std::unique_lock lock(mutex_);
                start_.wait(lock, [&] { return stop_ || generation_ != seen; });
                if (stop_) {
                    return;
                }
                seen = generation_;
            }
            takeGrains(worker);
            std::lock_guard lock(mutex_);
            if (--busy_ == 0) {
                done_.notify_one();
            }
        }
    }

    std::mutex turn_;
    std::mutex mutex_;
    std::condition_variable start_, done_;
    uint64_t generation_ = 0;
    int busy_ = 0;
    bool stop_ = false;
    Job job_;
    std::atomic<int> next_grain_{0};
    std::vector<std::thread> others_;
};

#endif

}  // namespace

struct Workers::State {
    int threads = 1;
    Schedule schedule = Schedule::pooled;
    uint64_t random = 0;
    WorkObserver* observer = nullptr;
    Pool pool;

    void runShuffled(const Job& job) {
        std::vector<int> order(size_t(job.grains()));
        std::iota(order.begin(), order.end(), 0);
        for (size_t i = order.size(); i > 1; --i) {
            std::swap(order[i - 1], order[nextRandom(random) % i]);
        }
        for (int g : order) {
            job.runGrain(g, 0);
        }
    }
};

Workers::Workers(int threads, Schedule schedule, uint64_t seed)
    : state_(std::make_unique<State>()) {
    assert(threads >= 1);
    state_->threads = schedule == Schedule::pooled ? state_->pool.start(threads) : 1;
    state_->schedule = schedule;
    state_->random = seed;
}

Workers::~Workers() = default;

int Workers::threads() const {
    return state_->threads;
}

void Workers::observe(WorkObserver* observer) {
    state_->observer = observer;
}

void Workers::run(int count, int grain, Call call, void* body) {
    assert(count >= 0 && grain >= 1);
    const Job job{count, grain, call, body, state_->observer};
    if (job.observer != nullptr) {
        job.observer->sectionBegins(job.grains());
    }
    [[maybe_unused]] const auto turn = state_->pool.takeTurn();
    if (state_->schedule == Schedule::shuffled) {
        state_->runShuffled(job);
    } else if (state_->threads == 1 || job.grains() <= 1) {
        for (int g = 0; g < job.grains(); ++g) {
            job.runGrain(g, 0);
        }
    } else {
        state_->pool.run(job);
    }
}

}  // namespace still
