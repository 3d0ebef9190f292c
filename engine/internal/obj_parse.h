#pragma once
// The statements of an OBJ file as flat arrays, checked but not yet turned into triangles.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/result.h"

namespace still {

/// Indices from 0 into ObjFile; kNoIndex where the face gives none, or none that exists.
struct ObjCorner {
    int32_t position, texcoord, normal;
};
constexpr int32_t kNoIndex = -1;

/// Faces from `first_face` up to the next run share group and material.
struct ObjRun {
    uint32_t first_face = 0;
    int32_t material = kNoIndex;  ///< into ObjFile::materials
};

struct ObjFile {
    std::vector<std::array<float, 3>> positions;  ///< finite
    std::vector<std::array<float, 2>> texcoords;  ///< finite
    std::vector<std::array<float, 3>> normals;    ///< as in the file; zero where it is broken
    std::vector<ObjCorner> corners;
    std::vector<uint32_t> face_begin;  ///< into corners; one more than there are faces
    std::vector<ObjRun> runs;
    std::vector<std::string> materials;  ///< names in order of first use
    std::vector<std::string> libraries;  ///< arguments of mtllib, a statement each
    std::vector<std::string> warnings;

    size_t faceCount() const { return face_begin.size() - 1; }
};

/// Parses OBJ text; `name` stands in messages. Each face has at least three corners.
Result<ObjFile> parseObj(std::string text, const std::string& name);

}  // namespace still
