#pragma once
// The targets of a frame and the passes over the whole of them: clearing, resolve, output.

#include <array>
#include <vector>

#include "rasterizer/image.h"
#include "tests/bench/peer/gl.h"

namespace still::peer {

/// One pixel of the motion plane as Stillframe counts: y down.
struct PeerMotion {
    float x_px = 0, y_px = 0;
    bool surface = false;  ///< not the background
};

/// All of a frame's planes live here; one object per size.
class Passes {
  public:
    static Result<Passes> make(const Gl& gl, int width, int height, bool reversed_depth);

    /// Binds the G-buffer and makes it empty: `background` is linear light.
    void beginGbuffer(const std::array<float, 3>& background);
    /// The same with several samples a pixel, to average their colours afterwards. Makes its
    /// targets when called first.
    Result<void> beginMultisampled(int samples, const std::array<float, 3>& background);
    void averageSamples();
    /// Binds and clears the depth plane alone.
    void beginDepth();
    /// Takes the G-buffer into the history; `reset` forgets what was there.
    void resolve(bool reset);
    /// sRGB-encodes the history into 8 bits.
    void output();

    /// Reads the frame's own colour, or the history, as Stillframe would show it.
    Image<Rgb8> readColour();
    Image<Rgb8> readHistory();
    Image<PeerMotion> readMotion();

  private:
    Passes(const Gl& gl, int width, int height) : gl_(&gl), width_(width), height_(height) {}
    Result<void> makeFramebuffers();
    Result<void> makePrograms();
    void clearGbuffer(GLuint framebuffer, const std::array<float, 3>& background);
    void drawWhole(GLuint framebuffer, GLuint program);
    void bindTexture(int unit, GLuint texture);
    std::vector<float> readFloats(GLuint framebuffer, int attachment);
    Image<Rgb8> read(GLuint framebuffer);

    const Gl* gl_;
    int width_, height_;
    bool reversed_ = false;
    GLuint colour_ = 0, normal_ = 0, motion_ = 0, depth_ = 0;
    GLuint history_[2] = {}, display_ = 0;
    GLuint gbuffer_fb_ = 0, depth_fb_ = 0, history_fb_[2] = {}, display_fb_ = 0;
    GLuint multisampled_fb_ = 0;
    GLuint temporal_ = 0, encode_ = 0, empty_vertices_ = 0;
    GLint keep_ = -1;
    int newest_ = 0;  ///< which history is
};

}  // namespace still::peer
