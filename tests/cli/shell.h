#pragma once
// Runs the program as people do: by a shell, in a folder.

#include <filesystem>
#include <string>
#include <vector>

namespace still::test {

struct Ran {
    int code = 0;  ///< exit code; 128 + number when a signal ended it
    std::string out, err;
};

/// Runs `command` with sh in `folder`; `stillframe` in it is the program under test. Standard input
/// is empty. Output is taken through pipes, so a limit on file sizes does not touch it.
Ran shell(const std::filesystem::path& folder, const std::string& command);

/// Names of everything in the folder, hidden files too, sorted.
std::vector<std::string> filesIn(const std::filesystem::path& folder);

std::string contentsOf(const std::filesystem::path& file);

/// One line that begins with "stillframe: ".
bool isOneErrorLine(const std::string& text);

}  // namespace still::test
