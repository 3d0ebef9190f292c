#pragma once
// Value-or-error for everything that can fail for outside reasons.

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace still {

/// One line for a person: "FILE:LINE: what is wrong, what was expected". No newline at the end.
struct Error {
    std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(std::string message) {
    return tl::make_unexpected(Error{std::move(message)});
}

}  // namespace still
