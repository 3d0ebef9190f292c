#include "engine/internal/obj_text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace still {

namespace {

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// value · 10^exponent; every factor is a double that holds its power of ten exactly.
double scaleByTen(double value, int exponent) {
    constexpr std::array<double, 23> kPowers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                             1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                             1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    // Beyond ±400 the answer is 0 or infinity whatever the digits are (19 at most).
    exponent = std::clamp(exponent, -400, 400);
    for (; exponent > 0; exponent -= std::min(exponent, 22)) {
        value *= kPowers[size_t(std::min(exponent, 22))];
    }
    for (; exponent < 0; exponent += std::min(-exponent, 22)) {
        value /= kPowers[size_t(std::min(-exponent, 22))];
    }
    return value;
}

/// Digits of a number as an integer of at most 19 digits and a power of ten.
struct Decimal {
    uint64_t digits = 0;
    int used = 0;      ///< significant digits in `digits`
    int exponent = 0;  ///< power of ten
    bool any = false;

    void add(char c, bool after_point) {
        any = true;
        if (used < 19) {
            digits = digits * 10 + uint64_t(c - '0');
            used += digits != 0;
            exponent -= after_point;
        } else {
            exponent += !after_point;
        }
    }
};

bool startsWithNoCase(std::string_view word, std::string_view lower) {
    if (word.size() < lower.size()) {
        return false;
    }
    for (size_t i = 0; i < lower.size(); ++i) {
        const char c = word[i];
        if ((c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c) != lower[i]) {
            return false;
        }
    }
    return true;
}

/// Takes "e+12" off the front of `word` into `exponent`; false when it is malformed.
bool takeExponent(std::string_view& word, int& exponent) {
    word.remove_prefix(1);
    const bool negative = !word.empty() && word[0] == '-';
    if (!word.empty() && (word[0] == '-' || word[0] == '+')) {
        word.remove_prefix(1);
    }
    int value = 0;
    bool any = false;
    while (!word.empty() && isDigit(word[0])) {
        value = std::min(value * 10 + (word[0] - '0'), 100000);
        any = true;
        word.remove_prefix(1);
    }
    exponent = negative ? -value : value;
    return any;
}

}  // namespace

std::string shownText(std::string_view text) {
    const bool cut = text.size() > 80;
    return shownPath(std::string(text.substr(0, 80))) + (cut ? "…" : "");
}

void normaliseLines(std::string& text) {
    if (text.starts_with("\xEF\xBB\xBF")) {
        text.replace(0, 3, "   ");
    }
    text += '\n';
    for (size_t i = text.find('\r'); i != std::string::npos; i = text.find('\r', i + 1)) {
        text[i] = i + 1 < text.size() && text[i + 1] == '\n' ? ' ' : '\n';
    }
    for (size_t i = text.find('\\'); i != std::string::npos; i = text.find('\\', i + 1)) {
        const size_t end = text.find_first_not_of(' ', i + 1);
        if (end != std::string::npos && text[end] == '\n' && end + 1 < text.size()) {
            text[i] = ' ';
            text[end] = ' ';
        }
    }
}

std::string_view takeWord(std::string_view& line) {
    size_t begin = 0;
    while (begin < line.size() && isBlank(line[begin])) {
        ++begin;
    }
    size_t end = begin;
    while (end < line.size() && !isBlank(line[end])) {
        ++end;
    }
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

std::string_view trimmed(std::string_view line) {
    while (!line.empty() && isBlank(line.front())) {
        line.remove_prefix(1);
    }
    while (!line.empty() && isBlank(line.back())) {
        line.remove_suffix(1);
    }
    return line;
}

std::optional<double> parseNumber(std::string_view word) {
    const bool negative = !word.empty() && word[0] == '-';
    if (!word.empty() && (word[0] == '-' || word[0] == '+')) {
        word.remove_prefix(1);
    }
    if (startsWithNoCase(word, "nan")) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (startsWithNoCase(word, "inf")) {
        const double infinity = std::numeric_limits<double>::infinity();
        return negative ? -infinity : infinity;
    }
    Decimal decimal;
    bool after_point = false;
    while (!word.empty() && (isDigit(word[0]) || (word[0] == '.' && !after_point))) {
        if (word[0] == '.') {
            after_point = true;
        } else {
            decimal.add(word[0], after_point);
        }
        word.remove_prefix(1);
    }
    int exponent = 0;
    if (decimal.any && !word.empty() && (word[0] == 'e' || word[0] == 'E') &&
        !takeExponent(word, exponent)) {
        return std::nullopt;
    }
    if (!decimal.any || !word.empty()) {
        return std::nullopt;
    }
    const double value = scaleByTen(double(decimal.digits), decimal.exponent + exponent);
    return negative ? -value : value;
}

}  // namespace still
