#include "demos/stillframe/video_pipe.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "demos/stillframe/memory_limit.h"

extern char** environ;

namespace still::command {
namespace {

std::vector<std::string> ffmpegArguments(const std::filesystem::path& target, int width, int height,
                                         int fps) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    // Without -xerror ffmpeg ends happily when the disk is full.
    return {"ffmpeg", "-loglevel", "error", "-xerror", "-y",
            // in
            "-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", size, "-framerate",
            std::to_string(fps), "-i", "pipe:0",
            // out; players take video of this kind for BT.709, so that is what it must be
            "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
            "-c:v", "libx264", "-crf", "16", "-pix_fmt", "yuv420p", "-colorspace", "bt709",
            "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-movflags", "+faststart",
            "-f", "mp4", "file:" + target.string()};
}

/// Signals as they are in an ordinary process, and out of reach of the terminal's Ctrl-C: we end
/// the child ourselves.
class SpawnSettings {
  public:
    SpawnSettings(int input, int messages, const sigset_t& blocked) {
        posix_spawn_file_actions_init(&files_);
        posix_spawn_file_actions_adddup2(&files_, input, STDIN_FILENO);
        posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&files_, messages, STDERR_FILENO);
        sigset_t defaults = blocked;
        sigaddset(&defaults, SIGPIPE);
        sigaddset(&defaults, SIGXFSZ);
        sigset_t none;
        sigemptyset(&none);
        posix_spawnattr_init(&attributes_);
        posix_spawnattr_setsigdefault(&attributes_, &defaults);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setpgroup(&attributes_, 0);
        posix_spawnattr_setflags(
            &attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    }
    ~SpawnSettings() {
        posix_spawnattr_destroy(&attributes_);
        posix_spawn_file_actions_destroy(&files_);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;

    /// 0 or an errno value.
    int run(pid_t& pid, std::vector<std::string> arguments) const {
        std::vector<char*> pointers;
        for (std::string& argument : arguments) {
            pointers.push_back(argument.data());
        }
        pointers.push_back(nullptr);
        return posix_spawnp(&pid, pointers[0], &files_, &attributes_, pointers.data(), environ);
    }

  private:
    posix_spawn_file_actions_t files_;
    posix_spawnattr_t attributes_;
};

std::string firstLine(std::FILE* stream) {
    std::rewind(stream);
    char line[400] = "";
    if (std::fgets(line, sizeof line, stream) == nullptr) {
        return "it gave no reason";
    }
    line[std::strcspn(line, "\r\n")] = '\0';
    return line;
}

}  // namespace

int VideoPipe::Child::wait() {
    // First without reaping: until it is reaped nobody else can get its number.
    siginfo_t info{};
    waitid(P_PID, id_t(pid), &info, WEXITED | WNOWAIT);
    interruption.setChild(std::nullopt);
    int status = 0;
    waitpid(pid, &status, 0);
    pid = -1;
    return status;
}

VideoPipe::Child::~Child() {
    if (pid > 0) {
        kill(pid, SIGKILL);
        wait();
    }
}

VideoPipe::VideoPipe(std::filesystem::path name, Stream frames, Stream messages,
                     std::unique_ptr<Child> child)
    : name_(std::move(name)),
      frames_(std::move(frames)),
      messages_(std::move(messages)),
      child_(std::move(child)) {}

VideoPipe::~VideoPipe() = default;

Outcome<VideoPipe> VideoPipe::start(const std::filesystem::path& target,
                                    const std::filesystem::path& name, int width, int height,
                                    int fps, Interruption& interruption) {
    Stream messages(std::tmpfile());
    int ends[2];
    if (messages == nullptr || pipe2(ends, O_CLOEXEC) != 0) {
        return fileError(name.string() + ": cannot start ffmpeg: " + std::strerror(errno));
    }
    Stream frames(fdopen(ends[1], "wb"));
    const SpawnSettings settings(ends[0], fileno(messages.get()), interruption.signals());
    pid_t pid = -1;
    const int error = [&] {
        const MemoryLimitPause pause;
        return settings.run(pid, ffmpegArguments(target, width, height, fps));
    }();
    close(ends[0]);
    if (error == ENOENT) {
        return fileError(name.string() +
                         ": MP4 needs the ffmpeg program, which was not found; install it, or "
                         "write .gif or .png instead");
    }
    if (error != 0) {
        return fileError(name.string() + ": cannot start ffmpeg: " + std::strerror(error));
    }
    interruption.setChild(pid);
    return VideoPipe(name, std::move(frames), std::move(messages),
                     std::unique_ptr<Child>(new Child{pid, interruption}));
}

Outcome<void> VideoPipe::add(ImageView<const Rgb8> image) {
    for (int y = 0; y < image.height; ++y) {
        const size_t count = size_t(image.width);
        if (std::fwrite(image.row(y), sizeof(Rgb8), count, frames_.get()) != count) {
            return failure();
        }
    }
    return {};
}

Outcome<void> VideoPipe::finish() {
    if (std::fclose(frames_.release()) != 0) {
        return failure();
    }
    const int status = child_->wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        return failure();
    }
    return {};
}

/// Lets ffmpeg end by itself, so that its message is there.
tl::unexpected<Failure> VideoPipe::failure() {
    frames_.reset();
    if (child_->pid > 0) {
        child_->wait();
    }
    return fileError(name_.string() + ": ffmpeg failed: " + firstLine(messages_.get()));
}

}  // namespace still::command
