// SPDX-License-Identifier: MIT
#pragma once
// Changes single things in a text of TOML and leaves every other byte as it is: indentation, ends of lines, comments,
// the order and the way in which tables are written. It knows TOML, and no looks.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/try.hpp"

namespace darkroom::edit {

// Where things stand in a text of TOML, byte by byte: what toml++ says of places are lines and code points of where
// nodes begin, which is not enough to put something else there. For texts that toml++ has read without an error.

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

class TomlEditor {
  public:
    [[nodiscard]] static Result<TomlEditor> of(std::string text);

    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] const std::vector<TomlItem>& items() const { return items_; }
    /// The value with this path; null: it is not there, or made of several, as dotted keys make a table.
    [[nodiscard]] const TomlItem* find(const TomlPath& path) const;
    [[nodiscard]] bool contains(const TomlPath& path) const;

    /// Sets a key of a table to a value: numbers of arrays one by one, where there are as many. A key that is not there
    /// comes behind the last of those named in `neighbours`, else behind the table's last. A table that is not there
    /// comes at the end of the text.
    Result<> set(const TomlPath& table, std::string_view key, std::string_view value,
                 std::span<const std::string> neighbours = {});
    /// Takes a key out, with its line where it has one.
    Result<> remove(const TomlPath& table, std::string_view key);
    /// Takes a table out, wherever parts of it stand; comments stay. Returns where its first header stood, or the
    /// text's end.
    Result<std::size_t> remove_table(const TomlPath& table);
    /// Puts a header of a table at the end of the text.
    Result<> add_table(std::string_view name);
    Result<> replace(std::size_t begin, std::size_t end, std::string_view with);

    /// How lines end, judged by the first.
    [[nodiscard]] std::string_view line_end() const;
    /// Of the line that holds this place; its end is behind its line break.
    [[nodiscard]] std::size_t line_begin(std::size_t at) const;
    [[nodiscard]] std::size_t line_end_at(std::size_t at) const;

  private:
    Result<> rescan();
    Result<> replace_value(const TomlPath& path, std::string_view value);
    Result<> add(const TomlPath& table, std::string_view pair, std::span<const std::string> neighbours);
    Result<> add_inside(const TomlItem& table, std::string_view pair);
    Result<> add_first(std::string_view pair);
    Result<> add_line(const TomlItem& behind, std::string_view pair);

    std::string text_;
    std::vector<TomlItem> items_;
};

/// As a key: bare where it can be.
[[nodiscard]] std::string toml_key(std::string_view name);

}  // namespace darkroom::edit
