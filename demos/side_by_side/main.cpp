// side_by_side OUTPUT.png [SCENE]: a scene without anti-aliasing, with TAA and as a reference, next
// to each other, and below them the places where the first one is farthest from the last one,
// magnified.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "demos/scenes/builtin.h"
#include "demos/stillframe/png.h"
#include "engine/frame_loop.h"

namespace still {
namespace {

constexpr int kWidth = 480, kHeight = 270;
constexpr int kFrame = 63;  ///< TAA has seen all of its samples by then
constexpr int kReferenceSamples = 256;
constexpr int kMagnify = 4;
constexpr int kCropWidth = kWidth / kMagnify, kCropHeight = 68;
constexpr int kCrops = 3;
constexpr int kGap = 6;
constexpr int kCaptionHeight = 22;
constexpr Rgb8 kPaper{245, 245, 245};
constexpr Rgb8 kInk{40, 40, 40};

struct Point {
    int x = 0, y = 0;
};

Image<Rgb8> copyOf(ImageView<const Rgb8> from) {
    Image<Rgb8> image(from.width, from.height);
    for (int y = 0; y < from.height; ++y) {
        std::copy_n(from.row(y), from.width, image.view().row(y));
    }
    return image;
}

Image<Rgb8> renderWith(const Scene& scene, AntiAliasing anti_aliasing, Workers& workers) {
    FrameSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.anti_aliasing = anti_aliasing;
    settings.ssaa_samples = kReferenceSamples;
    FrameLoop loop(scene, settings, workers);
    return copyOf(loop.render(kFrame).output);
}

int64_t squaredError(ImageView<const Rgb8> a, ImageView<const Rgb8> b, Point corner) {
    int64_t sum = 0;
    for (int y = corner.y; y < corner.y + kCropHeight; ++y) {
        for (int x = corner.x; x < corner.x + kCropWidth; ++x) {
            const Rgb8 p = a.at(x, y);
            const Rgb8 q = b.at(x, y);
            sum +=
                (p.r - q.r) * (p.r - q.r) + (p.g - q.g) * (p.g - q.g) + (p.b - q.b) * (p.b - q.b);
        }
    }
    return sum;
}

bool overlap(Point p, Point q) {
    return std::abs(p.x - q.x) < kCropWidth && std::abs(p.y - q.y) < kCropHeight;
}

/// Corners of the crops with the largest errors, on a coarse grid, none over another.
std::vector<Point> worstPlaces(ImageView<const Rgb8> a, ImageView<const Rgb8> b) {
    constexpr int kStep = 10;
    std::vector<Point> places;
    while (places.size() < kCrops) {
        Point worst;
        int64_t worst_error = -1;
        for (int y = 0; y + kCropHeight <= a.height; y += kStep) {
            for (int x = 0; x + kCropWidth <= a.width; x += kStep) {
                const bool taken = std::any_of(places.begin(), places.end(), [&](Point place) {
                    return overlap(place, {x, y});
                });
                const int64_t error = taken ? -1 : squaredError(a, b, {x, y});
                if (error > worst_error) {
                    worst_error = error;
                    worst = {x, y};
                }
            }
        }
        places.push_back(worst);
    }
    return places;
}

/// Copies the window of `from` at `corner`, `scale` times enlarged, to `to` at `at`.
void paste(ImageView<const Rgb8> from, Point corner, Point size, int scale, ImageView<Rgb8> to,
           Point at) {
    for (int y = 0; y < size.y * scale; ++y) {
        for (int x = 0; x < size.x * scale; ++x) {
            to.at(at.x + x, at.y + y) = from.at(corner.x + x / scale, corner.y + y / scale);
        }
    }
}

/// Letters of 5 × 7 dots, a row per number, the leftmost dot in bit 4.
struct Letter {
    char name;
    std::array<uint8_t, 7> rows;
};
constexpr Letter kLetters[] = {
    {'A', {14, 17, 17, 31, 17, 17, 17}}, {'C', {14, 17, 16, 16, 16, 17, 14}},
    {'E', {31, 16, 16, 30, 16, 16, 31}}, {'F', {31, 16, 16, 30, 16, 16, 16}},
    {'N', {17, 25, 21, 19, 17, 17, 17}}, {'R', {30, 17, 17, 30, 20, 18, 17}},
    {'T', {31, 4, 4, 4, 4, 4, 4}},       {'W', {17, 17, 17, 21, 21, 27, 17}},
};

void write(std::string_view text, ImageView<Rgb8> to, Point at) {
    constexpr int kScale = 2;
    for (char c : text) {
        for (const Letter& letter : kLetters) {
            for (int y = 0; letter.name == c && y < 7 * kScale; ++y) {
                for (int x = 0; x < 5 * kScale; ++x) {
                    if ((letter.rows[size_t(y / kScale)] >> (4 - x / kScale) & 1) != 0) {
                        to.at(at.x + x, at.y + y) = kInk;
                    }
                }
            }
        }
        at.x += 6 * kScale;
    }
}

Image<Rgb8> sideBySide(const Scene& scene, Workers& workers) {
    struct Column {
        std::string_view caption;
        Image<Rgb8> picture;
    };
    const std::array<Column, 3> columns{
        Column{"RAW", renderWith(scene, AntiAliasing::none, workers)},
        Column{"TAA", renderWith(scene, AntiAliasing::taa, workers)},
        Column{"REFERENCE", renderWith(scene, AntiAliasing::ssaa, workers)}};
    const std::vector<Point> places =
        worstPlaces(columns[0].picture.view(), columns[2].picture.view());

    constexpr int kCropRow = kCropHeight * kMagnify + kGap;
    Image<Rgb8> sheet(3 * kWidth + 4 * kGap,
                      kCaptionHeight + kHeight + 2 * kGap + kCrops * kCropRow);
    const ImageView<Rgb8> to = sheet.view();
    for (int y = 0; y < to.height; ++y) {
        std::fill_n(to.row(y), to.width, kPaper);
    }
    int left = kGap;
    for (const Column& column : columns) {
        const ImageView<const Rgb8> from = column.picture.view();
        write(column.caption, to, {left, kGap});
        int top = kCaptionHeight + kGap;
        paste(from, {}, {kWidth, kHeight}, 1, to, {left, top});
        top += kHeight + kGap;
        for (Point place : places) {
            paste(from, place, {kCropWidth, kCropHeight}, kMagnify, to, {left, top});
            top += kCropRow;
        }
        left += kWidth + kGap;
    }
    return sheet;
}

int run(const std::string& output, const std::string& scene_name) {
    command::Interruption interruption;
    const Result<Scene> scene = builtinScene(scene_name);
    if (!scene) {
        std::fprintf(stderr, "side_by_side: %s\n", scene.error().message.c_str());
        return int(command::ExitCode::usage);
    }
    Workers workers(std::max(1, int(std::thread::hardware_concurrency())));
    const Image<Rgb8> sheet = sideBySide(*scene, workers);
    const auto saved = command::savePng(output, sheet.view(), interruption);
    if (!saved) {
        std::fprintf(stderr, "side_by_side: %s\n", saved.error().message.c_str());
        return int(saved.error().code);
    }
    return 0;
}

}  // namespace
}  // namespace still

int main(int argc, char** argv) {
    if (argc != 2 && argc != 3) {
        std::fprintf(stderr, "usage: side_by_side OUTPUT.png [BUILT-IN SCENE]\n");
        return int(still::command::ExitCode::usage);
    }
    return still::run(argv[1], argc == 3 ? argv[2] : "courtyard");
}
