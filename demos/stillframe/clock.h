#pragma once
// Wall time, for reports only: no pixel depends on it.

#include <chrono>
#include <cstdint>

namespace still::command {

inline double nowMs() {
    using Milliseconds = std::chrono::duration<double, std::milli>;
    return Milliseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The same in nanoseconds, as FrameSettings::ticks takes it.
inline uint64_t nowTicks() {
    return uint64_t(std::chrono::steady_clock::now().time_since_epoch() /
                    std::chrono::nanoseconds(1));
}

}  // namespace still::command
