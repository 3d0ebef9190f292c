#pragma once
// The failure atlas as tests run it. Everything here belongs to the main thread and fails the test
// that asks for what does not exist.

#include <string>
#include <vector>

#include "demos/stillframe/atlas_report.h"

namespace still::test {

/// The case as it is in the atlas.
AtlasCase atlasCase(const std::string& scene);
/// With references of ssaa:64 for what moves. Still scenes have one reference for all frames.
AtlasCase quickCase(const std::string& scene);

constexpr command::Size kAtlasSize{320, 180};

/// One case, measured in several ways.
class MeasuredScene {
  public:
    /// `modes`: comma-separated names, "still" and "raw" among them; empty: all.
    MeasuredScene(const AtlasCase& atlas, const std::string& modes,
                  command::Size size = kAtlasSize);

    const command::SegmentMeasures& at(const std::string& segment, const std::string& mode) const;
    /// How far `still` is ahead of another mode.
    double leadDb(const std::string& segment, const std::string& mode) const;
    /// How far `still` is ahead of the best preset that is not one of ours.
    double leadOfPublishedDb(const std::string& segment) const;
    /// How far `still` is ahead of raw in one frame.
    double frameLeadDb(const std::string& segment, int frame) const;
    /// The most by which the FLIP of a frame of `still` is above that of raw; 0 when none is.
    double flipAboveRaw(const std::string& segment) const;

  private:
    std::vector<command::AtlasResult> results_;
};

}  // namespace still::test
