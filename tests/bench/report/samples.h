#pragma once
// What rounds of measuring have left: the JSON of `stillframe bench` and of bench_peer.

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/result.h"

namespace still::bench {

/// One figure, measured in every round; the medians of the rounds.
class Figure {
  public:
    void add(double value) { rounds_.push_back(value); }
    bool empty() const { return rounds_.empty(); }
    double best() const;
    double worst() const;

  private:
    std::vector<double> rounds_;
};

/// Figures of one scene in one motion by one renderer, by name: stages ("taa"), "total", "memory"
/// in MB, and whatever sum() has made.
struct Case {
    std::map<std::string, Figure> figures;
    uint64_t triangles = 0;
    int last_frame = 0;
    std::set<std::string> hashes;  ///< of that frame's picture; more than one is an error

    /// The figure, or an empty one.
    Figure operator[](const std::string& name) const;
};

/// Everything of one renderer.
class Samples {
  public:
    /// Adds a round. An Error names the file and what is wrong.
    Result<void> read(const std::string& file);

    bool empty() const { return cases_.empty(); }
    /// The case, or one without figures.
    const Case& at(const std::string& scene, const std::string& motion) const;
    /// Scenes in the order in which they were read first.
    const std::vector<std::string>& scenes() const { return scenes_; }
    /// Things that hold for all: "width", "threads", "simd", "renderer" …
    std::string about(const std::string& key) const;

  private:
    std::map<std::pair<std::string, std::string>, Case> cases_;
    std::vector<std::string> scenes_;
    std::map<std::string, std::string> about_;
};

}  // namespace still::bench
