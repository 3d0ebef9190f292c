#pragma once
// printf() into a string.

#include <cstdio>
#include <string>

namespace still::command {

/// At most 255 characters; what is longer is cut off.
template <class... Values>
std::string formatted(const char* format, Values... values) {
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

}  // namespace still::command
