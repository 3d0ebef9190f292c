#pragma once
// Ctrl-C, TERM and HUP: what is unfinished is taken away before the process ends by the signal.

#include <sys/types.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace still::command {

/// Make one before any other thread. The signals are blocked in all threads and taken by one of its
/// own, which may therefore lock and unlink like any ordinary code. Signals that were ignored when
/// the process started stay ignored. SIGPIPE and SIGXFSZ are ignored from here on, so that a write
/// fails with an error instead of killing the process.
class Interruption {
  public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// Files to remove when interrupted.
    void addFile(const std::filesystem::path& file);
    void forgetFile(const std::filesystem::path& file);
    /// A child process to kill when interrupted; nothing forgets it.
    void setChild(std::optional<pid_t> child);

    /// Ends the process as a signal would, but with a line for standard error and an exit code.
    /// Takes no memory.
    [[noreturn]] void endProcess(const std::string& line, int code);

    /// The signals this object waits for, as they are to be unblocked in a child process.
    const sigset_t& signals() const { return signals_; }

  private:
    void wait();
    void cleanUp();

    sigset_t signals_{};
    std::atomic<bool> finished_ = false;
    std::recursive_mutex mutex_;  ///< endProcess() may be called from within addFile()
    std::set<std::filesystem::path> files_;
    std::optional<pid_t> child_;
    std::thread waiter_;
};

}  // namespace still::command
