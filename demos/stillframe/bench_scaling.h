#pragma once
// How a frame would scale: the time of every task is recorded, and any number of workers is then
// given the tasks in the order in which the real pool hands them out.

#include <vector>

#include "rasterizer/workers.h"

namespace still::command {

/// One frame as a sequence of sections (parallelFor) with serial code between them.
struct FrameWork {
    double serial_ms = 0;                       ///< outside of all sections
    std::vector<std::vector<double>> sections;  ///< milliseconds of each grain
};

/// All of it: what one worker takes.
double workMs(const FrameWork& frame);
/// The critical path: what no number of workers goes below.
double spanMs(const FrameWork& frame);
/// With `workers` ≥ 1: in each section, grains are taken in order by whoever is free.
double simulatedMs(const FrameWork& frame, int workers);

/// Processor time of the calling thread: a task is not charged for what else the machine does.
double threadTimeMs();

/// Records frames that run on one thread.
class WorkRecorder final : public WorkObserver {
  public:
    void beginFrame();
    FrameWork endFrame();

    void sectionBegins(int grains) override;
    void grainBegins(int grain) override;
    void grainEnds(int grain) override;

  private:
    FrameWork frame_;
    double frame_start_ms_ = 0, grain_start_ms_ = 0;
};

}  // namespace still::command
