#include "tests/bench/peer/gpu_scene.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

#include "tests/bench/peer/shaders.h"

namespace still::peer {
namespace {

glm::dmat4 toMatrix(const Affine& a) {
    glm::dmat4 m{1.0};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            m[column][row] = double(a[size_t(row * 4 + column)]);
        }
    }
    return m;
}

/// The triangles, each wound as its normals say. Nothing is culled, so only the side that is lit
/// depends on it: Stillframe decides that by the normals, OpenGL by the winding.
std::vector<uint32_t> windingByNormals(const Mesh& mesh) {
    std::vector<uint32_t> indices = mesh.indices;
    for (size_t i = 0; i < indices.size(); i += 3) {
        glm::dvec3 corner[3], sum{0.0};
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t v = indices[i + k];
            corner[k] = {mesh.x[v], mesh.y[v], mesh.z[v]};
            const VertexAttributes& a = mesh.attributes[v];
            sum += glm::dvec3(a.nx, a.ny, a.nz);
        }
        const glm::dvec3 out = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        if (glm::dot(out, sum) < 0.0) {
            std::swap(indices[i + 1], indices[i + 2]);
        }
    }
    return indices;
}

/// Position, normal, texture coordinates; OpenGL's textures begin at the bottom, as v does.
std::vector<float> interleaved(const Mesh& mesh) {
    std::vector<float> out;
    out.reserve(size_t{mesh.vertexCount()} * 8);
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
        const VertexAttributes& a = mesh.attributes[i];
        out.insert(out.end(), {mesh.x[i], mesh.y[i], mesh.z[i], a.nx, a.ny, a.nz, a.u, a.v});
    }
    return out;
}

GLint wrapOf(Wrap wrap) {
    return wrap == Wrap::repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
}

GLuint makeMipmapped(const Gl& gl, GLenum format, const std::vector<TextureLevel>& levels,
                     Wrap wrap) {
    GLuint name = 0;
    gl.glGenTextures(1, &name);
    gl.glBindTexture(GL_TEXTURE_2D, name);
    gl.glTexStorage2D(GL_TEXTURE_2D, GLsizei(levels.size()), format, GLsizei(levels[0].width),
                      GLsizei(levels[0].height));
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrapOf(wrap));
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrapOf(wrap));
    return name;
}

/// 10 bits to 8. Gamma 2 stays: the shader squares what the sampler returns, which is cheaper for
/// the peer than decoding sRGB texel by texel.
uint8_t eightBits(uint32_t texel, int shift) {
    return uint8_t(((texel >> shift & 1023u) * 255u + 511u) / 1023u);
}

/// As frame_setup.cpp has it: cofactors, signed by the determinant.
glm::mat3 normalMatrix(const glm::dmat4& world, bool& mirrored) {
    const glm::dvec3 x(world[0]), y(world[1]), z(world[2]);
    const glm::dmat3 cofactors(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
    mirrored = glm::dot(x, cofactors[0]) < 0.0;
    return glm::mat3(mirrored ? -cofactors : cofactors);
}

}  // namespace

/// Of a frame, before each object's transform is applied.
struct GpuScene::FrameMatrices {
    glm::dmat4 clip{1.0};    ///< samples moved into the pixels' centres
    glm::dmat4 before{1.0};  ///< the previous frame's, to pixels from the lower left, times w
    SampleOffset sample;
};

namespace {

/// Row-wise operations on column vectors: row i of m += factor · row j of m.
void addRow(glm::dmat4& m, int i, int j, double factor) {
    for (int column = 0; column < 4; ++column) {
        m[column][i] += factor * m[column][j];
    }
}

void scaleRow(glm::dmat4& m, int i, double factor) {
    for (int column = 0; column < 4; ++column) {
        m[column][i] *= factor;
    }
}

}  // namespace

