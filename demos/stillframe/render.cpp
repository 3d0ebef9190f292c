#include "demos/stillframe/render.h"

#include <cstdio>
#include <memory>
#include <utility>

#include "demos/stillframe/clock.h"
#include "demos/stillframe/difference.h"
#include "demos/stillframe/dump.h"
#include "demos/stillframe/formatted.h"
#include "demos/stillframe/job.h"
#include "demos/stillframe/matte.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/progress.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/scene_source.h"
#include "demos/stillframe/watch.h"
#include "engine/hash.h"
#include "engine/image_file.h"

namespace still::command {
namespace {

/// Renders a job's frames into its sink and remembers what the report needs.
class Run {
  public:
    Run(const Job& job, Sink& sink, Interruption& interruption);
    Outcome<void> renderFrame(int frame);
    const RenderReport& report() const { return report_; }

  private:
    Outcome<void> compareFrame(int frame, ImageView<const Rgb8> picture, bool& same);
    Outcome<void> writeDumps(int frame, const FrameResult& result);
    OutputTable table() const {
        return OutputTable(job_.settings.tone_map, job_.settings.exposure);
    }

    const Job& job_;
    Sink& sink_;
    Interruption& interruption_;
    Workers workers_;
    FrameLoop loop_;
    std::unique_ptr<FrameLoop> over_white_;  ///< the same over white, for --no-background
    RenderReport report_;
};

Run::Run(const Job& job, Sink& sink, Interruption& interruption)
    : job_(job),
      sink_(sink),
      interruption_(interruption),
      workers_(job.threads),
      loop_(job.scene, job.settings, workers_) {
    if (job.options.no_background) {
        FrameSettings settings = job.settings;
        settings.background = {1.0f, 1.0f, 1.0f};
        over_white_ = std::make_unique<FrameLoop>(job.scene, settings, workers_);
    }
    report_.scene = job.scene_name;
    report_.triangles = job.scene.triangleCount();
    report_.width = job.settings.width;
    report_.height = job.settings.height;
    report_.threads = job.threads;
    report_.simd = job.settings.simd;
    report_.anti_aliasing = job.anti_aliasing;
    report_.preset = job.preset;
    report_.taa = job.options.taa;
    report_.with_hashes = job.options.hash;
    if (job.reference) {
        report_.reference.emplace();
        report_.reference->numbered = job.frames > 1;
    }
}

Outcome<void> Run::renderFrame(int frame) {
    const double start_ms = nowMs();
    const FrameResult result = loop_.render(frame);
    Image<Rgba8> matted;
    Picture picture(result.output);
    if (over_white_) {
        matted = matte(result.linear, over_white_->render(frame).linear, table());
        picture = Picture(std::as_const(matted).view());
    }
    report_.frames.push_back({frame, result.times, nowMs() - start_ms, {}});
    if (job_.options.hash) {
        report_.frames.back().hashes = hashFrame(result.output, *result.gbuffer);
    }
    bool same = false;
    const auto compared =
        job_.reference ? compareFrame(frame, result.output, same) : Outcome<void>();
    if (!compared || same) {
        return compared;
    }
    return sink_.add(frame, picture).and_then([&] { return writeDumps(frame, result); });
}

/// With the reference; a picture of the differences is written where a picture is kept.
Outcome<void> Run::compareFrame(int frame, ImageView<const Rgb8> picture, bool& same) {
    const std::filesystem::path name = job_.reference->at(frame);
    const auto reference = fromResult(readImageFile(name));
    if (!reference) {
        return tl::make_unexpected(reference.error());
    }
    const ImageView<const Rgb8> expected = reference->view();
    if (expected.width != picture.width || expected.height != picture.height) {
        return tl::make_unexpected(
            Failure{ExitCode::differs,
                    formatted("%s: is %dx%d, rendered was %dx%d", name.c_str(), expected.width,
                              expected.height, picture.width, picture.height)});
    }
    const PixelError error = pixelError(expected, picture);
    same = error.identical();
    report_.reference->frames.push_back({frame, error, same ? 1.0 : ssim(expected, picture)});
    if (same || job_.sink == SinkKind::none) {
        return {};
    }
    return savePng(job_.name.planeAt(frame, "diff"), differencePicture(expected, picture).view(),
                   interruption_);
}

Outcome<void> Run::writeDumps(int frame, const FrameResult& result) {
    if (job_.dump.empty()) {
        return {};
    }
    const NamePattern name = job_.frames > 1 ? job_.name.withNumber() : job_.name;
    const auto encoding = std::make_unique<OutputTable>(table());
    for (DumpPlane plane : job_.dump) {
        const Image<Rgb8> picture = pictureOf(plane, result, *encoding);
        const auto path = name.planeAt(frame, dumpName(plane));
        if (auto saved = savePng(path, picture.view(), interruption_); !saved) {
            return saved;
        }
    }
    return {};
}

Outcome<void> renderAll(const Job& job, Run& run) {
    const ProgressBar progress(job.frames, job.options.quiet);
    for (int i = 0; i < job.frames; ++i) {
        if (auto rendered = run.renderFrame(job.start + i); !rendered) {
            return rendered;
        }
        progress.show(i + 1);
    }
    return {};
}

/// One scene. What it was loaded from is watched from before the first frame on.
Outcome<RenderReport> renderScene(const RenderOptions& options, const std::string& scene,
                                  Interruption& interruption, Watch& watch) {
    Job job(options, scene);
    if (auto prepared = prepare(job); !prepared) {
        return tl::make_unexpected(prepared.error());
    }
    if (options.watch) {
        watch.add(job.scene.files);
    }
    if (options.json) {
        job.settings.clock_ms = nowMs;
    }
    const int loops = options.no_background ? 2 : 1;
    if (const auto fits = checkFrameMemory(scene, job.scene, job.settings, options.limits, loops);
        !fits) {
        return tl::make_unexpected(fits.error());
    }
    const SinkSettings sink_settings{job.sink,   job.name,           job.start,
                                     job.frames, job.settings.width, job.settings.height,
                                     options.fps};
    const auto sink = openSink(sink_settings, interruption);
    if (!sink) {
        return tl::make_unexpected(sink.error());
    }
    Run run(job, **sink, interruption);
    return renderAll(job, run).and_then([&] { return (*sink)->finish(); }).map([&] {
        return run.report();
    });
}

Outcome<void> printReports(const RenderOptions& options, const std::vector<RenderReport>& reports) {
    if (reports.empty()) {
        return {};
    }
    if (options.json) {
        return print(renderJson(reports));
    }
    const bool compares = !options.reference.empty() && !options.quiet;
    return print((options.hash ? hashLines(reports) : "") +
                 (compares ? referenceLines(reports) : ""));
}

bool differs(const RenderReport& report) {
    return report.reference && !report.reference->error().identical();
}

/// All scenes, each by itself: when the files of one are wrong, the others are rendered all the
/// same.
Outcome<ExitCode> renderScenes(const RenderOptions& options, Interruption& interruption,
                               Watch& watch) {
    std::vector<RenderReport> reports;
    std::vector<Failure> failures;
    bool different = false;
    for (const std::string& scene : options.scenes) {
        auto report = renderScene(options, scene, interruption, watch);
        if (report) {
            different |= differs(*report);
            reports.push_back(std::move(*report));
        } else if (options.scenes.size() == 1 || report.error().code == ExitCode::usage) {
            return tl::make_unexpected(report.error());
        } else {
            printFailure(report.error());
            failures.push_back(report.error());
        }
    }
    return printReports(options, reports).map([&] {
        return !failures.empty() ? failures.front().code
               : different       ? ExitCode::differs
                                 : ExitCode::ok;
    });
}

/// Renders anew whenever a file of the scenes has changed, until a signal ends the program.
Outcome<ExitCode> renderForEver(const RenderOptions& options, Interruption& interruption) {
    Watch watch;
    watch.add(options.scenes);
    if (!options.cameras.empty()) {
        watch.add({options.cameras});
    }
    for (bool first = true;; first = false) {
        const auto rendered = renderScenes(options, interruption, watch);
        if (!rendered && first) {
            return rendered;
        }
        if (!rendered) {
            printFailure(rendered.error());
        } else if (!options.quiet) {
            std::fputs("stillframe: rendered, watching\n", stderr);
        }
        watch.wait();
    }
}

}  // namespace

Outcome<ExitCode> render(const RenderOptions& options, Interruption& interruption) {
    return checkOptions(options).and_then([&] {
        if (options.watch) {
            return renderForEver(options, interruption);
        }
        Watch nothing;
        return renderScenes(options, interruption, nothing);
    });
}

}  // namespace still::command
