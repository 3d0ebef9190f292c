#include "demos/stillframe/case_references.h"

#include <algorithm>
#include <memory>

namespace still::command {
namespace {

class ReferenceRun {
  public:
    ReferenceRun(PreparedCase& prepared, size_t segment, int samples, const FileCache& cache,
                 Workers& workers, const std::function<void()>& advance)
        : prepared_(prepared),
          frames_(comparedFrames(prepared.atlas->segments[segment])),
          compared_(prepared.segments[segment]),
          samples_(std::min(prepared.atlas->segments[segment].ssaa_samples, samples)),
          cache_(cache),
          workers_(workers),
          advance_(advance),
          keys_(frames_.size()),
          outcomes_(frames_.size()) {
        compared_.resize(frames_.size());
    }
    Outcome<void> run();

  private:
    std::unique_ptr<ReferenceMaker> maker(Workers& workers) const {
        return std::make_unique<ReferenceMaker>(prepared_.scene, prepared_.view, samples_, cache_,
                                                workers);
    }
    void resize(ReferenceMaker& maker, int frame) const {
        const Size full{prepared_.view.width, prepared_.view.height};
        const Size size = sizeAt(*prepared_.atlas, full, frame);
        maker.resize(size.width, size.height);
    }
    void make(ReferenceMaker& maker, size_t i);
    std::vector<size_t> different() const;
    template <class Task>
    void forEach(const std::vector<size_t>& places, Task&& task);

    PreparedCase& prepared_;
    std::vector<int> frames_;
    std::vector<CaseFrame>& compared_;
    int samples_;
    const FileCache& cache_;
    Workers& workers_;
    const std::function<void()>& advance_;
    std::vector<uint64_t> keys_;
    std::vector<Outcome<void>> outcomes_;
};

void ReferenceRun::make(ReferenceMaker& maker, size_t i) {
    resize(maker, frames_[i]);
    outcomes_[i] = maker.make(frames_[i]).map([&](Reference reference) {
        compared_[i] = {frames_[i], std::move(reference), {}};
    });
}

/// The first frame of each picture.
std::vector<size_t> ReferenceRun::different() const {
    std::vector<size_t> places;
    for (size_t i = 0; i < keys_.size(); ++i) {
        const auto known = keys_.begin() + ptrdiff_t(i);
        if (std::find(keys_.begin(), known, keys_[i]) == known) {
            places.push_back(i);
        }
    }
    return places;
}

/// A picture on each thread; few pictures one after the other, each on all threads.
template <class Task>
void ReferenceRun::forEach(const std::vector<size_t>& places, Task&& task) {
    if (places.size() < 2 * size_t(workers_.threads())) {
        const auto together = maker(workers_);
        for (size_t place : places) {
            task(*together, place);
        }
        return;
    }
    Workers alone(1, Schedule::serial);
    std::vector<std::unique_ptr<ReferenceMaker>> makers(size_t(workers_.threads()));
    workers_.parallelFor(int(places.size()), 1, [&](int begin, int, int worker) {
        auto& own = makers[size_t(worker)];
        if (!own) {
            own = maker(alone);
        }
        task(*own, places[size_t(begin)]);
    });
}

Outcome<void> ReferenceRun::run() {
    std::vector<size_t> all(frames_.size());
    for (size_t i = 0; i < all.size(); ++i) {
        all[i] = i;
    }
    forEach(all, [&](ReferenceMaker& maker, size_t i) {
        resize(maker, frames_[i]);
        keys_[i] = maker.keyOf(frames_[i]);
    });
    // What two frames share is made once, and then found in the cache.
    forEach(different(), [&](ReferenceMaker& maker, size_t i) { make(maker, i); });
    forEach(all, [&](ReferenceMaker& maker, size_t i) {
        if (outcomes_[i] && compared_[i].reference.picture.empty()) {
            make(maker, i);
        }
        advance_();
    });
    const auto failed = std::find_if(outcomes_.begin(), outcomes_.end(),
                                     [](const Outcome<void>& outcome) { return !outcome; });
    return failed == outcomes_.end() ? Outcome<void>() : *failed;
}

}  // namespace

Outcome<void> makeReferences(PreparedCase& prepared, size_t segment, int samples,
                             const FileCache& cache, Workers& workers,
                             const std::function<void()>& advance) {
    return ReferenceRun(prepared, segment, samples, cache, workers, advance).run();
}

}  // namespace still::command
