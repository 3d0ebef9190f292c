// The pool hands out every grain once, whatever the schedule.

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rasterizer/workers.h"

using namespace still;

namespace {

struct Range {
    int begin, end;
};

/// Runs one parallelFor and returns the grains in the order in which they came.
std::vector<Range> grains(Workers& workers, int count, int grain) {
    std::mutex mutex;
    std::vector<Range> seen;
    workers.parallelFor(count, grain, [&](int begin, int end, int) {
        std::lock_guard lock(mutex);
        seen.push_back({begin, end});
    });
    return seen;
}

/// Empty, or what is wrong.
std::string checkOnce(const std::vector<Range>& seen, int count, int grain) {
    std::vector<int> hits(size_t(count), 0);
    for (const Range& r : seen) {
        if (r.begin % grain != 0 || r.end != std::min(r.begin + grain, count)) {
            return "a grain is cut elsewhere than at a multiple";
        }
        for (int k = r.begin; k < r.end; ++k) {
            ++hits[size_t(k)];
        }
    }
    for (int hit : hits) {
        if (hit != 1) {
            return "an index was handed out " + std::to_string(hit) + " times";
        }
    }
    return {};
}

}  // namespace

TEST_CASE("workers: each index is handed out once for any threads and schedule", "[workers]") {
    const Schedule schedule = GENERATE(Schedule::pooled, Schedule::serial, Schedule::shuffled);
    const int threads = GENERATE(1, 2, 3, 8);
    Workers workers(threads, schedule, 7);
    for (int count : {0, 1, 2, 7, 64, 1000}) {
        for (int grain : {1, 3, 64, 5000}) {
            CAPTURE(int(schedule), threads, count, grain);
            CHECK(checkOnce(grains(workers, count, grain), count, grain) == "");
        }
    }
}

TEST_CASE("workers: worker numbers stay below threads()", "[workers]") {
    const Schedule schedule = GENERATE(Schedule::pooled, Schedule::serial, Schedule::shuffled);
    Workers workers(3, schedule);
    CHECK(workers.threads() == (schedule == Schedule::pooled ? 3 : 1));
    std::atomic<bool> ok{true};
    workers.parallelFor(500, 1, [&](int, int, int worker) {
        if (worker < 0 || worker >= workers.threads()) {
            ok = false;
        }
    });
    CHECK(ok);
}

TEST_CASE("workers: two grains never share a worker number at the same time", "[workers]") {
    Workers workers(8);
    std::vector<std::atomic<int>> inside(8);
    std::atomic<bool> ok{true};
    for (int round = 0; round < 50; ++round) {
        workers.parallelFor(100, 1, [&](int, int, int worker) {
            if (inside[size_t(worker)].fetch_add(1) != 0) {
                ok = false;
            }
            inside[size_t(worker)].fetch_sub(1);
        });
    }
    CHECK(ok);
}

TEST_CASE("workers: a seed decides the shuffled order, serial order is ascending", "[workers]") {
    const auto order = [](Schedule schedule, uint64_t seed) {
        Workers workers(1, schedule, seed);
        std::vector<int> begins;
        for (const Range& r : grains(workers, 64, 1)) {
            begins.push_back(r.begin);
        }
        return begins;
    };
    const std::vector<int> ascending = order(Schedule::serial, 0);
    CHECK(std::is_sorted(ascending.begin(), ascending.end()));
    CHECK(order(Schedule::shuffled, 5) == order(Schedule::shuffled, 5));
    CHECK(order(Schedule::shuffled, 5) != order(Schedule::shuffled, 6));
    CHECK(order(Schedule::shuffled, 5) != ascending);
}

TEST_CASE("workers: results are visible when parallelFor has returned", "[workers]") {
    Workers workers(4);
    std::vector<int> values(10000);
    for (int round = 1; round <= 100; ++round) {
        workers.parallelFor(int(values.size()), 16, [&](int begin, int end, int) {
            for (int k = begin; k < end; ++k) {
                values[size_t(k)] += k;
            }
        });
        bool ok = true;
        for (size_t k = 0; k < values.size(); ++k) {
            ok = ok && values[k] == int(k) * round;
        }
        REQUIRE(ok);
    }
}

TEST_CASE("workers: an observer hears of every grain once, until it is taken away", "[workers]") {
    class Ear final : public WorkObserver {
      public:
        void sectionBegins(int grains) override { sections.push_back(grains); }
        void grainBegins(int grain) override { note(grain, 1); }
        void grainEnds(int grain) override { note(grain, 100); }

        std::vector<int> sections;
        std::vector<int> heard = std::vector<int>(64, 0);

      private:
        void note(int grain, int what) {
            std::lock_guard lock(mutex_);
            heard[size_t(grain)] += what;
        }
        std::mutex mutex_;
    };
    const Schedule schedule = GENERATE(Schedule::pooled, Schedule::serial, Schedule::shuffled);
    const int threads = GENERATE(1, 3);
    Workers workers(threads, schedule, 7);
    Ear ear;
    workers.observe(&ear);
    grains(workers, 190, 3);  // 64 grains
    grains(workers, 1, 3);
    CHECK(ear.sections == std::vector<int>{64, 1});
    CHECK(ear.heard[0] == 202);
    CHECK(std::all_of(ear.heard.begin() + 1, ear.heard.end(),
                      [](int heard) { return heard == 101; }));
    workers.observe(nullptr);
    grains(workers, 190, 3);
    CHECK(ear.sections.size() == 2);
}

TEST_CASE("workers: 1 to 64 of them come and go, with work or without", "[workers]") {
    for (int round = 0; round < 3; ++round) {
        for (int threads = 1; threads <= 64; ++threads) {
            Workers workers(threads);
            CAPTURE(threads);
            if ((threads + round) % 3 != 0) {
                CHECK(checkOnce(grains(workers, threads + round, 1), threads + round, 1) == "");
            }
        }
    }
}

TEST_CASE("workers: threads that share them take turns", "[workers]") {
    const Schedule schedule = GENERATE(Schedule::pooled, Schedule::shuffled);
    Workers workers(3, schedule);
    std::atomic<int> wrong{0};
    const auto sum = [&](int count) {
        for (int round = 0; round < 200; ++round) {
            std::atomic<int> total{0};
            workers.parallelFor(count, 2, [&](int begin, int end, int) {
                for (int k = begin; k < end; ++k) {
                    total += k;
                }
            });
            wrong += total == count * (count - 1) / 2 ? 0 : 1;
        }
    };
    std::vector<std::thread> threads;
    for (int count : {3, 50, 101, 10}) {
        threads.emplace_back(sum, count);
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    CHECK(wrong == 0);
}
