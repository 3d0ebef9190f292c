#pragma once
// What the JSON reports share. Slow to compile: for the files that write them.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "demos/stillframe/statistics.h"

namespace still::command {

using Json = nlohmann::ordered_json;

inline Json statisticsJson(const std::vector<double>& times_ms) {
    const Statistics s = statisticsOf(times_ms);
    return {{"min_ms", s.min}, {"median_ms", s.median}, {"p95_ms", s.p95}};
}

/// File names may hold any bytes; JSON may not.
inline std::string text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace still::command
