#pragma once
// A model as bytes and back. Small things go into a table, one behind the other; arrays stay apart,
// as they lie in memory, so that several can be read at once. Bytes from anywhere give a model that
// is safe to draw, or none.

#include <cstdint>
#include <functional>
#include <istream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/internal/input_log.h"
#include "engine/internal/obj.h"

namespace still {

/// Where a model comes from.
struct ModelOrigin {
    std::string key;  ///< how and from where the OBJ was named; messages depend on it
    std::vector<InputLog::Entry> inputs;
};

/// An array in a file: its size, and the hash of its contents in pieces, which is also in what
/// pieces they are read, so that they are hashed and checked while they are in the cache.
struct ArrayInfo {
    uint64_t bytes = 0, hash = 0;
};

struct FlatArray {
    std::string_view bytes;  ///< of the model
    size_t piece_bytes = 0;  ///< whole elements

    ArrayInfo info() const;
};

struct FlatModel {
    std::string table;
    std::vector<FlatArray> arrays;
};

/// The model must outlive what is returned.
FlatModel flatten(const ModelOrigin& origin, const ObjModel& model);

/// The opposite, in steps.
struct ModelFill {
    ArrayInfo info;
    /// Reads the array from where the stream stands; false when it is not what `info` says or holds
    /// values that the model must not have. Different arrays may be filled at the same time.
    std::function<bool(std::istream&)> run;
};

/// Fills `origin`, and `model` but for its arrays, which the result does; `model` must stay in
/// place meanwhile. Nothing when the table is damaged. Never takes more memory than a small
/// multiple of what `table` and `arrays` say.
std::vector<ModelFill> unflatten(std::string_view table, std::span<const ArrayInfo> arrays,
                                 ModelOrigin& origin, ObjModel& model);

/// Whether all indices are in range and all sizes fit, as the rasterizer takes for granted.
bool isSound(const ObjModel& model);

}  // namespace still
