#pragma once
// Values of scene files: vectors, colours and keyed tracks. Units and limits as in
// engine/README.md.

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/internal/json.h"
#include "engine/scene.h"

namespace still {

/// Largest coordinate of a scene file.
constexpr double kMaxCoordinate = 1e9;
/// Largest colour or intensity; the product of both fits float with ease.
constexpr double kMaxLight = 1e6;
/// Largest |offset| of texture coordinates.
constexpr double kMaxOffset = 1e6;
/// Largest |frame| of a key or a cut.
constexpr int kMaxFrame = 10000000;

glm::dvec3 readPoint(const JsonCursor& cursor);
/// Unit vector; refuses (0, 0, 0).
glm::dvec3 readDirection(const JsonCursor& cursor);
/// [r, g, b] in linear light or {"srgb": [r, g, b]} with components in 0 … 1.
std::array<float, 3> readColour(const JsonCursor& cursor);

/// A constant, or {"keys": [{"frame": N, "value": …}, …]} with strictly increasing frames;
/// read(cursor) reads one value.
template <class Read>
auto readTrack(const JsonCursor& cursor, Read&& read) -> Track<decltype(read(cursor))>;

/// Checks the frame numbers of {"keys": […]} and returns the keys; empty after an error.
std::vector<std::pair<double, JsonCursor>> readKeys(const JsonCursor& cursor);

template <class Read>
auto readTrack(const JsonCursor& cursor, Read&& read) -> Track<decltype(read(cursor))> {
    Track<decltype(read(cursor))> track;
    if (!cursor.is(JsonValue::Type::object)) {
        track.keys.push_back({0, read(cursor)});
        return track;
    }
    for (const auto& [frame, value] : readKeys(cursor)) {
        track.keys.push_back({frame, read(value)});
    }
    return track;
}

Track<glm::dvec3> readPointTrack(const JsonCursor& cursor);
Track<double> readNumberTrack(const JsonCursor& cursor, double lowest, double highest);
/// Pairs of texture coordinates.
Track<glm::dvec2> readOffsetTrack(const JsonCursor& cursor);
/// Numbers (the same in all axes) or vectors; components keep their sign and are never 0.
Track<glm::dvec3> readScaleTrack(const JsonCursor& cursor);

}  // namespace still
