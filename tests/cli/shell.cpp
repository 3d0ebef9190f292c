#include "tests/cli/shell.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

extern char** environ;

namespace still::test {
namespace {

/// Both ends of a pipe.
struct Pipe {
    int read = -1, write = -1;
    Pipe() {
        int ends[2] = {-1, -1};
        if (pipe2(ends, O_CLOEXEC) == 0) {
            read = ends[0];
            write = ends[1];
        }
    }
    ~Pipe() {
        close(read);
        closeWrite();
    }
    void closeWrite() {
        close(write);
        write = -1;
    }
};

/// Reads both until both have ended, whichever has something.
void readBoth(int out_end, std::string& out, int err_end, std::string& err) {
    std::array<pollfd, 2> ends{pollfd{out_end, POLLIN, 0}, pollfd{err_end, POLLIN, 0}};
    const std::array<std::string*, 2> texts{&out, &err};
    for (int open = 2; open > 0;) {
        poll(ends.data(), ends.size(), -1);
        for (size_t i = 0; i < ends.size(); ++i) {
            if (ends[i].fd < 0 || ends[i].revents == 0) {
                continue;
            }
            std::array<char, 65536> buffer;
            const ssize_t count = read(ends[i].fd, buffer.data(), buffer.size());
            if (count > 0) {
                texts[i]->append(buffer.data(), size_t(count));
            } else {
                ends[i].fd = -1;
                --open;
            }
        }
    }
}

}  // namespace

Ran shell(const std::filesystem::path& folder, const std::string& command) {
    const std::string script =
        "cd '" + folder.string() + "' && stillframe() { '" STILL_PROGRAM "' \"$@\"; }\n" + command;
    Pipe out, err;
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, out.write, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, err.write, STDERR_FILENO);
    std::string sh = "sh", option = "-c", text = script;
    char* arguments[] = {sh.data(), option.data(), text.data(), nullptr};
    pid_t pid = -1;
    Ran ran;
    const int error = posix_spawnp(&pid, "sh", &files, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&files);
    out.closeWrite();
    err.closeWrite();
    if (error != 0) {
        return {127, "", "no shell"};
    }
    readBoth(out.read, ran.out, err.read, ran.err);
    int status = 0;
    waitpid(pid, &status, 0);
    ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return ran;
}

std::vector<std::string> filesIn(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string contentsOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

bool isOneErrorLine(const std::string& text) {
    return text.starts_with("stillframe: ") && text.find('\n') == text.size() - 1;
}

}  // namespace still::test
