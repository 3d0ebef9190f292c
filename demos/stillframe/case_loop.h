#pragma once
// Frames of a case, on the calling thread.

#include "demos/stillframe/cell.h"

namespace still::command {

/// A frame loop whose size follows the case. What it is given must outlive it.
class CaseLoop {
  public:
    CaseLoop(const AtlasCase& atlas, const Scene& scene, const FrameSettings& settings)
        : atlas_(atlas),
          full_{settings.width, settings.height},
          size_(full_),
          workers_(1, Schedule::serial),
          loop_(scene, settings, workers_) {}

    FrameResult render(int frame) {
        const Size size = sizeAt(atlas_, full_, frame);
        if (size.width != size_.width || size.height != size_.height) {
            loop_.resize(size.width, size.height);
            size_ = size;
        }
        return loop_.render(frame);
    }

  private:
    const AtlasCase& atlas_;
    Size full_, size_;
    Workers workers_;
    FrameLoop loop_;
};

}  // namespace still::command
