#include "rasterizer/workers.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <condition_variable>
#include <mutex>
#include <numeric>
#include <thread>
#include <vector>

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

}  // namespace

struct Workers::State {
    int threads = 1;
    Schedule schedule = Schedule::pooled;
    uint64_t random = 0;
    WorkObserver* observer = nullptr;

    std::mutex turn;  ///< held by the thread whose parallelFor runs
    std::mutex mutex;
    std::condition_variable start, done;
    uint64_t generation = 0;
    int busy = 0;
    bool stop = false;
    Job job;
    std::atomic<int> next_grain{0};
    std::vector<std::thread> pool;

    void takeGrains(int worker) {
        const int grains = job.grains();
        for (int g = next_grain.fetch_add(1); g < grains; g = next_grain.fetch_add(1)) {
            job.runGrain(g, worker);
        }
    }

    void poolThread(int worker) {
        uint64_t seen = 0;
        for (;;) {
            {
                std::unique_lock lock(mutex);
                start.wait(lock, [&] { return stop || generation != seen; });
                if (stop) {
                    return;
                }
                seen = generation;
            }
            takeGrains(worker);
            std::lock_guard lock(mutex);
            if (--busy == 0) {
                done.notify_one();
            }
        }
    }

    void runPooled(const Job& new_job) {
        {
            std::lock_guard lock(mutex);
            job = new_job;
            next_grain = 0;
            busy = threads - 1;
            ++generation;
        }
        start.notify_all();
        takeGrains(0);
        std::unique_lock lock(mutex);
        done.wait(lock, [&] { return busy == 0; });
    }

    void runShuffled(const Job& new_job) {
        std::vector<int> order(size_t(new_job.grains()));
        std::iota(order.begin(), order.end(), 0);
        for (size_t i = order.size(); i > 1; --i) {
            std::swap(order[i - 1], order[nextRandom(random) % i]);
        }
        for (int g : order) {
            new_job.runGrain(g, 0);
        }
    }
};

Workers::Workers(int threads, Schedule schedule, uint64_t seed)
    : state_(std::make_unique<State>()) {
    assert(threads >= 1);
    state_->threads = schedule == Schedule::pooled ? threads : 1;
    state_->schedule = schedule;
    state_->random = seed;
    for (int worker = 1; worker < state_->threads; ++worker) {
        state_->pool.emplace_back([s = state_.get(), worker] { s->poolThread(worker); });
    }
}

Workers::~Workers() {
    {
        std::lock_guard lock(state_->mutex);
        state_->stop = true;
    }
    state_->start.notify_all();
    for (std::thread& thread : state_->pool) {
        thread.join();
    }
}

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
    const std::lock_guard turn(state_->turn);
    if (state_->schedule == Schedule::shuffled) {
        state_->runShuffled(job);
    } else if (state_->threads == 1 || job.grains() <= 1) {
        for (int g = 0; g < job.grains(); ++g) {
            job.runGrain(g, 0);
        }
    } else {
        state_->runPooled(job);
    }
}

}  // namespace still
