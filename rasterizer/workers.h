#pragma once
// A pool of threads that cuts [0, count) into constant grains. Work is never cut by the number of
// threads, so serial, pooled and shuffled runs hand the very same ranges to the tasks.

#include <cstdint>
#include <memory>
#include <type_traits>

namespace still {

enum class Schedule {
    pooled,    ///< grains are taken in order by whichever thread is free
    serial,    ///< grains run in order on the calling thread
    shuffled,  ///< grains run on the calling thread in a seeded random order (order-stress tests)
};

/// Is told about the work while it happens, by the thread that does it; for measurements.
class WorkObserver {
  public:
    /// A parallelFor of so many grains is about to start.
    virtual void sectionBegins(int grains) = 0;
    virtual void grainBegins(int grain) = 0;
    virtual void grainEnds(int grain) = 0;

  protected:
    ~WorkObserver() = default;
};

/// Its place must not change: whoever uses it keeps a reference.
class Workers {
  public:
    /// threads ≥ 1 counts the calling thread; serial and shuffled use one thread only, and so does
    /// everything in builds for boards.
    explicit Workers(int threads, Schedule schedule = Schedule::pooled, uint64_t seed = 0);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// Number of different values `worker` can take in a task.
    int threads() const;

    /// Calls task(begin, end, worker) for every grain [begin, end) of [0, count), each exactly
    /// once, and returns when all are done. `worker` only selects scratch memory; a result must not
    /// depend on it. Tasks must not throw and must not call parallelFor. Order is unspecified.
    /// Calls from several threads take turns.
    template <class Task>
    void parallelFor(int count, int grain, Task&& task) {
        using Body = std::remove_reference_t<Task>;
        run(
            count, grain,
            [](void* body, int begin, int end, int worker) {
                (*static_cast<Body*>(body))(begin, end, worker);
            },
            const_cast<void*>(static_cast<const void*>(&task)));
    }

    /// From now on, until it is null. Not while a parallelFor runs.
    void observe(WorkObserver* observer);

  private:
    using Call = void (*)(void* body, int begin, int end, int worker);
    void run(int count, int grain, Call call, void* body);

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace still
