#pragma once
// The page that shows what differs.

#include <string>

namespace still::command {

/// The page around its data, which is JSON safe inside a script element: {"compared", "accept",
/// "cases": [a case of verifyJson() with "width", "height", "rectangles": [[x, y, width, height] …]
/// of all differing tiles and "pictures": {"expected", "actual", "diff"} as data URIs …]}.
std::string goldenPageAround(const std::string& data);

}  // namespace still::command
