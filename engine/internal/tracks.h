#pragma once
// Tracks and object transforms at a point in time. Double arithmetic in a written order.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/scene.h"

namespace still {

/// Value of a track at `frame`; `fallback` when it has no keys. On a key it is that key's value.
template <class T>
T valueAt(const Track<T>& track, double frame, const T& fallback) {
    const auto& keys = track.keys;
    if (keys.empty()) {
        return fallback;
    }
    size_t after = 0;
    while (after < keys.size() && keys[after].frame <= frame) {
        ++after;
    }
    if (after == 0) {
        return keys.front().value;
    }
    const auto& from = keys[after - 1];
    if (after == keys.size() || from.frame == frame) {
        return from.value;
    }
    const auto& to = keys[after];
    const double share = (frame - from.frame) / (to.frame - from.frame);
    return from.value + (to.value - from.value) * share;
}

/// True when some key differs from the first one.
template <class T>
bool varies(const Track<T>& track) {
    for (const auto& key : track.keys) {
        if (key.value != track.keys.front().value) {
            return true;
        }
    }
    return false;
}

/// True when the object does not stand still over the whole timeline.
bool varies(const ObjectTracks& tracks);

/// Rotation by `turns` about a unit axis, counter-clockwise seen from the axis' tip.
glm::dmat3 rotationAbout(const glm::dvec3& unit_axis, double turns);

/// T(frame) · R(frame) · S(frame) · base.
glm::dmat4 worldTransform(const SceneObject& object, double frame);

/// The upper three rows, rounded to float.
Affine toAffine(const glm::dmat4& matrix);

/// Where an affine matrix maps to the origin (Cramer's rule); 0 when it has no inverse.
glm::dvec3 originOf(const glm::dmat4& affine);

/// Whether a projection, or a view-projection, keeps parallels parallel.
inline bool isParallel(const glm::dmat4& m) {
    return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] > 0;
}

/// Length and unit vector by one square root and divisions. `v` must not be zero in unit().
double lengthOf(const glm::dvec3& v);
glm::dvec3 unit(const glm::dvec3& v);

}  // namespace still
