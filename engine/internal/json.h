#pragma once
// JSON text as a plain tree, so that only json.cpp pays for the parser's header, and a cursor that
// reads it with checks. The first error is kept and everything after it reads as defaults: callers
// read a whole file straight through and ask once at the end.

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/result.h"

namespace still {

struct JsonValue {
    enum class Type { null, boolean, number, text, array, object };
    Type type = Type::null;
    bool boolean = false;
    double number = 0;
    std::string text{};
    std::vector<JsonValue> items{};
    std::vector<std::pair<std::string, JsonValue>> members{};  ///< in file order, keys unique
};

/// Reads and parses a file. Errors: "FILE: cannot read", "FILE:LINE:COLUMN: …". Refuses files over
/// 256 MiB, nesting deeper than 32, numbers that overflow a double, repeated keys, and
/// objects of more than 1000 keys, and more values than fit in the memory that is allowed.
Result<JsonValue> readJson(const std::filesystem::path& file,
                           uint64_t max_memory_bytes = std::numeric_limits<uint64_t>::max());
/// The same of text that `name` stands for in messages.
Result<JsonValue> parseJson(const std::string& text, const std::filesystem::path& name,
                            uint64_t max_memory_bytes = std::numeric_limits<uint64_t>::max());

/// What went wrong while a tree was read.
struct JsonReport {
    std::string file;                   ///< as messages name it
    std::optional<Error> error;         ///< the first one
    std::vector<std::string> warnings;  ///< unknown keys
};

/// A place in the tree. `JsonReport` and tree must outlive it.
class JsonCursor {
  public:
    JsonCursor(const JsonValue& value, JsonReport& report, std::string path = {})
        : value_(&value), report_(&report), path_(std::move(path)) {}

    bool is(JsonValue::Type type) const { return value_->type == type; }
    /// Path as a JSON pointer (RFC 6901).
    const std::string& path() const { return path_; }

    /// Number in [lowest, highest].
    double number(double lowest, double highest) const;
    int integer(int lowest, int highest) const;
    bool boolean() const;
    std::string text() const;  ///< not empty
    /// `count` numbers, each in [lowest, highest].
    std::vector<double> numbers(size_t count, double lowest, double highest) const;
    glm::dvec3 vector(double lowest, double highest) const;
    /// Elements of an array of at least `least` and at most `most` of them.
    std::vector<JsonCursor> items(size_t least, size_t most) const;

    /// Member of an object; nothing when absent.
    std::optional<JsonCursor> find(std::string_view key) const;
    /// Member of an object; an error when absent.
    JsonCursor require(std::string_view key) const;
    /// Errors when this is not an object; warns of each key that is neither in `known` nor in
    /// `ignored`. `known` is what the warning offers.
    void expectKeys(std::initializer_list<std::string_view> known,
                    std::initializer_list<std::string_view> ignored = {}) const;

    /// Records "FILE: PATH: expected WHAT, found …" unless there is an error already.
    void expected(std::string_view what) const;
    /// Records "FILE: PATH: MESSAGE" unless there is an error already.
    void refuse(std::string_view message) const;

  private:
    const JsonValue* value_;
    JsonReport* report_;
    std::string path_;
};

}  // namespace still