Result<GpuScene> GpuScene::make(const Gl& gl, Scene& scene) {
    for (const Material& material : scene.materials) {
        if (material.alpha_mode == AlphaMode::stochastic) {
            return fail(scene.name + ": the peer does not draw stochastic transparency");
        }
    }
    GpuScene made(gl);
    for (Mesh& mesh : scene.meshes) {
        made.upload(mesh);
        std::vector<MeshPart> parts = std::move(mesh.parts);
        mesh = Mesh{};
        mesh.parts = std::move(parts);
    }
    gl.glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (Texture& texture : scene.textures) {
        made.upload(texture);
        texture.texels = {};
    }
    for (AlphaTexture& texture : scene.alpha_textures) {
        made.upload(texture);
        texture.texels = {};
    }
    return made;
}

void GpuScene::upload(const Mesh& mesh) {
    const Gl& gl = *gl_;
    GLuint buffers[3] = {};
    GpuMesh& out = meshes_.emplace_back();
    gl.glGenVertexArrays(1, &out.vertex_array);
    gl.glBindVertexArray(out.vertex_array);
    gl.glGenBuffers(3, buffers);
    const std::vector<float> vertices = interleaved(mesh);
    gl.glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    gl.glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size() * sizeof(float)), vertices.data(),
                    GL_STATIC_DRAW);
    constexpr GLint kSizes[] = {3, 3, 2};
    size_t offset = 0;
    for (GLuint i = 0; i < 3; ++i) {
        gl.glVertexAttribPointer(i, kSizes[i], GL_FLOAT, GL_FALSE, 32,
                                 reinterpret_cast<const void*>(offset));
        gl.glEnableVertexAttribArray(i);
        offset += size_t(kSizes[i]) * sizeof(float);
    }
    out.tangents = !mesh.tangents.empty();
    if (out.tangents) {
        gl.glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
        gl.glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(mesh.tangents.size() * sizeof(VertexTangent)),
                        mesh.tangents.data(), GL_STATIC_DRAW);
        gl.glVertexAttribPointer(3, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
        gl.glEnableVertexAttribArray(3);
    }
    const std::vector<uint32_t> indices = windingByNormals(mesh);
    gl.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2]);
    gl.glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices.size() * sizeof(uint32_t)),
                    indices.data(), GL_STATIC_DRAW);
    gl.glBindVertexArray(0);
}

