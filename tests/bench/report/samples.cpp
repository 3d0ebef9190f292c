#include "tests/bench/report/samples.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace still::bench {
namespace {

using Json = nlohmann::json;

/// Stages of which Stillframe's way to the G-buffer consists.
constexpr const char* kGbufferStages[] = {"transform", "bin", "visibility", "shade"};

/// The last part of a path without its ending, or what stands behind "builtin:"; a file that is
/// called scene.json has its folder's name.
std::string shortName(std::string scene) {
    if (scene.ends_with("/scene.json")) {
        scene.resize(scene.size() - std::string("/scene.json").size());
    }
    scene = scene.substr(scene.find_last_of("/:") + 1);
    return scene.substr(0, scene.find_last_of('.'));
}

void readCase(const Json& result, Case& out) {
    const Json& stages = result.at("stages");
    for (const auto& [stage, times] : stages.items()) {
        out.figures[stage].add(times.at("median_ms").get<double>());
    }
    if (!stages.contains("gbuffer")) {
        double sum_ms = 0;
        for (const char* stage : kGbufferStages) {
            sum_ms += stages.at(stage).at("median_ms").get<double>();
        }
        out.figures["gbuffer"].add(sum_ms);
    }
    out.figures["total"].add(result.at("total").at("median_ms").get<double>());
    if (result.contains("peak_rss_bytes")) {
        out.figures["memory"].add(result.at("peak_rss_bytes").get<double>() * 1e-6);
    }
    out.triangles = std::max(out.triangles, result.value("triangles", uint64_t{0}));
    if (result.contains("hashes") && !result.at("hashes").empty()) {
        const Json& last = result.at("hashes").back();
        out.last_frame = last.at("frame").get<int>();
        out.hashes.insert(last.at("output").get<std::string>());
    }
}

std::string plain(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

double Figure::best() const {
    return *std::min_element(rounds_.begin(), rounds_.end());
}

double Figure::worst() const {
    return *std::max_element(rounds_.begin(), rounds_.end());
}

Figure Case::operator[](const std::string& name) const {
    const auto found = figures.find(name);
    return found == figures.end() ? Figure{} : found->second;
}

Result<void> Samples::read(const std::string& file) {
    std::ifstream stream(file);
    if (!stream) {
        return fail(file + ": cannot be read");
    }
    try {
        const Json round = Json::parse(stream);
        for (const Json& result : round.at("results")) {
            const std::string scene = shortName(result.at("scene").get<std::string>());
            if (std::find(scenes_.begin(), scenes_.end(), scene) == scenes_.end()) {
                scenes_.push_back(scene);
            }
            readCase(result, cases_[{scene, result.at("motion").get<std::string>()}]);
            for (const char* key : {"width", "height", "threads", "simd", "renderer", "version"}) {
                if (result.contains(key)) {
                    about_[key] = plain(result.at(key));
                }
            }
        }
    } catch (const Json::exception& error) {
        return fail(file + ": " + error.what());
    }
    return {};
}

const Case& Samples::at(const std::string& scene, const std::string& motion) const {
    static const Case kNone;
    const auto found = cases_.find({scene, motion});
    return found == cases_.end() ? kNone : found->second;
}

std::string Samples::about(const std::string& key) const {
    const auto found = about_.find(key);
    return found == about_.end() ? std::string() : found->second;
}

}  // namespace still::bench
