#include "tests/bench/peer/passes.h"

#include <array>
#include <vector>

#include "postfx/encode.h"
#include "rasterizer/fixed.h"
#include "tests/bench/peer/shaders.h"

namespace still::peer {
namespace {

constexpr float kKeep = 0.9f;  ///< weight of history

constexpr GLenum kColourFormat = GL_RGBA16F;  ///< of the history, too
constexpr GLenum kNormalFormat = GL_RGBA8;
constexpr GLenum kMotionFormat = GL_RG16F;
constexpr GLenum kDepthFormat = GL_DEPTH_COMPONENT32F;

Result<GLuint> makeFramebuffer(const Gl& gl, const std::vector<GLuint>& colours, GLuint depth) {
    GLuint name = 0;
    gl.glGenFramebuffers(1, &name);
    gl.glBindFramebuffer(GL_FRAMEBUFFER, name);
    std::vector<GLenum> drawn;
    for (GLuint texture : colours) {
        drawn.push_back(GL_COLOR_ATTACHMENT0 + GLenum(drawn.size()));
        gl.glFramebufferTexture2D(GL_FRAMEBUFFER, drawn.back(), GL_TEXTURE_2D, texture, 0);
    }
    if (depth != 0) {
        gl.glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    }
    const GLenum none = GL_NONE;
    gl.glDrawBuffers(drawn.empty() ? 1 : GLsizei(drawn.size()),
                     drawn.empty() ? &none : drawn.data());
    if (gl.glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        return fail("the driver cannot draw into a framebuffer that is needed");
    }
    return name;
}

}  // namespace

Result<Passes> Passes::make(const Gl& gl, int width, int height, bool reversed_depth) {
    Passes made(gl, width, height);
    made.reversed_ = reversed_depth;
    if (Result<void> done = made.makeFramebuffers(); !done) {
        return tl::make_unexpected(done.error());
    }
    if (Result<void> done = made.makePrograms(); !done) {
        return tl::make_unexpected(done.error());
    }
    return made;
}

Result<void> Passes::makeFramebuffers() {
    const Gl& gl = *gl_;
    const auto target = [&](GLenum format, GLint filter = GL_NEAREST) {
        return makeTarget(gl, format, width_, height_, filter);
    };
    colour_ = target(kColourFormat);
    normal_ = target(kNormalFormat);
    motion_ = target(kMotionFormat);
    depth_ = target(kDepthFormat);
    display_ = target(GL_RGBA8);
    Result<GLuint> made = makeFramebuffer(gl, {colour_, normal_, motion_}, depth_);
    gbuffer_fb_ = made.value_or(0);
    for (int i = 0; i < 2 && made; ++i) {
        history_[i] = target(kColourFormat, GL_LINEAR);
        made = makeFramebuffer(gl, {history_[i]}, 0);
        history_fb_[i] = made.value_or(0);
    }
    if (made) {
        made = makeFramebuffer(gl, {}, depth_);
        depth_fb_ = made.value_or(0);
    }
    if (made) {
        made = makeFramebuffer(gl, {display_}, 0);
        display_fb_ = made.value_or(0);
    }
    return made.map([](GLuint) {});
}

Result<void> Passes::makePrograms() {
    const Gl& gl = *gl_;
    const Result<GLuint> temporal = makeProgram(gl, temporalProgram());
    if (!temporal) {
        return tl::make_unexpected(temporal.error());
    }
    const Result<GLuint> encode = makeProgram(gl, outputProgram());
    if (!encode) {
        return tl::make_unexpected(encode.error());
    }
    temporal_ = *temporal;
    encode_ = *encode;
    gl.glUseProgram(temporal_);
    const auto find = [&](const char* name) { return gl.glGetUniformLocation(temporal_, name); };
    gl.glUniform1i(find("u_colour"), 0);
    gl.glUniform1i(find("u_motion"), 1);
    gl.glUniform1i(find("u_history"), 2);
    gl.glUniform2f(find("u_size"), float(width_), float(height_));
    gl.glUniform2f(find("u_pixel"), 1.0f / float(width_), 1.0f / float(height_));
    keep_ = find("u_keep");
    gl.glGenVertexArrays(1, &empty_vertices_);
    return {};
}

void Passes::beginGbuffer(const std::array<float, 3>& background) {
    clearGbuffer(gbuffer_fb_, background);
}

Result<void> Passes::beginMultisampled(int samples, const std::array<float, 3>& background) {
    if (multisampled_fb_ == 0) {
        const Gl& gl = *gl_;
        constexpr GLenum kFormats[] = {kColourFormat, kNormalFormat, kMotionFormat, kDepthFormat};
        constexpr GLenum kPlaces[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                      GL_COLOR_ATTACHMENT2, GL_DEPTH_ATTACHMENT};
        GLuint buffers[4] = {};
        gl.glGenRenderbuffers(4, buffers);
        gl.glGenFramebuffers(1, &multisampled_fb_);
        gl.glBindFramebuffer(GL_FRAMEBUFFER, multisampled_fb_);
        for (int i = 0; i < 4; ++i) {
            gl.glBindRenderbuffer(GL_RENDERBUFFER, buffers[i]);
            gl.glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, kFormats[i], width_,
                                                height_);
            gl.glFramebufferRenderbuffer(GL_FRAMEBUFFER, kPlaces[i], GL_RENDERBUFFER, buffers[i]);
        }
        gl.glDrawBuffers(3, kPlaces);
        if (gl.glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
            return fail("the driver has no such multisampling");
        }
    }
    clearGbuffer(multisampled_fb_, background);
    return {};
}

