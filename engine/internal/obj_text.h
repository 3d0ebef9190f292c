#pragma once
// Text files of the OBJ family: line ends, numbers. Numbers are parsed by + × ÷ alone,
// because the C library's pow differs in the last bit from machine to machine.

#include <optional>
#include <string>
#include <string_view>

#include "engine/read_file.h"

namespace still {

/// shownPath() for any text that comes out of a file, cut after 80 bytes.
std::string shownText(std::string_view text);

/// Makes every line end with '\n' (from "\r\n" and "\r"), drops a byte-order mark, and replaces a
/// backslash before a line end (continuation) by blanks.
void normaliseLines(std::string& text);

/// Takes the next word (up to blank or tab) off the front of `line`; empty at the end.
std::string_view takeWord(std::string_view& line);

/// `line` without blanks, tabs and carriage returns at both ends.
std::string_view trimmed(std::string_view line);

/// Whether the line is `keyword`, a blank or tab, and more.
inline bool startsStatement(std::string_view line, std::string_view keyword) {
    return line.size() > keyword.size() && line.starts_with(keyword) &&
           (line[keyword.size()] == ' ' || line[keyword.size()] == '\t');
}

/// Coordinates and colours beyond this, either way, are taken for broken.
constexpr double kMaxObjNumber = 1e18;

/// A decimal number such as -1.5e-3, .5 or 7. ("nan" and "inf" in any case give those values);
/// nothing when `word` is not wholly a number. At most 19 digits count.
std::optional<double> parseNumber(std::string_view word);

}  // namespace still
