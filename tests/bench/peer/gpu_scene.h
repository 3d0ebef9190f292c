#pragma once
// A Scene as OpenGL holds it: static buffers and textures with all their levels, and the pass that
// draws it into the same planes as Stillframe's G-buffer.

#include <map>
#include <span>
#include <vector>

#include "engine/jitter.h"
#include "engine/timeline.h"
#include "tests/bench/peer/gl.h"

namespace still::peer {

/// The target, and where in its pixels the samples lie.
struct View {
    int width = 0, height = 0;
    SampleOffset sample;
};

/// What the pass writes.
enum class Pass {
    gbuffer,  ///< colour, normal, motion and depth, lit as Stillframe does
    lambert,  ///< the same, but only Lambert × texture: no highlights, normal maps, point lights
    depth,    ///< depth alone
};

/// Draws what frameStateAt() says, object by object in submission order, one call per part.
class GpuScene {
  public:
    /// Uploads, and takes vertices and texels out of `scene`: the driver has copies of its own, and
    /// a program that only draws would not keep both. An Error names what the pass cannot draw.
    static Result<GpuScene> make(const Gl& gl, Scene& scene);

    /// Into the bound framebuffer of this size, cleared before. `scene` is the one of make(), or
    /// one that differs in its tracks alone.
    Result<void> draw(const Scene& scene, const FrameState& state, const View& view, Pass pass);

    /// True when depth is 1 at the near plane and 0 at the far one.
    bool reversedDepth() const { return gl_->glClipControlEXT != nullptr; }

  private:
    struct GpuMesh {
        GLuint vertex_array = 0;
        bool tangents = false;
    };
    /// One specialised program and where its uniforms are; −1 is ignored by OpenGL.
    struct Program {
        GLuint name = 0;
        GLint clip = -1, before = -1, world = -1, normal_matrix = -1, side = -1;
        GLint diffuse = -1, specular = -1, shininess = -1, emission = -1, opacity = -1;
        GLint uv_offset = -1;
        uint64_t frame = 0;  ///< when its uniforms of the whole frame were set
    };
    struct FrameMatrices;

    explicit GpuScene(const Gl& gl) : gl_(&gl) {}
    void upload(const Mesh& mesh);
    void upload(const Texture& texture);
    void upload(const AlphaTexture& texture);
    uint32_t featuresOf(const Material& material, bool tangents, const Lighting& lighting,
                        Pass pass) const;
    Result<Program*> use(uint32_t features, const FrameState& state, SampleOffset sample);
    void setFrameUniforms(const Program& program, const FrameState& state, SampleOffset sample);
    void setInstance(const Program& program, const Instance& instance,
                     const FrameMatrices& matrices);
    void setMaterial(const Program& program, const Material& material, uint32_t features);
    Result<void> drawInstance(const Scene& scene, const FrameState& state, const Instance& instance,
                              const FrameMatrices& matrices, Pass pass);

    const Gl* gl_;
    std::vector<GpuMesh> meshes_;
    std::vector<GLuint> textures_, alpha_textures_;
    std::map<uint32_t, Program> programs_;  ///< by features
    GLuint used_ = 0;
    uint64_t frame_ = 0;
};

}  // namespace still::peer
