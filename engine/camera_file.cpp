#include <charconv>
#include <cmath>
#include <glm/matrix.hpp>

#include "engine/camera.h"
#include "engine/internal/json.h"
#include "engine/internal/obj_text.h"
#include "engine/load.h"
#include "rasterizer/fixed.h"

namespace still {
namespace {

constexpr double kLimit = 1e9;
constexpr int kMaxFrames = 1000000;

glm::dmat4 matrixFrom(const JsonCursor& cursor) {
    const std::vector<double> values = cursor.numbers(16, -kLimit, kLimit);
    glm::dmat4 matrix;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            matrix[column][row] = values[size_t(column * 4 + row)];
        }
    }
    if (glm::determinant(matrix) == 0) {
        cursor.refuse("expected an invertible matrix, found one of determinant 0");
    }
    return matrix;
}

glm::dmat4 viewFrom(const JsonCursor& cursor) {
    const glm::dmat4 view = matrixFrom(cursor);
    if (view[0][3] != 0 || view[1][3] != 0 || view[2][3] != 0 || view[3][3] != 1) {
        cursor.refuse(
            "expected an affine matrix, column-major: numbers 4, 8, 12 are 0 and number 16 is 1");
    }
    return view;
}

std::array<int, 2> jitterFrom(const JsonCursor& cursor) {
    std::array<int, 2> jitter_fx8{};
    const std::vector<double> pixels = cursor.numbers(2, -0.5, 0.5);
    for (size_t axis = 0; axis < 2; ++axis) {
        const int rounded = int(std::floor(pixels[axis] * kSubpixelOne + 0.5));
        jitter_fx8[axis] = std::min(rounded, kSubpixelHalf - 1);
        if (pixels[axis] == 0.5) {
            cursor.refuse("expected offsets below 0.5 pixel, found 0.5");
        }
    }
    return jitter_fx8;
}

CameraFileFrame frameFrom(const JsonCursor& cursor) {
    cursor.expectKeys({"view", "proj", "jitter", "frame", "cut"});
    CameraFileFrame frame;
    frame.view = viewFrom(cursor.require("view"));
    frame.projection = matrixFrom(cursor.require("proj"));
    if (const auto jitter = cursor.find("jitter")) {
        frame.jitter_fx8 = jitterFrom(*jitter);
    }
    if (const auto instant = cursor.find("frame")) {
        frame.scene_frame = instant->integer(0, kMaxFrames);
    }
    if (const auto cut = cursor.find("cut")) {
        frame.cut = cut->boolean();
    }
    return frame;
}

}  // namespace

Result<CameraFile> loadCameraFile(const std::filesystem::path& file) {
    const Result<JsonValue> tree = readJson(file);
    if (!tree) {
        return tl::make_unexpected(tree.error());
    }
    JsonReport report{.file = shownPath(file), .error = {}, .warnings = {}};
    const JsonCursor root(*tree, report);
    root.expectKeys({"width", "height", "frames"}, {"name", "notes", "comment"});
    CameraFile cameras;
    cameras.width = root.require("width").integer(1, kMaxTargetSize);
    cameras.height = root.require("height").integer(1, kMaxTargetSize);
    for (const JsonCursor& frame : root.require("frames").items(1, size_t(kMaxFrames))) {
        cameras.frames.push_back(frameFrom(frame));
    }
    if (report.error) {
        return tl::make_unexpected(*report.error);
    }
    cameras.warnings = std::move(report.warnings);
    return cameras;
}

namespace {

/// The shortest text that reads back as the same number.
void appendNumber(std::string& text, double value) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void appendMatrix(std::string& text, const char* name, const glm::dmat4& matrix) {
    text += "\"" + std::string(name) + "\":[";
    for (int i = 0; i < 16; ++i) {
        text += i == 0 ? "" : ",";
        appendNumber(text, matrix[i / 4][i % 4]);
    }
    text += "]";
}

void appendFrame(std::string& text, const CameraFileFrame& frame) {
    text += "{";
    appendMatrix(text, "view", frame.view);
    text += ",";
    appendMatrix(text, "proj", frame.projection);
    if (frame.jitter_fx8) {
        text += ",\"jitter\":[";
        appendNumber(text, double((*frame.jitter_fx8)[0]) / kSubpixelOne);
        text += ",";
        appendNumber(text, double((*frame.jitter_fx8)[1]) / kSubpixelOne);
        text += "]";
    }
    if (frame.scene_frame) {
        text += ",\"frame\":" + std::to_string(*frame.scene_frame);
    }
    text += frame.cut ? ",\"cut\":true}" : "}";
}

}  // namespace

std::string cameraFileText(const CameraFile& cameras) {
    std::string text = "{\"width\":" + std::to_string(cameras.width) +
                       ",\"height\":" + std::to_string(cameras.height) + ",\"frames\":[\n";
    for (size_t i = 0; i < cameras.frames.size(); ++i) {
        text += i == 0 ? "" : ",\n";
        appendFrame(text, cameras.frames[i]);
    }
    return text + "\n]}\n";
}

}  // namespace still
