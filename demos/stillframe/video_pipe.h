#pragma once
// MP4 through the ffmpeg program: raw frames go into its standard input.

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/outcome.h"
#include "rasterizer/image.h"

namespace still::command {

/// A running ffmpeg. It is started directly, without a shell; its messages go to a file of ours,
/// from which an error takes the first line.
class VideoPipe {
  public:
    /// Encodes H.264 (BT.709, 4:2:0; odd sizes get a black row or column) into `target`, which may
    /// exist; messages speak of `name`. `interruption` must outlive the object.
    static Outcome<VideoPipe> start(const std::filesystem::path& target,
                                    const std::filesystem::path& name, int width, int height,
                                    int fps, Interruption& interruption);
    VideoPipe(VideoPipe&&) = default;
    VideoPipe& operator=(VideoPipe&&) = delete;
    ~VideoPipe();

    Outcome<void> add(ImageView<const Rgb8> image);
    /// Ends the stream and waits until ffmpeg has written the file.
    Outcome<void> finish();

  private:
    struct Close {
        void operator()(std::FILE* stream) const { std::fclose(stream); }
    };
    using Stream = std::unique_ptr<std::FILE, Close>;
    /// Killed, if it still runs, when this goes.
    struct Child {
        pid_t pid;
        Interruption& interruption;
        ~Child();
        int wait();
    };

    VideoPipe(std::filesystem::path name, Stream frames, Stream messages,
              std::unique_ptr<Child> child);
    tl::unexpected<Failure> failure();

    std::filesystem::path name_;
    Stream frames_, messages_;
    std::unique_ptr<Child> child_;
};

}  // namespace still::command
