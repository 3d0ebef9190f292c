#include "demos/stillframe/bench_scaling.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <numeric>
#include <queue>

namespace still::command {
namespace {

/// When the last of `workers` is done with a section's grains.
double makespanMs(const std::vector<double>& grains_ms, int workers) {
    std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
    for (int i = 0; i < workers; ++i) {
        free_at.push(0);
    }
    double end_ms = 0;
    for (double grain_ms : grains_ms) {
        const double done_ms = free_at.top() + grain_ms;
        free_at.pop();
        free_at.push(done_ms);
        end_ms = std::max(end_ms, done_ms);
    }
    return end_ms;
}

double sumOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

double workMs(const FrameWork& frame) {
    double sum_ms = frame.serial_ms;
    for (const auto& section : frame.sections) {
        sum_ms += sumOf(section);
    }
    return sum_ms;
}

double spanMs(const FrameWork& frame) {
    double sum_ms = frame.serial_ms;
    for (const auto& section : frame.sections) {
        sum_ms += section.empty() ? 0.0 : *std::max_element(section.begin(), section.end());
    }
    return sum_ms;
}

double simulatedMs(const FrameWork& frame, int workers) {
    double sum_ms = frame.serial_ms;
    for (const auto& section : frame.sections) {
        sum_ms += makespanMs(section, workers);
    }
    return sum_ms;
}

double threadTimeMs() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
}

void WorkRecorder::beginFrame() {
    frame_ = {};
    frame_start_ms_ = threadTimeMs();
}

FrameWork WorkRecorder::endFrame() {
    const double all_ms = threadTimeMs() - frame_start_ms_;
    frame_.serial_ms = 0;
    frame_.serial_ms = std::max(0.0, all_ms - workMs(frame_));
    return std::move(frame_);
}

void WorkRecorder::sectionBegins(int grains) {
    frame_.sections.emplace_back(size_t(grains), 0.0);
}

void WorkRecorder::grainBegins(int) {
    grain_start_ms_ = threadTimeMs();
}

void WorkRecorder::grainEnds(int grain) {
    frame_.sections.back()[size_t(grain)] = threadTimeMs() - grain_start_ms_;
}

}  // namespace still::command
