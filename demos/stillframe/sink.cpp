#include "demos/stillframe/sink.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "demos/stillframe/apng.h"
#include "demos/stillframe/gif.h"
#include "demos/stillframe/output_file.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/video_pipe.h"
#include "demos/stillframe/y4m.h"

namespace still::command {
namespace {

class NoSink : public Sink {
  public:
    Outcome<void> add(int, const Picture&) override { return {}; }
    Outcome<void> finish() override { return {}; }
};

class StandardOutputSink : public Sink {
  public:
    Outcome<void> add(int, const Picture& picture) override {
        return writePng(stdout, "standard output", picture);
    }
    Outcome<void> finish() override { return {}; }
};

class PngSink : public Sink {
  public:
    PngSink(NamePattern name, Interruption& interruption)
        : name_(std::move(name)), interruption_(interruption) {}
    Outcome<void> add(int frame, const Picture& picture) override {
        return savePng(name_.at(frame), picture, interruption_);
    }
    Outcome<void> finish() override { return {}; }

  private:
    NamePattern name_;
    Interruption& interruption_;
};

Outcome<void> checked(std::FILE* stream, const std::filesystem::path& name) {
    if (std::ferror(stream) != 0) {
        return fileError(systemMessage(name, "cannot write"));
    }
    return {};
}

class ApngSink : public Sink {
  public:
    ApngSink(OutputFile file, const SinkSettings& settings)
        : file_(std::move(file)), writer_(file_.stream(), settings.frames, settings.fps) {}
    Outcome<void> add(int, const Picture& picture) override {
        return writer_.add(picture).and_then([&] { return checked(file_.stream(), file_.path()); });
    }
    Outcome<void> finish() override {
        writer_.finish();
        return file_.commit();
    }

  private:
    OutputFile file_;
    ApngWriter writer_;
};

class Y4mSink : public Sink {
  public:
    Y4mSink(OutputFile file, const SinkSettings& settings)
        : file_(std::move(file)),
          writer_(file_.stream(), settings.width, settings.height, settings.fps) {}
    Outcome<void> add(int, const Picture& picture) override {
        writer_.add(picture.opaque);
        return checked(file_.stream(), file_.path());
    }
    Outcome<void> finish() override { return file_.commit(); }

  private:
    OutputFile file_;
    Y4mWriter writer_;
};

/// Frames go down the pipe as they are made.
class Y4mPipeSink : public Sink {
  public:
    explicit Y4mPipeSink(const SinkSettings& settings)
        : writer_(stdout, settings.width, settings.height, settings.fps) {}
    Outcome<void> add(int, const Picture& picture) override {
        writer_.add(picture.opaque);
        std::fflush(stdout);
        return checked(stdout, "standard output");
    }
    Outcome<void> finish() override { return {}; }

  private:
    Y4mWriter writer_;
};

class GifSink : public Sink {
  public:
    GifSink(OutputFile file, const SinkSettings& settings)
        : file_(std::move(file)),
          writer_(file_.stream(), settings.width, settings.height, settings.fps) {}
    Outcome<void> add(int, const Picture& picture) override {
        writer_.add(picture.opaque);
        return checked(file_.stream(), file_.path());
    }
    Outcome<void> finish() override {
        writer_.finish();
        return file_.commit();
    }

  private:
    OutputFile file_;
    GifWriter writer_;
};

class VideoSink : public Sink {
  public:
    VideoSink(OutputFile file, VideoPipe pipe) : file_(std::move(file)), pipe_(std::move(pipe)) {}
    Outcome<void> add(int, const Picture& picture) override { return pipe_.add(picture.opaque); }
    Outcome<void> finish() override {
        return pipe_.finish().and_then([&] { return file_.commit(); });
    }

  private:
    OutputFile file_;  // first in, last out: the pipe's end is awaited before the file goes
    VideoPipe pipe_;
};

using SinkOutcome = Outcome<std::unique_ptr<Sink>>;

/// Tries the first file, so that an unwritable folder is not found out after a long frame.
SinkOutcome openPng(const SinkSettings& settings, Interruption& interruption) {
    return OutputFile::create(settings.name.at(settings.first_frame), interruption)
        .and_then([&](OutputFile) -> SinkOutcome {
            return std::make_unique<PngSink>(settings.name, interruption);
        });
}

/// A sink whose frames all go into one file of ours.
template <class FileSink>
SinkOutcome openFile(const SinkSettings& settings, Interruption& interruption) {
    return OutputFile::create(settings.name.at(0), interruption)
        .and_then([&](OutputFile file) -> SinkOutcome {
            return std::make_unique<FileSink>(std::move(file), settings);
        });
}

SinkOutcome openVideo(const SinkSettings& settings, Interruption& interruption) {
    return OutputFile::create(settings.name.at(0), interruption)
        .and_then([&](OutputFile file) -> SinkOutcome {
            auto pipe = VideoPipe::start(file.temporary(), file.path(), settings.width,
                                         settings.height, settings.fps, interruption);
            if (!pipe) {
                return tl::make_unexpected(pipe.error());
            }
            return std::make_unique<VideoSink>(std::move(file), std::move(*pipe));
        });
}

}  // namespace

Outcome<SinkKind> sinkKind(const std::string& output) {
    if (output.empty()) {
        return SinkKind::none;
    }
    if (output == "-") {
        return SinkKind::standard_output;
    }
    std::string extension = std::filesystem::path(output).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    constexpr std::pair<const char*, SinkKind> kKinds[] = {{".png", SinkKind::png},
                                                           {".apng", SinkKind::apng},
                                                           {".gif", SinkKind::gif},
                                                           {".mp4", SinkKind::mp4},
                                                           {".y4m", SinkKind::y4m}};
    for (const auto& [name, kind] : kKinds) {
        if (extension == name) {
            return kind;
        }
    }
    return usageError("--output: " + output +
                      ": expected a name that ends in .png, .apng, .gif, .mp4 or .y4m, "
                      "or - for standard output");
}

bool keepsAlpha(SinkKind kind) {
    return kind == SinkKind::png || kind == SinkKind::apng || kind == SinkKind::standard_output;
}

SinkOutcome openSink(const SinkSettings& settings, Interruption& interruption) {
    switch (settings.kind) {
        case SinkKind::none:
            return std::make_unique<NoSink>();
        case SinkKind::standard_output:
            if (settings.frames > 1) {
                return std::make_unique<Y4mPipeSink>(settings);
            }
            return std::make_unique<StandardOutputSink>();
        case SinkKind::png:
            return openPng(settings, interruption);
        case SinkKind::apng:
            return openFile<ApngSink>(settings, interruption);
        case SinkKind::gif:
            return openFile<GifSink>(settings, interruption);
        case SinkKind::mp4:
            return openVideo(settings, interruption);
        case SinkKind::y4m:
            return openFile<Y4mSink>(settings, interruption);
    }
    return usageError("unknown output");
}

}  // namespace still::command
