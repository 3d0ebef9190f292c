#pragma once
// Text without heap, printf or locale.

#include <array>
#include <cstdint>
#include <string_view>

namespace spin {

/// Up to 96 characters; what is more is cut off.
class Line {
  public:
    Line& operator<<(std::string_view text) {
        for (const char c : text) {
            add(c);
        }
        return *this;
    }
    Line& operator<<(size_t number) {
        char digits[20];
        int count = 0;
        do {
            digits[count++] = char('0' + number % 10);
            number /= 10;
        } while (number > 0);
        while (count > 0) {
            add(digits[--count]);
        }
        return *this;
    }
    /// 16 hexadecimal digits.
    Line& hex(uint64_t number) {
        for (int shift = 60; shift >= 0; shift -= 4) {
            add("0123456789abcdef"[(number >> shift) & 15]);
        }
        return *this;
    }
    std::string_view text() const { return {text_.data(), length_}; }

  private:
    void add(char c) {
        if (length_ < text_.size()) {
            text_[length_++] = c;
        }
    }

    std::array<char, 96> text_{};
    size_t length_ = 0;
};

}  // namespace spin
