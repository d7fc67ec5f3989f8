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

/// One line of text: place, thing, value, what is allowed and, where there is one, the nearest known name.
struct Error {
    Fault fault = Fault::User;
    std::string text;
};

template <class T = void>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> user_error(std::string text) {
    return tl::unexpected(Error{Fault::User, std::move(text)});
}
[[nodiscard]] inline tl::unexpected<Error> machine_error(std::string text) {
    return tl::unexpected(Error{Fault::Machine, std::move(text)});
}
/// Passes the error of one Result on as the error of another.
template <class T>
[[nodiscard]] tl::unexpected<Error> failure(Result<T>&& result) {
    return tl::unexpected(std::move(result).error());
}

}  // namespace darkroom
