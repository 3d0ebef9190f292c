#include "tests/support/minimize.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <sstream>

namespace still::test {
namespace {

template <class T>
void eraseRange(std::vector<T>& items, size_t begin, size_t end) {
    items.erase(items.begin() + ptrdiff_t(begin), items.begin() + ptrdiff_t(end));
}

void dropTriangles(Mesh& mesh, size_t begin, size_t end) {
    eraseRange(mesh.indices, begin * 3, end * 3);
    uint32_t first = 0;
    for (MeshPart& part : mesh.parts) {
        const uint32_t low = std::max(part.first_triangle, uint32_t(begin));
        const uint32_t high = std::min(part.first_triangle + part.triangle_count, uint32_t(end));
        part.triangle_count -= high > low ? high - low : 0;
        part.first_triangle = first;
        first += part.triangle_count;
    }
    std::erase_if(mesh.parts, [](const MeshPart& part) { return part.triangle_count == 0; });
}

void dropUnusedVertices(Mesh& mesh) {
    Mesh packed;
    packed.parts = mesh.parts;
    std::vector<int64_t> place(mesh.x.size(), -1);
    for (const uint32_t v : mesh.indices) {
        if (place[v] < 0) {
            place[v] = int64_t(packed.x.size());
            packed.x.push_back(mesh.x[v]);
            packed.y.push_back(mesh.y[v]);
            packed.z.push_back(mesh.z[v]);
            packed.attributes.push_back(mesh.attributes[v]);
            if (!mesh.tangents.empty()) {
                packed.tangents.push_back(mesh.tangents[v]);
            }
        }
        packed.indices.push_back(uint32_t(place[v]));
    }
    mesh = packed;
}

void dropUnusedMeshes(TestScene& scene) {
    std::vector<Mesh> used;
    for (Instance& instance : scene.instances) {
        used.push_back(scene.meshes[instance.mesh]);
        instance.mesh = uint32_t(used.size() - 1);
    }
    scene.meshes = used;
}

/// The part of the picture from column x and row y on.
void crop(FrameView& view, int x, int y, int width, int height) {
    for (glm::dmat4* m : {&view.view_projection, &view.view_projection_before}) {
        const double sx = double(view.width) / width, sy = double(view.height) / height;
        const double ox = double(view.width - 2 * x) / width - 1;
        const double oy = 1 - double(view.height - 2 * y) / height;
        *m = glm::row(*m, 0, sx * glm::row(*m, 0) + ox * glm::row(*m, 3));
        *m = glm::row(*m, 1, sy * glm::row(*m, 1) + oy * glm::row(*m, 3));
    }
    view.width = width;
    view.height = height;
}

class Minimizer {
  public:
    Minimizer(DrawCase found, const DrawCheck& check, int tries)
        : best_(std::move(found)), check_(check), tries_(tries) {}

    DrawCase run() {
        if (check_(best_).empty()) {
            return best_;
        }
        for (bool better = true; better && tries_ > 0;) {
            better = dropThings();
            better |= cropPicture();
            better |= makePlain();
            better |= roundPlaces();
        }
        return best_;
    }

  private:
    /// Keeps the case that `change` makes of the best one if it is still wrong.
    template <class Change>
    bool attempt(const Change& change) {
        if (tries_ <= 0) {
            return false;
        }
        --tries_;
        DrawCase candidate = best_;
        change(candidate);
        if (check_(candidate).empty()) {
            return false;
        }
        best_ = std::move(candidate);
        return true;
    }

    /// Takes away as many of `count()` things as can be spared: all, halves, … single ones.
    template <class Count, class Drop>
    bool drop(const Count& count, const Drop& drop_range) {
        bool better = false;
        for (size_t chunk = count(); chunk >= 1; chunk /= 2) {
            for (size_t begin = 0; begin < count();) {
                const size_t end = std::min(begin + chunk, count());
                const bool spared = attempt([&](DrawCase& c) { drop_range(c.scene, begin, end); });
                better |= spared;
                begin = spared ? begin : end;
            }
        }
        return better;
    }

