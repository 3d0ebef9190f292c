#pragma once
// What a command ends with: a value, or an exit code and one line that says why.

#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "engine/result.h"

namespace still::command {

enum class ExitCode {
    ok = 0,
    differs = 1,    ///< images differ, or a check failed
    usage = 2,      ///< the command line asks for something that does not exist
    file_error = 3  ///< cannot read or write
};

struct Failure {
    ExitCode code;
    std::string message;  ///< one line for a person, no newline at the end
};

template <class T>
using Outcome = tl::expected<T, Failure>;

inline tl::unexpected<Failure> usageError(std::string message) {
    return tl::make_unexpected(Failure{ExitCode::usage, std::move(message)});
}
inline tl::unexpected<Failure> fileError(std::string message) {
    return tl::make_unexpected(Failure{ExitCode::file_error, std::move(message)});
}

/// The library's errors are about files.
template <class T>
Outcome<T> fromResult(Result<T> result) {
    return std::move(result).map_error([](Error error) {
        return Failure{ExitCode::file_error, std::move(error.message)};
    });
}

}  // namespace still::command
