// SPDX-License-Identifier: MIT
#pragma once
// The edge to toml++: text to a tree, nodes to the values of core/text/param_text.hpp. Public headers name nothing of
// toml++.

#include <toml++/toml.h>
#include <darkroom/result.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/text/param_text.hpp"

namespace darkroom {

/// The largest file of any kind. A tree takes up to 40 times its text.
inline constexpr std::size_t max_toml_bytes = std::size_t{4} << 20;

/// Syntax errors name the place; text that is too long, or that nests so deep that a reader could run out of stack, is
/// refused first.
[[nodiscard]] Result<toml::table> parse_toml(std::string_view text, std::string_view shown_name);
/// Nothing for what no parameter can hold: dates, mixed arrays, other tables than {x, y, z, w} and {r, g, b}.
[[nodiscard]] std::optional<ParamValue> value_of(const toml::node& node);
/// The same as a value for `row`, of whose numbers a text may hold units: "2ev". Errors: a text that does not.
[[nodiscard]] Result<std::optional<ParamValue>> value_for(const ParamInfo& row, const toml::node& node);
/// A short text for messages: "1.5", "\"yes\"", "an array", "a table".
[[nodiscard]] std::string show(const toml::node& node);

}  // namespace darkroom
