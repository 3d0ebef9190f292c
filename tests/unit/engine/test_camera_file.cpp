#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "engine/camera.h"
#include "engine/load.h"

using namespace still;
namespace fs = std::filesystem;

namespace {

const std::string kUnit = "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]";

Result<CameraFile> load(const std::string& text) {
    const fs::path file = fs::temp_directory_path() /
                          ("still_cameras_" + std::to_string(std::random_device{}()) + ".json");
    std::ofstream(file, std::ios::binary) << text;
    const auto cameras = loadCameraFile(file);
    fs::remove(file);
    return cameras;
}

/// Message after the file's name; empty when the text loads.
std::string errorOf(const std::string& text) {
    const auto cameras = load(text);
    const std::string message = cameras ? "" : cameras.error().message;
    const size_t name_end = message.find(".json");
    return name_end == std::string::npos ? message : message.substr(name_end + 5);
}

std::string oneFrame(const std::string& frame) {
    return R"({"width": 8, "height": 4, "frames": [{)" + frame + "}]}";
}

}  // namespace

TEST_CASE("camera_file: matrices are column-major and jitter is in pixels", "[unit][camera_file]") {
    const auto cameras =
        loadCameraFile(fs::path(STILL_SOURCE_DIR) / "tests" / "data" / "cameras.json");
    REQUIRE((cameras ? "" : cameras.error().message) == std::string());
    CHECK(cameras->width == 320);
    CHECK(cameras->height == 200);
    REQUIRE(cameras->frames.size() == 2);
    CHECK(cameras->frames[0].view[3] == glm::dvec4(-1, -2, -5, 1));
    CHECK(cameras->frames[0].projection[1][1] == 2.4);
    CHECK(cameras->frames[0].projection[2][3] == -1);
    CHECK(cameras->frames[0].jitter_fx8 == std::array{64, -32});
    CHECK_FALSE(cameras->frames[1].jitter_fx8);
    CHECK(cameras->warnings.empty());
}

TEST_CASE("camera_file: jitter is rounded half up to 1/256 pixel and kept inside",
          "[unit][camera_file]") {
    const auto jitter = [](const std::string& pair) {
        const auto cameras =
            load(oneFrame("\"view\":" + kUnit + ",\"proj\":" + kUnit + ",\"jitter\":" + pair));
        REQUIRE(cameras);
        return *cameras->frames[0].jitter_fx8;
    };
    CHECK(jitter("[-0.5, 0.499999]") == std::array{-128, 127});
    CHECK(jitter("[0.001953125, -0.001953125]") == std::array{1, 0});
    CHECK(jitter("[0, 0.25]") == std::array{0, 64});
}

TEST_CASE("camera_file: broken files are refused with the place", "[unit][camera_file]") {
    const std::string view = "\"view\":" + kUnit + ",";
    CHECK(errorOf("{").find(":1:") == 0);
    CHECK(errorOf("{}") == ": /: expected the key \"width\"");
    CHECK(errorOf(R"({"width": 0, "height": 4, "frames": []})") ==
          ": /width: expected a whole number from 1 to 8192, found 0");
    CHECK(errorOf(R"({"width": 100000, "height": 4, "frames": []})").find(": /width: ") == 0);
    CHECK(errorOf(R"({"width": 8, "height": 4, "frames": []})").find(": /frames: ") == 0);
    CHECK(errorOf(oneFrame(view + "\"proj\":[1,2]")) ==
          ": /frames/0/proj: expected an array of 16, found an array of 2");
    CHECK(errorOf(oneFrame("\"proj\":" + kUnit)) == ": /frames/0: expected the key \"view\"");
    CHECK(errorOf(oneFrame(view + "\"proj\":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]"))
              .find(": /frames/0/proj: expected an invertible matrix") == 0);
    CHECK(errorOf(oneFrame(view + "\"proj\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,null]")) ==
          ": /frames/0/proj/15: expected a number from -1e+09 to 1e+09, found null");
    CHECK(errorOf(oneFrame("\"view\":[1,0,0,3, 0,1,0,0, 0,0,1,0, 0,0,0,1],\"proj\":" + kUnit))
              .find(": /frames/0/view: expected an affine matrix, column-major") == 0);
    CHECK(errorOf(oneFrame(view + "\"proj\":" + kUnit + ",\"jitter\":[0.7, 0]"))
              .find(": /frames/0/jitter/0: ") == 0);
    CHECK(errorOf(oneFrame(view + "\"proj\":" + kUnit + ",\"jitter\":[0, 0.5]"))
              .find(": /frames/0/jitter: ") == 0);
    CHECK_FALSE(loadCameraFile("does/not/exist.json"));
}

TEST_CASE("camera_file: an unknown key gives a warning", "[unit][camera_file]") {
    const auto cameras =
        load(oneFrame("\"view\":" + kUnit + ",\"proj\":" + kUnit + ",\"jiter\":[0,0]"));
    REQUIRE(cameras);
    REQUIRE(cameras->warnings.size() == 1);
    CHECK(cameras->warnings[0].find("/frames/0/jiter: unknown key") != std::string::npos);
}

TEST_CASE("camera_file: what is written reads back as the same numbers", "[unit][camera_file]") {
    const CameraPose pose{.eye = {1.1, -2.7, 1e-3}, .target = {0.3, 7, 1e5}, .fov_y_deg = 33.3};
    CameraFile cameras{.width = 320, .height = 200};
    cameras.frames.push_back(cameraFrame(pose, 0.1, 1234.5, 1.6));
    cameras.frames.push_back(cameras.frames[0]);
    cameras.frames[1].jitter_fx8 = {-128, 127};
    cameras.frames[1].scene_frame = 17;
    cameras.frames[1].cut = true;

    const auto read = load(cameraFileText(cameras));
    REQUIRE((read ? "" : read.error().message) == std::string());
    CHECK(read->warnings.empty());
    CHECK(read->width == 320);
    CHECK(read->height == 200);
    REQUIRE(read->frames.size() == 2);
    for (size_t i = 0; i < 2; ++i) {
        CHECK(read->frames[i].view == cameras.frames[i].view);
        CHECK(read->frames[i].projection == cameras.frames[i].projection);
        CHECK(read->frames[i].jitter_fx8 == cameras.frames[i].jitter_fx8);
        CHECK(read->frames[i].scene_frame == cameras.frames[i].scene_frame);
        CHECK(read->frames[i].cut == cameras.frames[i].cut);
    }
}

TEST_CASE("camera_file: frame is a whole number from 0 on, cut is true or false",
          "[unit][camera_file]") {
    const std::string matrices = "\"view\":" + kUnit + ",\"proj\":" + kUnit;
    CHECK(errorOf(oneFrame(matrices + ",\"frame\":-1")).find("/frames/0/frame") !=
          std::string::npos);
    CHECK(errorOf(oneFrame(matrices + ",\"frame\":1.5")).find("/frames/0/frame") !=
          std::string::npos);
    CHECK(errorOf(oneFrame(matrices + ",\"cut\":1")).find("expected true or false") !=
          std::string::npos);
}