void Passes::averageSamples() {
    const Gl& gl = *gl_;
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, multisampled_fb_);
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, history_fb_[newest_]);
    gl.glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
}

void Passes::clearGbuffer(GLuint framebuffer, const std::array<float, 3>& background) {
    const Gl& gl = *gl_;
    gl.glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.glViewport(0, 0, width_, height_);
    const float colour[] = {background[0], background[1], background[2], 0.0f};
    const float zeros[] = {0, 0, 0, 0}, farthest = reversed_ ? 0.0f : 1.0f;
    gl.glClearBufferfv(GL_COLOR, 0, colour);
    gl.glClearBufferfv(GL_COLOR, 1, zeros);
    gl.glClearBufferfv(GL_COLOR, 2, zeros);
    gl.glClearBufferfv(GL_DEPTH, 0, &farthest);
}

void Passes::beginDepth() {
    gl_->glBindFramebuffer(GL_FRAMEBUFFER, depth_fb_);
    gl_->glViewport(0, 0, width_, height_);
    const float farthest = reversed_ ? 0.0f : 1.0f;
    gl_->glClearBufferfv(GL_DEPTH, 0, &farthest);
}

void Passes::bindTexture(int unit, GLuint texture) {
    gl_->glActiveTexture(GL_TEXTURE0 + GLenum(unit));
    gl_->glBindTexture(GL_TEXTURE_2D, texture);
}

void Passes::drawWhole(GLuint framebuffer, GLuint program) {
    gl_->glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl_->glViewport(0, 0, width_, height_);
    gl_->glBindVertexArray(empty_vertices_);
    gl_->glUseProgram(program);
}

void Passes::resolve(bool reset) {
    const int older = newest_;
    newest_ = 1 - newest_;
    drawWhole(history_fb_[newest_], temporal_);
    gl_->glUniform1f(keep_, reset ? 0.0f : kKeep);
    bindTexture(0, colour_);
    bindTexture(1, motion_);
    bindTexture(2, history_[older]);
    gl_->glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Passes::output() {
    drawWhole(display_fb_, encode_);
    bindTexture(0, history_[newest_]);
    gl_->glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Four floats a pixel, the lowest row first.
std::vector<float> Passes::readFloats(GLuint framebuffer, int attachment) {
    const Gl& gl = *gl_;
    gl.glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.glReadBuffer(GL_COLOR_ATTACHMENT0 + GLenum(attachment));
    std::vector<float> pixels(size_t(width_) * size_t(height_) * 4);
    gl.glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, pixels.data());
    gl.glReadBuffer(GL_COLOR_ATTACHMENT0);
    return pixels;
}

Image<Rgb8> Passes::read(GLuint framebuffer) {
    const std::vector<float> pixels = readFloats(framebuffer, 0);
    const OutputTable table;
    Image<Rgb8> image(width_, height_);
    for (int y = 0; y < height_; ++y) {
        const float* row = pixels.data() + size_t(height_ - 1 - y) * size_t(width_) * 4;
        for (int x = 0; x < width_; ++x) {
            const auto code = [&](int channel) {
                const float light = std::min(std::max(row[4 * x + channel], 0.0f), 15.0f);
                return table[uint16_t(roundToInt(light * 4096.0f))];
            };
            image.at(x, y) = {code(0), code(1), code(2)};
        }
    }
    return image;
}

Image<PeerMotion> Passes::readMotion() {
    const std::vector<float> colours = readFloats(gbuffer_fb_, 0);
    const std::vector<float> motions = readFloats(gbuffer_fb_, 2);
    Image<PeerMotion> image(width_, height_);
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const size_t at = (size_t(height_ - 1 - y) * size_t(width_) + size_t(x)) * 4;
            image.at(x, y) = {motions[at], -motions[at + 1], colours[at + 3] > 0.0f};
        }
    }
    return image;
}

Image<Rgb8> Passes::readColour() {
    return read(gbuffer_fb_);
}

Image<Rgb8> Passes::readHistory() {
    return read(history_fb_[newest_]);
}

}  // namespace still::peer