    bool dropThings() {
        bool better = drop([&] { return best_.scene.instances.size(); },
                           [](TestScene& s, size_t begin, size_t end) {
                               eraseRange(s.instances, begin, end);
                               dropUnusedMeshes(s);
                           });
        for (size_t m = 0; m < best_.scene.meshes.size(); ++m) {
            better |= drop([&] { return size_t{best_.scene.meshes[m].triangleCount()}; },
                           [m](TestScene& s, size_t begin, size_t end) {
                               dropTriangles(s.meshes[m], begin, end);
                           });
            if (best_.scene.meshes[m].indices.size() < best_.scene.meshes[m].x.size()) {
                attempt([&](DrawCase& c) { dropUnusedVertices(c.scene.meshes[m]); });
            }
        }
        better |= drop([&] { return best_.scene.lighting.points.size(); },
                       [](TestScene& s, size_t begin, size_t end) {
                           eraseRange(s.lighting.points, begin, end);
                       });
        return dropMaterials() || better;
    }

    bool dropMaterials() {
        return drop(
            [&] { return best_.scene.materials.size() - 1; },
            [](TestScene& s, size_t begin, size_t end) {
                // The first one stays, and takes the places of those that go.
                eraseRange(s.materials, begin + 1, end + 1);
                for (Mesh& mesh : s.meshes) {
                    for (MeshPart& part : mesh.parts) {
                        const uint32_t k = part.material;
                        part.material = k <= begin ? k : k <= end ? 0 : k - uint32_t(end - begin);
                    }
                }
            });
    }

    bool cropPicture() {
        bool better = false;
        for (bool smaller = true; smaller;) {
            const int w = best_.view.width, h = best_.view.height;
            const int left = w / 2, top = h / 2;
            const auto to = [&](int x, int y, int width, int height) {
                return width > 0 && height > 0 && (width < w || height < h) &&
                       attempt([&](DrawCase& c) { crop(c.view, x, y, width, height); });
            };
            smaller = to(0, 0, left, h) || to(left, 0, w - left, h) || to(0, 0, w, top) ||
                      to(0, top, w, h - top) || to(0, 0, w - 1, h) || to(1, 0, w - 1, h) ||
                      to(0, 0, w, h - 1) || to(0, 1, w, h - 1);
            better |= smaller;
        }
        return better;
    }

    /// Of an object of class T, takes the plain value of one that differs from it.
    template <class T, class Get>
    bool plain(const Get& get, const T& value) {
        return !(get(best_) == value) && attempt([&](DrawCase& c) { get(c) = value; });
    }

    bool makePlain() {
        bool better = plain([](DrawCase& c) -> int& { return c.view.jitter_x_fx8; }, 0);
        better |= plain([](DrawCase& c) -> int& { return c.view.jitter_y_fx8; }, 0);
        better |= plain([](DrawCase& c) -> uint32_t& { return c.view.sample; }, 0u);
        better |= plain([](DrawCase& c) -> glm::dmat4& { return c.view.view_projection_before; },
                        glm::dmat4(best_.view.view_projection));
        better |= plain(
            [](DrawCase & c) -> auto& { return c.scene.lighting.sun.colour; },
            std::array<float, 3>{});
        better |= plain(
            [](DrawCase & c) -> auto& { return c.scene.lighting.ambient; },
            std::array<float, 3>{1, 1, 1});
        for (size_t i = 0; i < best_.scene.instances.size(); ++i) {
            const auto now = [i](DrawCase& c) -> Affine& { return c.scene.instances[i].transform; };
            const auto before = [i](DrawCase& c) -> Affine& {
                return c.scene.instances[i].transform_before;
            };
            better |= plain(before, Affine(now(best_)));
            better |= plain(now, kIdentity);
            better |= plain(before, Affine(now(best_)));
        }
        for (size_t k = 0; k < best_.scene.materials.size(); ++k) {
            better |= plainMaterial(k);
        }
        return better;
    }

