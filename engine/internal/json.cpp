#include "engine/internal/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/internal/obj_text.h"
#include "engine/memory_need.h"

namespace still {
namespace {

constexpr size_t kMaxDepth = 32;
constexpr size_t kMaxKeys = 1000;  // per object; each new key is compared with all before it
constexpr size_t kMaxBytes = size_t(256) << 20;

std::string placeOf(std::string_view text, size_t offset) {
    size_t line = 1, column = 1;
    for (const char c : text.substr(0, std::min(offset, text.size()))) {
        line += c == '\n' ? 1 : 0;
        column = c == '\n' ? 1 : column + 1;
    }
    return std::to_string(line) + ":" + std::to_string(column);
}

/// The library's message without its own name, its place, and the raw bytes it read last:
/// "[json.exception.parse_error.101] parse error at line 1, column 2: WHAT; last read: …" → WHAT.
std::string detailOf(std::string_view message) {
    message.remove_prefix(std::min(message.find("] ") + 2, message.size()));
    if (message.starts_with("parse error")) {
        message.remove_prefix(std::min(message.find(": ") + 2, message.size()));
    }
    message = message.substr(0, message.find("; last read"));
    return std::string(message);
}

/// Receives the parser's events and builds the tree; false stops the parser.
class TreeBuilder {
  public:
    TreeBuilder(std::string_view text, uint64_t max_memory_bytes)
        : text_(text), max_memory_bytes_(max_memory_bytes) {}

    bool null() { return add({}); }
    bool boolean(bool value) { return add({.type = JsonValue::Type::boolean, .boolean = value}); }
    bool number_integer(int64_t value) { return number(double(value)); }
    bool number_unsigned(uint64_t value) { return number(double(value)); }
    bool number_float(double value, const std::string&) { return number(value); }
    bool string(std::string& value) {
        return add({.type = JsonValue::Type::text, .text = std::move(value)});
    }
    bool binary(std::vector<uint8_t>&) { return false; }
    bool start_object(size_t) { return open({.type = JsonValue::Type::object}); }
    bool start_array(size_t) { return open({.type = JsonValue::Type::array}); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }
    bool key(std::string& name) {
        if (open_.back().members.size() == kMaxKeys) {
            error_ = "an object has too many keys, expected at most " + std::to_string(kMaxKeys);
            return false;
        }
        for (const auto& member : open_.back().members) {
            if (member.first == name) {
                error_ =
                    "\"" + shownText(name) + "\" stands twice in one object, expected unique keys";
                return false;
            }
        }
        open_.back().members.emplace_back(std::move(name), JsonValue{});
        return true;
    }
    bool parse_error(size_t position, const std::string&, const nlohmann::json::exception& what) {
        // The library counts the offending character too, hence − 1.
        error_ = placeOf(text_, position > 0 ? position - 1 : 0) + ": " + detailOf(what.what());
        has_place_ = true;
        return false;
    }

    JsonValue takeRoot() { return std::move(root_); }
    std::string error() const { return (has_place_ ? ":" : ": ") + error_; }

  private:
    bool number(double value) { return add({.type = JsonValue::Type::number, .number = value}); }
    bool add(JsonValue value) {
        constexpr uint64_t kTimes = 4;  // arrays that grow stand beside their copies, and cursors
        if (++values_ > max_memory_bytes_ / (kTimes * sizeof(JsonValue))) {
            error_ = "its values need more than the " + bytesText(max_memory_bytes_) +
                     " of memory that are allowed (--max-memory)";
            return false;
        }
        if (open_.empty()) {
            root_ = std::move(value);
        } else if (open_.back().type == JsonValue::Type::array) {
            open_.back().items.push_back(std::move(value));
        } else {
            open_.back().members.back().second = std::move(value);
        }
        return true;
    }
    bool open(JsonValue container) {
        if (open_.size() == kMaxDepth) {
            error_ = "nested too deeply, expected at most " + std::to_string(kMaxDepth) + " levels";
            return false;
        }
        open_.push_back(std::move(container));
        return true;
    }
    bool close() {
        JsonValue done = std::move(open_.back());
        open_.pop_back();
        return add(std::move(done));
    }

    std::string_view text_;
    uint64_t max_memory_bytes_, values_ = 0;
    JsonValue root_;
    std::vector<JsonValue> open_;
    std::string error_;
    bool has_place_ = false;
};

std::string shortNumber(double value) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream << value;
    return stream.str();
}

std::string describe(const JsonValue& value) {
    switch (value.type) {
        case JsonValue::Type::null:
            return "null";
        case JsonValue::Type::boolean:
            return value.boolean ? "true" : "false";
        case JsonValue::Type::number:
            return shortNumber(value.number);
        case JsonValue::Type::text:
            return "\"" + shownText(value.text) + "\"";
        case JsonValue::Type::array:
            return "an array of " + std::to_string(value.items.size());
        case JsonValue::Type::object:
            return "an object";
    }
    return "nothing";
}

/// A key as a token of a JSON pointer, on one line.
std::string escaped(std::string_view key) {
    std::string token;
    for (const char c : shownText(key)) {
        token += c == '~' ? "~0" : (c == '/' ? "~1" : std::string(1, c));
    }
    return token;
}

bool contains(std::initializer_list<std::string_view> list, std::string_view key) {
    return std::find(list.begin(), list.end(), key) != list.end();
}

const JsonValue kNothing{};

}  // namespace

