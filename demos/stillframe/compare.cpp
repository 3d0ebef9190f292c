#include "demos/stillframe/compare.h"

#include <algorithm>
#include <filesystem>

#include "demos/stillframe/difference.h"
#include "demos/stillframe/name_pattern.h"
#include "demos/stillframe/png.h"
#include "demos/stillframe/report.h"
#include "demos/stillframe/sink.h"
#include "engine/image_file.h"
#include "postfx/metrics.h"

namespace still::command {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxListed = 20;

struct Names {
    NamePattern a, b;
    std::optional<NamePattern> diff;
};

Outcome<Names> parseNames(const CompareOptions& options) {
    const auto a = NamePattern::parse(options.a);
    const auto b = NamePattern::parse(options.b);
    if (!a || !b) {
        return tl::make_unexpected(!a ? a.error() : b.error());
    }
    if (a->numbered() != b->numbered()) {
        return usageError(
            "compare: expected two pictures or two frame patterns, found one of each");
    }
    Names names{*a, *b, {}};
    if (options.diff.empty()) {
        return names;
    }
    const auto diff = NamePattern::parse(options.diff);
    if (!diff) {
        return tl::make_unexpected(diff.error());
    }
    const auto kind = sinkKind(options.diff);
    if (!kind || *kind != SinkKind::png || (diff->numbered() && !a->numbered())) {
        return usageError("--diff: " + options.diff + ": expected NAME.png" +
                          (a->numbered() ? "" : " without a frame number"));
    }
    names.diff = a->numbered() ? diff->withNumber() : *diff;
    return names;
}

class Comparison {
  public:
    Comparison(const CompareOptions& options, Names names, Interruption& interruption)
        : names_(std::move(names)), interruption_(interruption) {
        report_.numbered = names_.a.numbered();
        report_.with_differences = options.exact;
    }
    Outcome<void> addFrame(int frame);
    const CompareReport& report() const { return report_; }

  private:
    void listDifferences(int frame, ImageView<const Rgb8> a, ImageView<const Rgb8> b);

    Names names_;
    Interruption& interruption_;
    CompareReport report_;
};

Outcome<void> Comparison::addFrame(int frame) {
    const auto read_a = fromResult(readImageFile(names_.a.at(frame)));
    const auto read_b = fromResult(readImageFile(names_.b.at(frame)));
    if (!read_a || !read_b) {
        return tl::make_unexpected(!read_a ? read_a.error() : read_b.error());
    }
    const ImageView<const Rgb8> a = read_a->view();
    const ImageView<const Rgb8> b = read_b->view();
    const auto size = [](ImageView<const Rgb8> image) {
        return std::to_string(image.width) + "x" + std::to_string(image.height);
    };
    if (a.width != b.width || a.height != b.height) {
        return tl::make_unexpected(Failure{
            ExitCode::differs, names_.b.at(frame).string() + ": is " + size(b) + ", expected the " +
                                   size(a) + " of " + names_.a.at(frame).string()});
    }
    report_.frames.push_back({frame, pixelError(a, b), ssim(a, b)});
    if (report_.with_differences) {
        listDifferences(frame, a, b);
    }
    if (names_.diff) {
        return savePng(names_.diff->at(frame), differencePicture(a, b).view(), interruption_);
    }
    return {};
}

void Comparison::listDifferences(int frame, ImageView<const Rgb8> a, ImageView<const Rgb8> b) {
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width && report_.differences.size() < kMaxListed; ++x) {
            if (a.at(x, y) != b.at(x, y)) {
                report_.differences.push_back({frame, x, y, a.at(x, y), b.at(x, y)});
            }
        }
    }
}

}  // namespace

Outcome<ExitCode> compare(const CompareOptions& options, Interruption& interruption) {
    const auto names = parseNames(options);
    if (!names) {
        return tl::make_unexpected(names.error());
    }
    const std::vector<int> frames = names->a.numbered() ? names->a.existing() : std::vector<int>{0};
    if (frames.empty()) {
        return fileError(options.a + ": no such frames");
    }
    Comparison comparison(options, *names, interruption);
    for (int frame : frames) {
        if (auto added = comparison.addFrame(frame); !added) {
            return tl::make_unexpected(added.error());
        }
    }
    const CompareReport& report = comparison.report();
    const Outcome<void> printed =
        options.json ? print(compareJson(report))
                     : (options.quiet ? Outcome<void>() : print(compareLines(report)));
    return printed.map(
        [&] { return report.error().identical() ? ExitCode::ok : ExitCode::differs; });
}

}  // namespace still::command
