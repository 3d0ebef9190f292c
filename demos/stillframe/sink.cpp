#include "demos/stillframe/sink.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "demos/stillframe/gif.h"
#include "demos/stillframe/output_file.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/video_pipe.h"

namespace still::command {
namespace {

class NoSink : public Sink {
  public:
    Outcome<void> add(int, ImageView<const Rgb8>) override { return {}; }
    Outcome<void> finish() override { return {}; }
};

class StandardOutputSink : public Sink {
  public:
    Outcome<void> add(int, ImageView<const Rgb8> image) override {
        return writePng(stdout, "standard output", image);
    }
    Outcome<void> finish() override { return {}; }
};

class PngSink : public Sink {
  public:
    PngSink(NamePattern name, Interruption& interruption)
        : name_(std::move(name)), interruption_(interruption) {}
    Outcome<void> add(int frame, ImageView<const Rgb8> image) override {
        return savePng(name_.at(frame), image, interruption_);
    }
    Outcome<void> finish() override { return {}; }

  private:
    NamePattern name_;
    Interruption& interruption_;
};

class GifSink : public Sink {
  public:
    GifSink(OutputFile file, const SinkSettings& settings)
        : file_(std::move(file)),
          writer_(file_.stream(), settings.width, settings.height, settings.fps) {}
    Outcome<void> add(int, ImageView<const Rgb8> image) override {
        writer_.add(image);
        if (std::ferror(file_.stream()) != 0) {
            return fileError(systemMessage(file_.path(), "cannot write"));
        }
        return {};
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
    Outcome<void> add(int, ImageView<const Rgb8> image) override { return pipe_.add(image); }
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

SinkOutcome openGif(const SinkSettings& settings, Interruption& interruption) {
    return OutputFile::create(settings.name.at(0), interruption)
        .and_then([&](OutputFile file) -> SinkOutcome {
            return std::make_unique<GifSink>(std::move(file), settings);
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
    if (extension == ".png") {
        return SinkKind::png;
    }
    if (extension == ".gif") {
        return SinkKind::gif;
    }
    if (extension == ".mp4") {
        return SinkKind::mp4;
    }
    return usageError("--output: " + output +
                      ": expected a name that ends in .png, .gif or .mp4, "
                      "or - for standard output");
}

SinkOutcome openSink(const SinkSettings& settings, Interruption& interruption) {
    switch (settings.kind) {
        case SinkKind::none:
            return std::make_unique<NoSink>();
        case SinkKind::standard_output:
            return std::make_unique<StandardOutputSink>();
        case SinkKind::png:
            return openPng(settings, interruption);
        case SinkKind::gif:
            return openGif(settings, interruption);
        case SinkKind::mp4:
            return openVideo(settings, interruption);
    }
    return usageError("unknown output");
}

}  // namespace still::command
