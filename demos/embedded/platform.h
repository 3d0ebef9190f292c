#pragma once
// What differs between the board and the desktop.

#include <string_view>

namespace spin {

void print(std::string_view text);

/// Prints the line and ends the program with exit code 1.
[[noreturn]] void fail(std::string_view line);

}  // namespace spin
