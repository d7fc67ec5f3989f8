// SPDX-License-Identifier: MIT
#pragma once
// The library's errors as darkroom.Error, which Python code catches. The interpreter's lock is held where one is
// raised.

#include <darkroom/result.hpp>
#include <string>
#include <type_traits>
#include <utility>

namespace darkroom::python {

/// Throws what pybind11 turns into darkroom.Error: its text, its fault ("user", "machine") and its code.
[[noreturn]] void raise(const Error& error);
[[noreturn]] void raise_user(std::string text);

template <class T>
requires(!std::is_void_v<T>) T must(Result<T>&& result) {
    if (!result) raise(result.error());
    return std::move(*result);
}
inline void must(const Result<>& result) {
    if (!result) raise(result.error());
}

}  // namespace darkroom::python
