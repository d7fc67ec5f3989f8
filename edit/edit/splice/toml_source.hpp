// SPDX-License-Identifier: MIT
#pragma once
// Where things stand in a text of TOML, byte by byte: what toml++ says of places are lines and code points of where
// nodes begin, which is not enough to put something else there. For texts that toml++ has read without an error.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/try.hpp"

namespace darkroom::edit {

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Keys from the root; an element of an array, or of an array of tables, is its number.
using TomlPath = std::vector<std::string>;

struct TomlItem {
    enum class Kind : std::uint8_t { Table, ArrayTable, Value };
    Kind kind = Kind::Value;
    TomlPath path;
    std::size_t begin = 0;        ///< of the key, of the header's bracket, or of an element
    std::size_t value_begin = 0;  ///< of a value: a number, a string, an array or an inline table
    std::size_t end = 0;          ///< behind the value or the header
    std::size_t header_size = 0;  ///< how many parts of the path are those of the header above
    bool is_inside = false;       ///< of an array or an inline table
};

/// Is `path` that of `of`, or of something in it?
[[nodiscard]] bool is_within(const TomlPath& path, const TomlPath& of);

/// All headers, keys, elements in the order of the text.
[[nodiscard]] Result<std::vector<TomlItem>> items_of(std::string_view text);

}  // namespace darkroom::edit