Result<JsonValue> parseJson(const std::string& text, const std::filesystem::path& name,
                            uint64_t max_memory_bytes) {
    // The parser's own exceptions go to parse_error(); this catches what is left (memory).
    try {
        if (text.size() > kMaxBytes) {
            return fail(shownPath(name) + ": too large, expected at most 256 MiB");
        }
        TreeBuilder builder(text, max_memory_bytes);
        if (!nlohmann::json::sax_parse(text, &builder)) {
            return fail(shownPath(name) + builder.error());
        }
        return builder.takeRoot();
    } catch (const std::exception& error) {
        return fail(shownPath(name) + ": cannot be read: " + error.what());
    }
}

Result<JsonValue> readJson(const std::filesystem::path& file, uint64_t max_memory_bytes) {
    return readFile(file).and_then(
        [&](const std::string& text) { return parseJson(text, file, max_memory_bytes); });
}

void JsonCursor::refuse(std::string_view message) const {
    if (!report_->error) {
        report_->error = Error{report_->file + ": " + (path_.empty() ? "/" : path_) + ": " +
                               std::string(message)};
    }
}

void JsonCursor::expected(std::string_view what) const {
    refuse("expected " + std::string(what) + ", found " + describe(*value_));
}

double JsonCursor::number(double lowest, double highest) const {
    const double value = value_->number;
    if (!is(JsonValue::Type::number) || !(value >= lowest && value <= highest)) {
        expected("a number from " + shortNumber(lowest) + " to " + shortNumber(highest));
        return lowest;
    }
    return value;
}

int JsonCursor::integer(int lowest, int highest) const {
    const double value = value_->number;
    if (!is(JsonValue::Type::number) || !(value >= lowest && value <= highest) ||
        value != double(int(value))) {
        expected("a whole number from " + std::to_string(lowest) + " to " +
                 std::to_string(highest));
        return lowest;
    }
    return int(value);
}

bool JsonCursor::boolean() const {
    if (!is(JsonValue::Type::boolean)) {
        expected("true or false");
    }
    return value_->boolean;
}

std::string JsonCursor::text() const {
    if (!is(JsonValue::Type::text) || value_->text.empty()) {
        expected("a text");
    }
    return value_->text;
}

std::vector<JsonCursor> JsonCursor::items(size_t least, size_t most) const {
    std::vector<JsonCursor> cursors;
    const size_t count = value_->items.size();
    if (!is(JsonValue::Type::array) || count < least || count > most) {
        expected(least == most ? "an array of " + std::to_string(least)
                               : "an array of at least " + std::to_string(least));
        return cursors;
    }
    for (size_t i = 0; i < count; ++i) {
        cursors.emplace_back(value_->items[i], *report_, path_ + "/" + std::to_string(i));
    }
    return cursors;
}

std::vector<double> JsonCursor::numbers(size_t count, double lowest, double highest) const {
    std::vector<double> values;
    for (const JsonCursor& item : items(count, count)) {
        values.push_back(item.number(lowest, highest));
    }
    values.resize(count);
    return values;
}

glm::dvec3 JsonCursor::vector(double lowest, double highest) const {
    const std::vector<double> values = numbers(3, lowest, highest);
    return {values[0], values[1], values[2]};
}

std::optional<JsonCursor> JsonCursor::find(std::string_view key) const {
    for (const auto& [name, value] : value_->members) {
        if (name == key) {
            return JsonCursor(value, *report_, path_ + "/" + escaped(key));
        }
    }
    return std::nullopt;
}

JsonCursor JsonCursor::require(std::string_view key) const {
    if (const auto member = find(key)) {
        return *member;
    }
    if (is(JsonValue::Type::object)) {
        refuse("expected the key \"" + std::string(key) + "\"");
    } else {
        expected("an object with the key \"" + std::string(key) + "\"");
    }
    return {kNothing, *report_, path_ + "/" + escaped(key)};
}

void JsonCursor::expectKeys(std::initializer_list<std::string_view> known,
                            std::initializer_list<std::string_view> ignored) const {
    if (!is(JsonValue::Type::object)) {
        expected("an object");
        return;
    }
    std::string offer;
    for (const std::string_view key : known) {
        offer += (offer.empty() ? "" : ", ") + std::string(key);
    }
    for (const auto& [name, value] : value_->members) {
        if (!contains(known, name) && !contains(ignored, name)) {
            report_->warnings.push_back(report_->file + ": " + path_ + "/" + escaped(name) +
                                        ": unknown key, ignored (known: " + offer + ")");
        }
    }
}

}  // namespace still
