#include "demos/stillframe/memory_limit.h"

#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "engine/memory_need.h"

namespace still::command {
namespace {

/// What the handlers need, which are plain functions: made beforehand, because there is no memory
/// when the line is wanted.
struct Ending {
    Interruption* interruption = nullptr;
    std::string no_memory;
    std::new_handler new_handler = nullptr;
    std::terminate_handler terminate_handler = nullptr;
};
Ending ending;

std::string lineOf(const Failure& failure) {
    return "stillframe: " + failure.message + "\n";
}

[[noreturn]] void endWithoutMemory() {
    ending.interruption->endProcess(ending.no_memory, int(ExitCode::file_error));
}

[[noreturn]] void endByException() {
    Failure failure{ExitCode::file_error, "an error that nobody expected"};
    try {
        if (const std::exception_ptr current = std::current_exception()) {
            std::rethrow_exception(current);
        }
    } catch (const std::exception& exception) {
        failure = failureOf(exception);
    } catch (...) {
    }
    ending.interruption->endProcess(lineOf(failure), int(failure.code));
}

void setSoftLimit(uint64_t bytes) {
    rlimit limit{};
    if (getrlimit(RLIMIT_DATA, &limit) == 0) {
        limit.rlim_cur = std::min(rlim_t(bytes), limit.rlim_max);
        setrlimit(RLIMIT_DATA, &limit);
    }
}

uint64_t softLimit() {
    rlimit limit{};
    return getrlimit(RLIMIT_DATA, &limit) == 0 ? uint64_t(limit.rlim_cur) : uint64_t(RLIM_INFINITY);
}

}  // namespace

Failure failureOf(const std::exception& exception) {
    if (dynamic_cast<const std::bad_alloc*>(&exception) != nullptr) {
        return {ExitCode::file_error, "not enough memory"};
    }
    if (dynamic_cast<const std::system_error*>(&exception) != nullptr) {
        return {ExitCode::file_error, std::string("cannot start a thread: ") + exception.what() +
                                          "; fewer --threads or more --max-memory may do"};
    }
    return {ExitCode::file_error,
            std::string("an error that nobody expected: ") + exception.what()};
}

MemoryLimit::MemoryLimit(uint64_t max_bytes, Interruption& interruption) {
    ending.interruption = &interruption;
    ending.no_memory =
        lineOf({ExitCode::file_error, "not enough memory: at most " + bytesText(max_bytes) +
                                          " are allowed (--max-memory)"});
    if (kCapsMemory) {
        setSoftLimit(std::min(max_bytes, softLimit()));
    }
    ending.new_handler = std::set_new_handler(endWithoutMemory);
    ending.terminate_handler = std::set_terminate(endByException);
}

MemoryLimit::~MemoryLimit() {
    std::set_new_handler(ending.new_handler);
    std::set_terminate(ending.terminate_handler);
}

MemoryLimitPause::MemoryLimitPause() : soft_bytes_(softLimit()) {
    setSoftLimit(uint64_t(RLIM_INFINITY));
}

MemoryLimitPause::~MemoryLimitPause() {
    setSoftLimit(soft_bytes_);
}

}  // namespace still::command
