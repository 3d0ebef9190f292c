#pragma once
// Lines over the finished picture: grid, axes, edges of triangles, borders of tiles, arrows of
// motion. In the window's pixels and never jittered.

#include <vector>

#include "demos/inspect/film.h"
#include "demos/inspect/lines.h"
#include "demos/inspect/look.h"
#include "demos/inspect/probe.h"

namespace still::inspect {

class Overlay {
  public:
    Overlay(const Film& film, SimdTarget simd, Workers& workers)
        : film_(film), probe_(film, simd, workers), workers_(workers) {}

    /// The scene is another one.
    void forgetScene();
    /// The film begins anew.
    void forgetFrames() { probed_frame_ = -1; }

    /// Over the film's last frame, whose panes have width × height pixels.
    void draw(const Overlays& wanted, int width, int height, ImageView<Rgb8> out);

    /// The last frame's samples at the pixels' centres, with motion.
    const GBuffer& centreSamples(int width, int height);

  private:
    struct Edge {
        uint32_t a = 0, b = 0;
    };
    const std::vector<Edge>& edgesOf(uint32_t mesh);
    void addGrid(const Projection& projection, const CameraFileFrame& camera);
    void addAxes(const Projection& projection);
    void addEdges(const Projection& projection, const FrameState& state);
    void addLine(const Projection& projection, const glm::dvec3& from, const glm::dvec3& to,
                 Rgb8 colour, uint8_t opacity);
    void drawTiles(int width, int height, ImageView<Rgb8> out);
    void drawArrows(const GBuffer& gbuffer, ImageView<Rgb8> out);

    const Film& film_;
    Probe probe_;
    Workers& workers_;
    int probed_frame_ = -1;
    LineDepth depth_;
    int depth_frame_ = -1;
    Bounds bounds_{};                       ///< of the scene, when first asked for
    std::vector<std::vector<Edge>> edges_;  ///< of each mesh, when first asked for
    std::vector<glm::dvec4> clip_;
    std::vector<Segment> segments_;
};

}  // namespace still::inspect
