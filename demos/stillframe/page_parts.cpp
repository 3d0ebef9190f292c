#include "demos/stillframe/page_parts.h"

#include <cstdint>

namespace still::command {
namespace {

std::string base64(const std::string& bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) {
            word = word << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
        }
        for (size_t k = 0; k < 4; ++k) {
            const bool there = i + k <= bytes.size();
            text += there ? kDigits[word >> (18 - 6 * k) & 63] : '=';
        }
    }
    return text;
}

}  // namespace

std::string pngDataUri(const std::string& png) {
    return "data:image/png;base64," + base64(png);
}

std::string scriptText(const std::string& json) {
    std::string text;
    for (const char c : json) {
        text += c == '<' ? std::string("\\u003c") : std::string(1, c);
    }
    return text;
}

}  // namespace still::command
