#pragma once
// The references of a case: found in the cache, or made.

#include <functional>

#include "demos/stillframe/cell.h"

namespace still::command {

/// Lists the compared frames of a segment with their references, which have at most `samples`, on
/// all workers. `advance` is called once for each of them, by any thread.
Outcome<void> makeReferences(PreparedCase& prepared, size_t segment, int samples,
                             const FileCache& cache, Workers& workers,
                             const std::function<void()>& advance);

}  // namespace still::command
