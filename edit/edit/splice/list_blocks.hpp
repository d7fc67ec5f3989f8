// SPDX-License-Identifier: MIT
#pragma once
// A list of a look's text, such as `stack` or `pulse`, as a list of blocks of text.

#include <optional>

#include "edit/splice/toml_editor.hpp"

namespace darkroom::edit {

/// An element is that of this number now, with its comments, or a new one.
struct ListElement {
    std::optional<std::size_t> now;
    std::vector<std::string> pairs;  ///< of a new one: "key = value"
};
/// Writes the list of this key anew; one that is not there yet comes at the text's end.
[[nodiscard]] Result<> arrange_list(TomlEditor& editor, std::string_view key, std::span<const ListElement> elements);
/// How many elements the text has.
[[nodiscard]] std::size_t list_size(const TomlEditor& editor, std::string_view key);
/// New elements as blocks of their own.
[[nodiscard]] std::string blocks_of(std::string_view key, std::span<const ListElement> elements,
                                    std::string_view line_end);

}  // namespace darkroom::edit
