#include "demos/stillframe/png.h"

#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <memory>

namespace still::command {
namespace {

/// Higher levels cost several times the time and save a few per cent.
constexpr int kCompressionLevel = 3;

/// libpng keeps the text in its own memory, so it is copied out before the jump.
struct PngError {
    char text[160] = "unknown error";
};

void onError(png_structp png, png_const_charp message) {
    auto* error = static_cast<PngError*>(png_get_error_ptr(png));
    const char* reason = errno != 0 ? std::strerror(errno) : message;
    std::strncpy(error->text, reason, sizeof error->text - 1);
    png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}

/// Everything that may jump. Only trivial objects live here, so a jump skips no destructor.
bool encode(png_structp png, png_infop info, std::FILE* stream, const Picture& image) {
    if (setjmp(png_jmpbuf(png)) != 0) {
        return false;
    }
    png_init_io(png, stream);
    png_set_user_limits(png, png_uint_32(image.width()), png_uint_32(image.height()));
    png_set_compression_level(png, kCompressionLevel);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    png_set_IHDR(png, info, png_uint_32(image.width()), png_uint_32(image.height()), 8,
                 image.hasAlpha() ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int y = 0; y < image.height(); ++y) {
        png_write_row(png, image.hasAlpha()
                               ? reinterpret_cast<png_const_bytep>(image.matted.row(y))
                               : reinterpret_cast<png_const_bytep>(image.opaque.row(y)));
    }
    png_write_end(png, info);
    return true;
}

}  // namespace

Outcome<void> writePng(std::FILE* stream, const std::string& name, const Picture& image) {
    errno = 0;
    PngError error;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, onError, onWarning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    bool written = info != nullptr && encode(png, info, stream, image);
    png_destroy_write_struct(&png, &info);
    if (written && std::fflush(stream) != 0) {
        std::strncpy(error.text, std::strerror(errno), sizeof error.text - 1);
        written = false;
    }
    if (!written) {
        return fileError(name + ": cannot write: " + error.text);
    }
    return {};
}

Outcome<std::string> pngBytes(const Picture& image) {
    char* memory = nullptr;
    size_t size = 0;
    std::FILE* stream = open_memstream(&memory, &size);
    if (stream == nullptr) {
        return fileError("a picture in memory: cannot be made");
    }
    const Outcome<void> written = writePng(stream, "a picture in memory", image);
    std::fclose(stream);
    const std::unique_ptr<char, decltype(&std::free)> owner(memory, &std::free);
    return written.map([&] { return std::string(memory, size); });
}

Outcome<void> savePng(const std::filesystem::path& path, const Picture& image,
                      Interruption& interruption) {
    return OutputFile::create(path, interruption).and_then([&](OutputFile file) -> Outcome<void> {
        if (auto written = writePng(file.stream(), path.string(), image); !written) {
            return written;
        }
        return file.commit();
    });
}

}  // namespace still::command