    bool plainMaterial(size_t k) {
        const auto material = [k](DrawCase& c) -> Material& { return c.scene.materials[k]; };
        if (plain(material, Material{})) {
            return true;
        }
        const auto field = [&](auto member) {
            return plain(
                [&](DrawCase & c) -> auto& { return material(c).*member; }, Material{}.*member);
        };
        bool better = field(&Material::height_texture);
        better |= field(&Material::normal_texture);
        better |= field(&Material::colour_texture);
        better |= field(&Material::alpha_texture);
        better |= field(&Material::alpha_mode);
        better |= field(&Material::opacity);
        better |= field(&Material::specular);
        better |= field(&Material::shininess);
        better |= field(&Material::emission);
        better |= field(&Material::diffuse);
        better |= field(&Material::u_offset);
        return field(&Material::v_offset) || better;
    }

    /// Coordinates with few digits, all vertices at once or one by one.
    bool roundPlaces() {
        bool better = false;
        for (size_t m = 0; m < best_.scene.meshes.size(); ++m) {
            const size_t count = best_.scene.meshes[m].x.size();
            for (const float steps : {1.0f, 4.0f, 16.0f, 256.0f}) {
                const auto rounded = [&](Mesh& mesh, size_t v) {
                    for (std::vector<float>* axis : {&mesh.x, &mesh.y, &mesh.z}) {
                        (*axis)[v] = std::floor((*axis)[v] * steps + 0.5f) / steps;
                    }
                };
                const auto isRound = [&](size_t v) {
                    Mesh copy = best_.scene.meshes[m];
                    rounded(copy, v);
                    const Mesh& mesh = best_.scene.meshes[m];
                    return copy.x[v] == mesh.x[v] && copy.y[v] == mesh.y[v] &&
                           copy.z[v] == mesh.z[v];
                };
                for (size_t v = 0; v < count && count <= 12; ++v) {
                    better |=
                        !isRound(v) && attempt([&](DrawCase& c) { rounded(c.scene.meshes[m], v); });
                }
            }
        }
        return better;
    }