void GpuScene::upload(const Texture& texture) {
    textures_.push_back(makeMipmapped(*gl_, GL_RGBA8, texture.levels, texture.wrap));
    for (size_t i = 0; i < texture.levels.size(); ++i) {
        const TextureLevel& level = texture.levels[i];
        std::vector<uint8_t> texels;
        texels.reserve(size_t{level.width} * level.height * 4);
        for (uint32_t y = level.height; y-- > 0;) {
            for (uint32_t x = 0; x < level.width; ++x) {
                const uint32_t texel = texture.texels[level.offset + y * level.stride + x];
                texels.insert(texels.end(), {eightBits(texel, 0), eightBits(texel, 10),
                                             eightBits(texel, 20), uint8_t{255}});
            }
        }
        gl_->glTexSubImage2D(GL_TEXTURE_2D, GLint(i), 0, 0, GLsizei(level.width),
                             GLsizei(level.height), GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    }
}

void GpuScene::upload(const AlphaTexture& texture) {
    alpha_textures_.push_back(makeMipmapped(*gl_, GL_R8, texture.levels, texture.wrap));
    for (size_t i = 0; i < texture.levels.size(); ++i) {
        const TextureLevel& level = texture.levels[i];
        std::vector<uint8_t> texels;
        texels.reserve(size_t{level.width} * level.height);
        for (uint32_t y = level.height; y-- > 0;) {
            const uint8_t* row = texture.texels.data() + level.offset + y * level.stride;
            texels.insert(texels.end(), row, row + level.width);
        }
        gl_->glTexSubImage2D(GL_TEXTURE_2D, GLint(i), 0, 0, GLsizei(level.width),
                             GLsizei(level.height), GL_RED, GL_UNSIGNED_BYTE, texels.data());
    }
}

uint32_t GpuScene::featuresOf(const Material& material, bool tangents, const Lighting& lighting,
                              Pass pass) const {
    const auto bit = [](bool wanted, uint32_t feature) { return wanted ? feature : 0u; };
    uint32_t features = bit(material.alpha_mode == AlphaMode::test, kAlphaTest);
    features |= bit(features != 0 && material.alpha_texture != kNoTexture, kAlphaTexture);
    if (pass == Pass::depth) {
        return features | kDepthOnly;
    }
    features |= bit(material.colour_texture != kNoTexture, kColourTexture);
    if (pass == Pass::lambert) {
        return features;
    }
    const std::array<float, 3>& ks = material.specular;
    features |= bit(material.normal_texture != kNoTexture && tangents, kNormalMap);
    features |= bit(ks[0] > 0.0f || ks[1] > 0.0f || ks[2] > 0.0f, kHighlight);
    return features | uint32_t(lighting.points.size()) << kPointLightShift;
}

Result<GpuScene::Program*> GpuScene::use(uint32_t features, const FrameState& state,
                                         SampleOffset sample) {
    Program& program = programs_[features];
    const Gl& gl = *gl_;
    if (program.name == 0) {
        const Result<GLuint> made = makeProgram(gl, gbufferProgram(features));
        if (!made) {
            return tl::make_unexpected(made.error());
        }
        program.name = *made;
        const auto find = [&](const char* name) {
            return gl.glGetUniformLocation(program.name, name);
        };
        program.clip = find("u_clip");
        program.before = find("u_before");
        program.world = find("u_world");
        program.normal_matrix = find("u_normal_matrix");
        program.side = find("u_side");
        program.diffuse = find("u_diffuse");
        program.specular = find("u_specular");
        program.shininess = find("u_shininess");
        program.emission = find("u_emission");
        program.opacity = find("u_opacity");
        program.uv_offset = find("u_uv_offset");
    }
    if (used_ != program.name) {
        gl.glUseProgram(program.name);
        used_ = program.name;
    }
    if (program.frame != frame_) {
        setFrameUniforms(program, state, sample);
        program.frame = frame_;
    }
    return &program;
}

void GpuScene::setFrameUniforms(const Program& program, const FrameState& state,
                                SampleOffset sample) {
    const Gl& gl = *gl_;
    const auto find = [&](const char* name) { return gl.glGetUniformLocation(program.name, name); };
    const Lighting& lighting = state.lighting;
    const auto& d = lighting.sun.direction;
    const float to_sun[] = {-d[0], -d[1], -d[2]};
    const glm::vec3 eye(state.camera.eye);
    gl.glUniform1i(find("u_colour"), 0);
    gl.glUniform1i(find("u_normal_map"), 1);
    gl.glUniform1i(find("u_alpha"), 2);
    gl.glUniform3fv(find("u_ambient"), 1, lighting.ambient.data());
    gl.glUniform3fv(find("u_to_sun"), 1, to_sun);
    gl.glUniform3fv(find("u_sun"), 1, lighting.sun.colour.data());
    gl.glUniform3fv(find("u_eye"), 1, glm::value_ptr(eye));
    gl.glUniform2f(find("u_sample"), float(sample.x_fx8) / 256.0f, float(-sample.y_fx8) / 256.0f);
    std::vector<float> positions, colours;
    for (const PointLight& light : lighting.points) {
        positions.insert(positions.end(), light.position.begin(), light.position.end());
        colours.insert(colours.end(), light.colour.begin(), light.colour.end());
    }
    const GLsizei count = GLsizei(lighting.points.size());
    if (count > 0) {
        gl.glUniform3fv(find("u_point_position"), count, positions.data());
        gl.glUniform3fv(find("u_point_colour"), count, colours.data());
    }
}

void GpuScene::setInstance(const Program& program, const Instance& instance,
                           const FrameMatrices& matrices) {
    const Gl& gl = *gl_;
    const glm::dmat4 world = toMatrix(instance.transform);
    bool mirrored = false;
    const glm::mat3 normal = normalMatrix(world, mirrored);
    const glm::mat4 clip(matrices.clip * world), world_f(world);
    const glm::mat4 before(matrices.before * toMatrix(instance.transform_before));
    gl.glUniformMatrix4fv(program.clip, 1, GL_FALSE, glm::value_ptr(clip));
    gl.glUniformMatrix4fv(program.before, 1, GL_FALSE, glm::value_ptr(before));
    gl.glUniformMatrix4fv(program.world, 1, GL_FALSE, glm::value_ptr(world_f));
    gl.glUniformMatrix3fv(program.normal_matrix, 1, GL_FALSE, glm::value_ptr(normal));
    gl.glUniform1f(program.side, mirrored ? -1.0f : 1.0f);
}

void GpuScene::setMaterial(const Program& program, const Material& material, uint32_t features) {
    const Gl& gl = *gl_;
    const auto bind = [&](GLenum unit, GLuint texture) {
        gl.glActiveTexture(unit);
        gl.glBindTexture(GL_TEXTURE_2D, texture);
    };
    if ((features & kColourTexture) != 0) {
        bind(GL_TEXTURE0, textures_[size_t(material.colour_texture)]);
    }
    if ((features & kNormalMap) != 0) {
        bind(GL_TEXTURE1, textures_[size_t(material.normal_texture)]);
    }
    if ((features & kAlphaTexture) != 0) {
        bind(GL_TEXTURE2, alpha_textures_[size_t(material.alpha_texture)]);
    }
    gl.glUniform3fv(program.diffuse, 1, material.diffuse.data());
    gl.glUniform3fv(program.specular, 1, material.specular.data());
    gl.glUniform3fv(program.emission, 1, material.emission.data());
    gl.glUniform1f(program.shininess, std::clamp(material.shininess, 1.0f, 1024.0f));
    gl.glUniform1f(program.opacity, material.opacity);
    gl.glUniform2f(program.uv_offset, material.u_offset, material.v_offset);
}

Result<void> GpuScene::drawInstance(const Scene& scene, const FrameState& state,
                                    const Instance& instance, const FrameMatrices& matrices,
                                    Pass pass) {
    const Gl& gl = *gl_;
    const GpuMesh& mesh = meshes_[instance.mesh];
    const std::vector<MeshPart>& parts = scene.meshes[instance.mesh].parts;
    const std::span<const Material> materials = materialsOf(scene, state);
    gl.glBindVertexArray(mesh.vertex_array);
    const Program* ready = nullptr;
    for (const MeshPart& part : parts) {
        const Material& material = materials[part.material];
        const uint32_t features = featuresOf(material, mesh.tangents, state.lighting, pass);
        const Result<Program*> program = use(features, state, matrices.sample);
        if (!program) {
            return tl::make_unexpected(program.error());
        }
        if (ready != *program) {
            setInstance(**program, instance, matrices);
            ready = *program;
        }
        setMaterial(**program, material, features);
        gl.glDrawElements(
            GL_TRIANGLES, GLsizei(part.triangle_count * 3), GL_UNSIGNED_INT,
            reinterpret_cast<const void*>(size_t{part.first_triangle} * 3 * sizeof(uint32_t)));
    }
    return {};
}

Result<void> GpuScene::draw(const Scene& scene, const FrameState& state, const View& view,
                            Pass pass) {
    const Gl& gl = *gl_;
    ++frame_;
    used_ = 0;  // other passes have programs of their own
    FrameMatrices matrices{.clip = state.camera.view_projection,
                           .before = state.camera_before.view_projection,
                           .sample = view.sample};
    if (reversedDepth()) {
        gl.glClipControlEXT(GL_LOWER_LEFT_EXT, GL_ZERO_TO_ONE_EXT);
        scaleRow(matrices.clip, 2, -0.5);
        addRow(matrices.clip, 2, 3, 0.5);
    }
    addRow(matrices.clip, 0, 3, -2.0 * view.sample.x_fx8 / (256.0 * view.width));
    addRow(matrices.clip, 1, 3, 2.0 * view.sample.y_fx8 / (256.0 * view.height));
    addRow(matrices.before, 0, 3, 1.0);
    scaleRow(matrices.before, 0, 0.5 * view.width);
    addRow(matrices.before, 1, 3, 1.0);
    scaleRow(matrices.before, 1, 0.5 * view.height);

    gl.glEnable(GL_DEPTH_TEST);
    gl.glDepthFunc(reversedDepth() ? GL_GREATER : GL_LESS);
    for (const Instance& instance : state.instances) {
        if (auto drawn = drawInstance(scene, state, instance, matrices, pass); !drawn) {
            return drawn;
        }
    }
    gl.glDisable(GL_DEPTH_TEST);
    return {};
}

}  // namespace still::peer
