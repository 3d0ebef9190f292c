#include "demos/stillframe/name_pattern.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

namespace still::command {
namespace {

namespace fs = std::filesystem;

std::string padded(int number, int digits) {
    std::string text = std::to_string(number);
    text.insert(0, size_t(std::max(0, digits - int(text.size()))), '0');
    return text;
}

/// Where the frame number goes in a text, and how wide it is at least.
struct Place {
    size_t begin = 0, size = 0;
    int digits = 1;
};

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

/// A place that begins `text`: {frame}, {frame:N}, %d or %0Nd, N one digit.
std::optional<Place> placeAtStart(std::string_view text) {
    if (text.starts_with("{frame}")) {
        return Place{0, 7, 1};
    }
    if (text.starts_with("{frame:") && text.size() >= 9 && isDigit(text[7]) && text[8] == '}') {
        return Place{0, 9, text[7] - '0'};
    }
    if (text.starts_with("%d")) {
        return Place{0, 2, 1};
    }
    if (text.starts_with("%0") && text.size() >= 4 && isDigit(text[2]) && text[3] == 'd') {
        return Place{0, 4, text[2] - '0'};
    }
    return std::nullopt;
}

std::optional<Place> findPlace(std::string_view text) {
    for (size_t begin = 0; begin < text.size(); ++begin) {
        if (auto place = placeAtStart(text.substr(begin))) {
            place->begin = begin;
            return place;
        }
    }
    return std::nullopt;
}

}  // namespace

Outcome<NamePattern> NamePattern::parse(const std::string& text) {
    const fs::path path(text);
    const std::string file_name = path.filename().string();
    if (file_name.empty()) {
        return usageError(text + ": expected a file name");
    }
    if (findPlace(path.parent_path().string())) {
        return usageError(text + ": the frame number can only stand in the file name");
    }
    NamePattern pattern;
    pattern.folder_ = path.parent_path();
    pattern.before_ = file_name;
    if (const auto place = findPlace(file_name)) {
        pattern.numbered_ = true;
        pattern.digits_ = place->digits;
        pattern.before_ = file_name.substr(0, place->begin);
        pattern.after_ = file_name.substr(place->begin + place->size);
        if (findPlace(pattern.after_)) {
            return usageError(text + ": expected one place for the frame number, found two");
        }
    }
    return pattern;
}

NamePattern NamePattern::withModel(const std::string& model) const {
    constexpr std::string_view kPlace = "{model}";
    const auto filled = [&](std::string text) {
        for (size_t at = 0; (at = text.find(kPlace, at)) != std::string::npos; at += model.size()) {
            text.replace(at, kPlace.size(), model);
        }
        return text;
    };
    NamePattern pattern = *this;
    pattern.folder_ = filled(folder_.string());
    pattern.before_ = filled(before_);
    pattern.after_ = filled(after_);
    return pattern;
}

NamePattern NamePattern::withNumber() const {
    if (numbered_) {
        return *this;
    }
    NamePattern pattern = *this;
    const fs::path name(before_);
    pattern.before_ = name.stem().string() + ".";
    pattern.after_ = name.extension().string();
    pattern.digits_ = 4;
    pattern.numbered_ = true;
    return pattern;
}

fs::path NamePattern::at(int frame) const {
    return folder_ / (numbered_ ? before_ + padded(frame, digits_) + after_ : before_);
}

fs::path NamePattern::planeAt(int frame, const std::string& plane) const {
    fs::path path = at(frame);
    return path.replace_extension(plane + ".png");
}

std::vector<int> NamePattern::existing() const {
    std::vector<int> frames;
    std::error_code error;
    fs::directory_iterator entry(folder_.empty() ? fs::path(".") : folder_, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        if (const auto frame = numberOf(entry->path().filename().string())) {
            frames.push_back(*frame);
        }
    }
    std::sort(frames.begin(), frames.end());
    return frames;
}

std::optional<int> NamePattern::numberOf(const std::string& file_name) const {
    const size_t fixed = before_.size() + after_.size();
    if (!numbered_ || file_name.size() <= fixed || !file_name.starts_with(before_) ||
        !file_name.ends_with(after_)) {
        return std::nullopt;
    }
    const std::string digits = file_name.substr(before_.size(), file_name.size() - fixed);
    int frame = 0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, frame);
    if (error != std::errc() || stop != end || frame < 0 || padded(frame, digits_) != digits) {
        return std::nullopt;
    }
    return frame;
}

}  // namespace still::command
