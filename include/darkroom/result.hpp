// SPDX-License-Identifier: MIT
#pragma once
// How Darkroom reports what went wrong. Everything that can fail returns a Result; the library throws nothing of its
// own. This is the one header that names tl::expected, which stands in for std::expected until the compilers we build
// with have it.

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace darkroom {

/// Who has to act. `User`: a file, a flag, a value or a chain is wrong. `Machine`: a Vulkan call or an I/O call failed.
enum class Fault { User, Machine };

/// What a host may act on: it makes its device anew, frees memory, goes on without. All else is Other.
enum class ErrorCode { Other, DeviceLost, OutOfMemory, Unsupported };

/// One line of text: place, thing, value, what is allowed and, where there is one, the nearest known name.
struct Error {
    Fault fault = Fault::User;
    std::string text;
    ErrorCode code = ErrorCode::Other;
};

template <class T = void>
using Result = tl::expected<T, Error>;

/// Becomes the error of any Result.
using Failure = tl::unexpected<Error>;

[[nodiscard]] inline Failure failure(Error error) { return Failure(std::move(error)); }
[[nodiscard]] inline Failure user_error(std::string text) { return failure({Fault::User, std::move(text)}); }
[[nodiscard]] inline Failure machine_error(std::string text, ErrorCode code = ErrorCode::Other) {
    return failure({Fault::Machine, std::move(text), code});
}
/// Passes the error of one Result on as the error of another.
template <class T>
[[nodiscard]] Failure failure(Result<T>&& result) {
    return failure(std::move(result).error());
}

}  // namespace darkroom
