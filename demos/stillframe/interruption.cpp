#include "demos/stillframe/interruption.h"

#include <sys/wait.h>
#include <unistd.h>

#include <system_error>

namespace still::command {

Interruption::Interruption() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    sigemptyset(&signals_);
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler != SIG_IGN) {
            sigaddset(&signals_, signal);
        }
    }
    sigaddset(&signals_, SIGUSR1);  // how the destructor wakes the waiting thread
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    waiter_ = std::thread([this] { wait(); });
}

Interruption::~Interruption() {
    finished_ = true;
    pthread_kill(waiter_.native_handle(), SIGUSR1);
    waiter_.join();
}

void Interruption::addFile(const std::filesystem::path& file) {
    const std::lock_guard lock(mutex_);
    files_.insert(file);
}

void Interruption::forgetFile(const std::filesystem::path& file) {
    const std::lock_guard lock(mutex_);
    files_.erase(file);
}

void Interruption::setChild(std::optional<pid_t> child) {
    const std::lock_guard lock(mutex_);
    child_ = child;
}

void Interruption::wait() {
    int signal = 0;
    sigwait(&signals_, &signal);
    if (finished_) {
        return;
    }
    // The lock is never given back: nothing may be begun or finished between here and the end.
    mutex_.lock();
    cleanUp();
    std::signal(signal, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
    raise(signal);
}

void Interruption::endProcess(const std::string& line, int code) {
    mutex_.lock();  // as above
    cleanUp();
    // Nothing could be done about an error.
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
    _exit(code);
}

void Interruption::cleanUp() {
    if (child_) {
        kill(*child_, SIGKILL);
        waitpid(*child_, nullptr, 0);
    }
    for (const std::filesystem::path& file : files_) {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
    }
}

}  // namespace still::command
