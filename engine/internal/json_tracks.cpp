#include "engine/internal/json_tracks.h"

#include "engine/det_math.h"
#include "engine/internal/tracks.h"

namespace still {
namespace {

glm::dvec3 readScale(const JsonCursor& cursor) {
    const glm::dvec3 scale = cursor.is(JsonValue::Type::number)
                                 ? glm::dvec3(cursor.number(-kMaxCoordinate, kMaxCoordinate))
                                 : readPoint(cursor);
    if (scale.x == 0 || scale.y == 0 || scale.z == 0) {
        cursor.refuse("expected a scale without zeros");
    }
    return scale;
}

bool sameSigns(const glm::dvec3& a, const glm::dvec3& b) {
    return (a.x > 0) == (b.x > 0) && (a.y > 0) == (b.y > 0) && (a.z > 0) == (b.z > 0);
}

}  // namespace

glm::dvec3 readPoint(const JsonCursor& cursor) {
    return cursor.vector(-kMaxCoordinate, kMaxCoordinate);
}

glm::dvec3 readDirection(const JsonCursor& cursor) {
    const glm::dvec3 v = readPoint(cursor);
    // Below this the squares underflow and the length loses its precision.
    if (!(lengthOf(v) > 1e-100)) {
        cursor.refuse("expected a direction, found a vector of length 0");
        return {0, -1, 0};
    }
    return unit(v);
}

std::array<float, 3> readColour(const JsonCursor& cursor) {
    if (cursor.is(JsonValue::Type::object)) {
        cursor.expectKeys({"srgb"});
        const glm::dvec3 c = cursor.require("srgb").vector(0, 1);
        return {float(det::linearFromSrgb(c.x)), float(det::linearFromSrgb(c.y)),
                float(det::linearFromSrgb(c.z))};
    }
    const glm::dvec3 c = cursor.vector(0, kMaxLight);
    return {float(c.x), float(c.y), float(c.z)};
}

std::vector<std::pair<double, JsonCursor>> readKeys(const JsonCursor& cursor) {
    cursor.expectKeys({"keys"});
    std::vector<std::pair<double, JsonCursor>> keys;
    for (const JsonCursor& key : cursor.require("keys").items(1, SIZE_MAX)) {
        key.expectKeys({"frame", "value"});
        const JsonCursor frame_at = key.require("frame");
        const double frame = frame_at.number(-kMaxFrame, kMaxFrame);
        if (!keys.empty() && !(frame > keys.back().first)) {
            frame_at.expected("a frame after that of the key before");
        }
        keys.emplace_back(frame, key.require("value"));
    }
    return keys;
}

Track<glm::dvec3> readPointTrack(const JsonCursor& cursor) {
    return readTrack(cursor, readPoint);
}

Track<double> readNumberTrack(const JsonCursor& cursor, double lowest, double highest) {
    return readTrack(cursor, [=](const JsonCursor& at) { return at.number(lowest, highest); });
}

Track<glm::dvec2> readOffsetTrack(const JsonCursor& cursor) {
    return readTrack(cursor, [](const JsonCursor& at) {
        const std::vector<double> offset = at.numbers(2, -kMaxOffset, kMaxOffset);
        return glm::dvec2(offset[0], offset[1]);
    });
}

Track<glm::dvec3> readScaleTrack(const JsonCursor& cursor) {
    Track<glm::dvec3> track = readTrack(cursor, readScale);
    for (const auto& key : track.keys) {
        if (!sameSigns(key.value, track.keys.front().value)) {
            cursor.refuse("expected scales that keep their signs, since none may pass through 0");
        }
    }
    return track;
}

}  // namespace still
