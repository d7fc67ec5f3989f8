// SPDX-License-Identifier: MIT
#pragma once
// What the files of the module add to it, and what they share.

#include <pybind11/pybind11.h>

#include <cstdint>
#include <darkroom/look.hpp>
#include <darkroom/param.hpp>
#include <darkroom/result.hpp>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace darkroom::python {

void add_effects(pybind11::module_& module);
void add_looks(pybind11::module_& module);
void add_runner(pybind11::module_& module);
void add_tables(pybind11::module_& module);
void add_compare(pybind11::module_& module);

/// A value of a row as Python has it; `words` are those of the struct. A resource is None.
[[nodiscard]] pybind11::object value_of(const ParamInfo& row, std::span<const std::uint32_t> words);

/// A look that is edited: an edit that fails changes nothing.
struct EditedLook {
    Look look;
    std::vector<LookOverride> typed{};  ///< values that were set by hand
    std::uint64_t edition = 0;          ///< no two contents have the same
};

/// A colour table, or a picture, as stacks read them.
struct PyTable {
    std::shared_ptr<const ResourceData> data;
    std::string title;
};

// The library's errors as darkroom.Error, which Python code catches. The interpreter's lock is held where one is
// raised.

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
