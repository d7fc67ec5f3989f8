// SPDX-License-Identifier: MIT
#pragma once
// Console variables: views on the parameters of a stack's entries, and what their values look like as text. Nothing is
// stored here; the Composer has the values.

#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::script {

struct Variable {
    Handle entry;
    const ParamInfo* row = nullptr;
};

/// By `<entry>.<member>`, or by another name that its row has: of the first entry with such a row.
[[nodiscard]] std::optional<Variable> find_variable(const Composer& composer, std::string_view name);
/// `<entry>.<member>`
[[nodiscard]] std::string name_of(const Composer& composer, const Variable& variable);

struct NamedVariable {
    std::string name;
    Variable variable;
};
/// All names that begin with `prefix`, in alphabetical order.
[[nodiscard]] std::vector<NamedVariable> all_variables(const Composer& composer, std::string_view prefix = {});
/// What finding all of them costs, roughly: parameters of the stack.
[[nodiscard]] std::size_t variable_count(const Composer& composer);
/// ", did you mean 'x'?" or nothing.
[[nodiscard]] std::string suggest_variable(const Composer& composer, std::string_view name);

/// As consoles print it: whole numbers as such, others with at most six decimals if these read back as the same value
/// and in full if not, toggles as 0 and 1. `words`: those of the struct.
[[nodiscard]] std::string variable_text(const ParamInfo& row, std::span<const std::uint32_t> words);
/// What that text is as a number; 0 where it is none.
[[nodiscard]] double variable_number(const ParamInfo& row, std::span<const std::uint32_t> words);

struct VariableValue {
    std::vector<std::uint32_t> words;  ///< of the row alone
    std::string remark;                ///< what was out of range and is at its bound now; empty: nothing
};
/// `name`: what texts call the variable. An error: it is not of the row's kind.
[[nodiscard]] Result<VariableValue> read_value(const ParamInfo& row, std::string_view name, std::string_view text);

}  // namespace darkroom::script
