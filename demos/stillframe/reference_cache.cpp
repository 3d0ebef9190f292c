#include "demos/stillframe/reference_cache.h"

#include <cstring>

#include "engine/hash.h"

namespace still::command {
namespace {

constexpr int kProbeSamples = 4;
constexpr const char* kKind = "reference 1";

FrameSettings supersampled(const FrameSettings& view, int samples, PlaneSet planes) {
    return {.width = view.width,
            .height = view.height,
            .anti_aliasing = AntiAliasing::ssaa,
            .ssaa_samples = samples,
            .tone_map = view.tone_map,
            .planes = planes,
            .camera = view.camera};
}

std::string bytesOf(ImageView<const Rgb8> picture) {
    const size_t row_bytes = size_t(picture.width) * sizeof(Rgb8);
    std::string bytes(row_bytes * size_t(picture.height), '\0');
    for (int y = 0; y < picture.height; ++y) {
        std::memcpy(bytes.data() + row_bytes * size_t(y), picture.row(y), row_bytes);
    }
    return bytes;
}

/// Empty when the number of bytes is not that of the size.
Image<Rgb8> pictureFrom(const std::string& bytes, int width, int height) {
    const size_t row_bytes = size_t(width) * sizeof(Rgb8);
    if (bytes.size() != row_bytes * size_t(height)) {
        return {};
    }
    Image<Rgb8> picture(width, height);
    for (int y = 0; y < height; ++y) {
        std::memcpy(picture.view().row(y), bytes.data() + row_bytes * size_t(y), row_bytes);
    }
    return picture;
}

}  // namespace

ReferenceMaker::ReferenceMaker(const Scene& scene, const FrameSettings& view, int samples,
                               const FileCache& cache, Workers& workers)
    : cache_(cache),
      settings_(supersampled(view, samples, {})),
      probe_(scene, supersampled(view, kProbeSamples, {.normal = true}), workers),
      loop_(scene, settings_, workers) {}

uint64_t ReferenceMaker::keyOf(int frame) {
    const FrameResult result = probe_.render(frame);
    const FrameHashes hashes = hashFrame(result.output, *result.gbuffer);
    std::string text = kKind;
    for (uint64_t hash : {hashPlane(result.linear.red), hashPlane(result.linear.green),
                          hashPlane(result.linear.blue), hashes.output, hashes.color, hashes.depth,
                          hashes.normal, hashes.id}) {
        text += " " + hex(hash);
    }
    return hashBytes(text + " " + std::to_string(settings_.ssaa_samples));
}

void ReferenceMaker::resize(int width, int height) {
    if (width == settings_.width && height == settings_.height) {
        return;
    }
    settings_.width = width;
    settings_.height = height;
    probe_.resize(width, height);
    loop_.resize(width, height);
}

Outcome<Reference> ReferenceMaker::make(int frame) {
    const uint64_t key = keyOf(frame);
    if (const auto stored = cache_.load(key)) {
        Image<Rgb8> picture = pictureFrom(*stored, settings_.width, settings_.height);
        if (!picture.empty()) {
            return Reference{std::move(picture), key};
        }
    }
    const ImageView<const Rgb8> made = loop_.render(frame).output;
    const std::string bytes = bytesOf(made);
    return cache_.store(key, bytes).map([&] {
        return Reference{pictureFrom(bytes, made.width, made.height), key};
    });
}

}  // namespace still::command
