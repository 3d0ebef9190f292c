#include "engine/scene.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/det_math.h"
#include "engine/internal/tracks.h"

namespace still {

bool varies(const ObjectTracks& tracks) {
    return varies(tracks.translation) || varies(tracks.rotation_deg) || varies(tracks.scale);
}

double lengthOf(const glm::dvec3& v) {
    return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

glm::dvec3 unit(const glm::dvec3& v) {
    const double length = lengthOf(v);
    return {v.x / length, v.y / length, v.z / length};
}

glm::dvec3 originOf(const glm::dmat4& affine) {
    const glm::dvec3 x(affine[0]), y(affine[1]), z(affine[2]), moved(affine[3]);
    const double volume = glm::dot(x, glm::cross(y, z));
    if (volume == 0) {
        return glm::dvec3(0);
    }
    return {-glm::dot(moved, glm::cross(y, z)) / volume,
            -glm::dot(moved, glm::cross(z, x)) / volume,
            -glm::dot(moved, glm::cross(x, y)) / volume};
}

glm::dmat3 rotationAbout(const glm::dvec3& unit_axis, double turns) {
    const double s = det::sinTurns(turns);
    const double c = det::cosTurns(turns);
    const double t = 1 - c;
    const auto [x, y, z] = std::array{unit_axis.x, unit_axis.y, unit_axis.z};
    return {glm::dvec3(t * x * x + c, t * x * y + s * z, t * x * z - s * y),
            glm::dvec3(t * x * y - s * z, t * y * y + c, t * y * z + s * x),
            glm::dvec3(t * x * z + s * y, t * y * z - s * x, t * z * z + c)};
}

glm::dmat4 worldTransform(const SceneObject& object, double frame) {
    const ObjectTracks& tracks = object.tracks;
    const glm::dvec3 translation = valueAt(tracks.translation, frame, glm::dvec3(0));
    const glm::dvec3 scale = valueAt(tracks.scale, frame, glm::dvec3(1));
    const double turns = valueAt(tracks.rotation_deg, frame, 0.0) / 360;
    const glm::dmat3 rotation = rotationAbout(tracks.rotation_axis, turns);
    const glm::dmat4 placed(glm::dvec4(rotation[0] * scale.x, 0),
                            glm::dvec4(rotation[1] * scale.y, 0),
                            glm::dvec4(rotation[2] * scale.z, 0), glm::dvec4(translation, 1));
    return placed * object.base;
}

Affine toAffine(const glm::dmat4& matrix) {
    Affine rows;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            rows[size_t(row * 4 + column)] = float(matrix[column][row]);
        }
    }
    return rows;
}

uint64_t Scene::triangleCount() const {
    uint64_t count = 0;
    for (const SceneObject& object : objects) {
        count += meshes[object.mesh].triangleCount();
    }
    return count;
}

Bounds Scene::bounds(double frame) const {
    Bounds box;
    for (const SceneObject& object : objects) {
        const glm::dmat4 world = worldTransform(object, frame);
        const Mesh& mesh = meshes[object.mesh];
        for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
            const glm::dvec3 p(world * glm::dvec4(mesh.x[i], mesh.y[i], mesh.z[i], 1));
            box.min = box.valid ? glm::min(box.min, p) : p;
            box.max = box.valid ? glm::max(box.max, p) : p;
            box.valid = true;
        }
    }
    return box;
}

}  // namespace still
