// SPDX-License-Identifier: MIT
#pragma once
// The list `stack` of a look's text as a list of blocks of text.

#include <optional>

#include "edit/splice/toml_editor.hpp"

namespace darkroom::edit {

/// Writes the list anew: each element is that of this number now, with its comments, or a new one. `text_of(number)`:
/// the keys of a new one, as "key = value" pairs.
struct StackElement {
    std::optional<std::size_t> now;
    std::vector<std::string> pairs;  ///< of a new one
};
[[nodiscard]] Result<> arrange_stack(TomlEditor& editor, std::span<const StackElement> elements);
/// How many elements the text has.
[[nodiscard]] std::size_t stack_size(const TomlEditor& editor);
/// New elements as blocks of their own.
[[nodiscard]] std::string blocks_of(std::span<const StackElement> elements, std::string_view line_end);

}  // namespace darkroom::edit
