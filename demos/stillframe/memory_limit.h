#pragma once
// A cap on the memory of the process, and how it ends when memory or threads do not suffice.

#include <cstdint>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/outcome.h"

namespace still::command {

// Sanitizers map terabytes of shadow memory, which would count.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCapsMemory = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kCapsMemory = false;
#else
constexpr bool kCapsMemory = true;
#endif
#else
constexpr bool kCapsMemory = true;
#endif

/// What is told about an exception of the standard library's; nothing of ours throws.
Failure failureOf(const std::exception& exception);

/// There is one at a time, made before any thread that works. While it lives, the system gives the
/// process at most so many bytes for data (Linux; stacks of threads count, too). Where memory does
/// not suffice, the process ends at once: unfinished files are taken away, one line says why, the
/// exit code is ExitCode::file_error. Nothing is unwound, because other threads may be at work on
/// what would go. Exceptions that nobody catches end it likewise.
class MemoryLimit {
  public:
    MemoryLimit(uint64_t max_bytes, Interruption& interruption);
    ~MemoryLimit();
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;
};

/// Lifts the cap while it lives, for the start of programs that are not ours.
class MemoryLimitPause {
  public:
    MemoryLimitPause();
    ~MemoryLimitPause();
    MemoryLimitPause(const MemoryLimitPause&) = delete;
    MemoryLimitPause& operator=(const MemoryLimitPause&) = delete;

  private:
    uint64_t soft_bytes_ = 0;
};

}  // namespace still::command