    DrawCase best_;
    const DrawCheck& check_;
    int tries_;
};

/// Numbers that C++ reads back as the same float or double.
template <class Values>
std::string listOf(const Values& values, int digits) {
    std::ostringstream text;
    text.precision(digits);
    const char* separator = "";
    for (const auto& value : values) {
        text << separator << +value;
        separator = ", ";
    }
    return text.str();
}

std::string matrixText(const glm::dmat4& m) {
    std::string text;
    for (int column = 0; column < 4; ++column) {
        const std::array<double, 4> values{m[column][0], m[column][1], m[column][2], m[column][3]};
        text += (column == 0 ? "" : ", ") + listOf(values, 17);
    }
    return "glm::dmat4(" + text + ")";
}

void writeMesh(std::ostream& out, const Mesh& mesh) {
    out << "scene.meshes.back().x = {" << listOf(mesh.x, 9) << "};\n"
        << "scene.meshes.back().y = {" << listOf(mesh.y, 9) << "};\n"
        << "scene.meshes.back().z = {" << listOf(mesh.z, 9) << "};\n"
        << "scene.meshes.back().indices = {" << listOf(mesh.indices, 9) << "};\n";
    for (const VertexAttributes& a : mesh.attributes) {
        out << "scene.meshes.back().attributes.push_back({"
            << listOf(std::array{a.nx, a.ny, a.nz, a.u, a.v}, 9) << "});\n";
    }
    for (const VertexTangent& t : mesh.tangents) {
        out << "scene.meshes.back().tangents.push_back({"
            << listOf(std::array{t.x, t.y, t.z, t.handedness}, 9) << "});\n";
    }
    for (const MeshPart& p : mesh.parts) {
        out << "scene.meshes.back().parts.push_back({" << p.first_triangle << ", "
            << p.triangle_count << ", " << p.material << "});\n";
    }
}

void writeMaterial(std::ostream& out, size_t k, const Material& m) {
    if (m == Material{}) {
        return;
    }
    out << "scene.materials[" << k << "] = {.diffuse = {" << listOf(m.diffuse, 9)
        << "}, .specular = {" << listOf(m.specular, 9) << "}, .emission = {"
        << listOf(m.emission, 9) << "}, .shininess = " << listOf(std::array{m.shininess}, 9)
        << ", .opacity = " << listOf(std::array{m.opacity}, 9) << ", .alpha_mode = AlphaMode("
        << int(m.alpha_mode) << "), .colour_texture = " << m.colour_texture
        << ", .normal_texture = " << m.normal_texture << ", .alpha_texture = " << m.alpha_texture
        << ", .height_texture = " << m.height_texture
        << ", .height_scale = " << listOf(std::array{m.height_scale}, 9)
        << ", .u_offset = " << listOf(std::array{m.u_offset}, 9)
        << ", .v_offset = " << listOf(std::array{m.v_offset}, 9) << "};\n";
}

void writeInstance(std::ostream& out, const Instance& instance) {
    if (instance.transform != kIdentity) {
        out << "scene.instances.back().transform = {" << listOf(instance.transform, 9) << "};\n";
    }
    if (instance.transform_before != kIdentity) {
        out << "scene.instances.back().transform_before = {" << listOf(instance.transform_before, 9)
            << "};\n";
    }
}

void writeLight(std::ostream& out, const Lighting& lighting) {
    out << "scene.lighting.ambient = {" << listOf(lighting.ambient, 9) << "};\n";
    if (lighting.sun.colour != std::array<float, 3>{}) {
        out << "scene.lighting.sun = {{" << listOf(lighting.sun.direction, 9) << "}, {"
            << listOf(lighting.sun.colour, 9) << "}};\n";
    }
    for (const PointLight& point : lighting.points) {
        out << "scene.lighting.points.push_back({{" << listOf(point.position, 9) << "}, {"
            << listOf(point.colour, 9) << "}});\n";
    }
}

}  // namespace

DrawCase minimized(DrawCase found, const DrawCheck& check, int tries) {
    return Minimizer(std::move(found), check, tries).run();
}

std::string asCode(const DrawCase& shown) {
    const FrameView& view = shown.view;
    const TestScene& scene = shown.scene;
    std::ostringstream out;
    out << "FrameView view{.width = " << view.width << ", .height = " << view.height << "};\n"
        << "view.view_projection = " << matrixText(view.view_projection) << ";\n"
        << "view.view_projection_before = " << matrixText(view.view_projection_before) << ";\n"
        << "view.eye = {" << listOf(std::array{view.eye.x, view.eye.y, view.eye.z}, 9) << "};\n"
        << "view.jitter_x_fx8 = " << view.jitter_x_fx8 << ";\n"
        << "view.jitter_y_fx8 = " << view.jitter_y_fx8 << ";\n"
        << "view.sample = " << view.sample << ";\n"
        << "TestScene scene;  // " << scene.instances.size() << " instances, "
        << scene.textures.size() + scene.alpha_textures.size() << " textures are not shown\n"
        << "scene.materials.resize(" << scene.materials.size() << ");\n";
    for (size_t k = 0; k < scene.materials.size(); ++k) {
        writeMaterial(out, k, scene.materials[k]);
    }
    writeLight(out, scene.lighting);
    for (const Instance& instance : scene.instances) {
        out << "scene.addMesh();\n";
        writeInstance(out, instance);
        writeMesh(out, scene.meshes[instance.mesh]);
    }
    return out.str();
}

}  // namespace still::test
