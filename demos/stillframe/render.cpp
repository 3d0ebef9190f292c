#include "demos/stillframe/render.h"

#include <memory>

#include "demos/stillframe/clock.h"
#include "demos/stillframe/dump.h"
#include "demos/stillframe/job.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/progress.h"
#include "demos/stillframe/report.h"
#include "engine/hash.h"

namespace still::command {
namespace {

/// Renders a job's frames into its sink and remembers what the report needs.
class Run {
  public:
    Run(const Job& job, Sink& sink, Interruption& interruption)
        : job_(job),
          sink_(sink),
          interruption_(interruption),
          workers_(job.threads),
          loop_(job.scene, job.settings, workers_) {
        report_.scene = job.options.scene;
        report_.triangles = job.scene.triangleCount();
        report_.width = job.settings.width;
        report_.height = job.settings.height;
        report_.threads = job.threads;
        report_.simd = job.settings.simd;
        report_.anti_aliasing = job.options.anti_aliasing;
        report_.preset = job.preset;
        report_.taa = job.options.taa;
        report_.with_hashes = job.options.hash;
    }

    Outcome<void> renderFrame(int frame);
    const RenderReport& report() const { return report_; }

  private:
    Outcome<void> writeDumps(int frame, const FrameResult& result);

    const Job& job_;
    Sink& sink_;
    Interruption& interruption_;
    Workers workers_;
    FrameLoop loop_;
    RenderReport report_;
};

Outcome<void> Run::renderFrame(int frame) {
    const double start_ms = nowMs();
    const FrameResult result = loop_.render(frame);
    report_.frames.push_back({frame, result.times, nowMs() - start_ms, {}});
    if (job_.options.hash) {
        report_.frames.back().hashes = hashFrame(result.output, *result.gbuffer);
    }
    return sink_.add(frame, result.output).and_then([&] { return writeDumps(frame, result); });
}

Outcome<void> Run::writeDumps(int frame, const FrameResult& result) {
    if (job_.dump.empty()) {
        return {};
    }
    const NamePattern name = job_.frames > 1 ? job_.name.withNumber() : job_.name;
    const auto table = std::make_unique<OutputTable>(job_.settings.tone_map);
    for (DumpPlane plane : job_.dump) {
        const Image<Rgb8> picture = pictureOf(plane, result, *table);
        const auto path = name.planeAt(frame, dumpName(plane));
        if (auto saved = savePng(path, picture.view(), interruption_); !saved) {
            return saved;
        }
    }
    return {};
}

Outcome<void> renderAll(const Job& job, Run& run) {
    const ProgressBar progress(job.frames);
    for (int i = 0; i < job.frames; ++i) {
        if (auto rendered = run.renderFrame(job.start + i); !rendered) {
            return rendered;
        }
        progress.show(i + 1);
    }
    return {};
}

Outcome<void> printReport(const RenderOptions& options, const RenderReport& report) {
    if (options.json) {
        return print(renderJson(report));
    }
    return options.hash ? print(hashLines(report)) : Outcome<void>();
}

}  // namespace

Outcome<void> render(const RenderOptions& options, Interruption& interruption) {
    Job job(options);
    if (auto prepared = prepare(job); !prepared) {
        return prepared;
    }
    if (options.json) {
        job.settings.clock_ms = nowMs;
    }
    const SinkSettings sink_settings{
        job.sink, job.name, job.start, job.settings.width, job.settings.height, options.fps};
    const auto sink = openSink(sink_settings, interruption);
    if (!sink) {
        return tl::make_unexpected(sink.error());
    }
    Run run(job, **sink, interruption);
    return renderAll(job, run).and_then([&] { return (*sink)->finish(); }).and_then([&] {
        return printReport(options, run.report());
    });
}

}  // namespace still::command
