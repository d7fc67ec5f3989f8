// SPDX-License-Identifier: MIT
#pragma once
// What a Console is made of, for console.cpp (variables and the configuration file) and commands.cpp.

#include <cstddef>
#include <darkroom/composer.hpp>
#include <darkroom/console.hpp>
#include <darkroom/effect.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

namespace script {

// The grammar of consoles, as Quake has it: commands end at a line's end or at `;`, words at blanks, "..." is one word
// without escapes, which ends at the line's end at the latest, and `//` where a word may begin is a comment up to the
// line's end.

struct Command {
    std::size_t line = 1;
    std::vector<std::string_view> words;  ///< at least one; of the text that was read
};

class CommandReader {
  public:
    explicit CommandReader(std::string_view text) : rest_(text) {}
    [[nodiscard]] std::optional<Command> next();

  private:
    /// The next word of this command; nothing at its end, which is passed.
    [[nodiscard]] std::optional<std::string_view> word();

    std::string_view rest_;
    std::size_t line_ = 1;
};

// Console variables: views on the parameters of a stack's entries, and what their values look like as text. Nothing is
// stored here; the Composer has the values.

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

}  // namespace script

struct Console::State {
    [[nodiscard]] Result<script::Variable> variable(std::string_view name, bool suggests = true) const;
    /// With an owner: a frame's override of that owner; else the base value.
    Result<std::string> write(std::string_view name, const script::Variable& variable, std::string_view value,
                              std::optional<std::string_view> owner = std::nullopt);
    [[nodiscard]] std::string text(const script::Variable& variable) const;
    /// What `reset` goes back to: words of the struct.
    [[nodiscard]] std::span<const std::uint32_t> defaults(const script::Variable& variable) const;
    [[nodiscard]] bool is_read_only(const script::Variable& variable) const;
    [[nodiscard]] bool is_archived(const script::Variable& variable) const;

    Composer* composer = nullptr;
    ConsoleDesc desc;
    std::map<std::uint32_t, std::vector<std::uint32_t>> entry_defaults;  ///< by handle
    std::set<std::string> locked, archived, set_by_hand;                 ///< `<entry>.<member>`
    std::map<std::string, std::string> kept;  ///< of a configuration file: lines for variables that are not there
};

namespace script {

/// See ExecuteOptions. `kept`: where values of unknown variables go that would be refused otherwise.
struct RunOptions {
    ExecuteOptions execute{};
    std::string place{};  ///< of the text, for messages; empty: it was typed
    std::map<std::string, std::string>* kept = nullptr;
};
/// In the order of their list.
[[nodiscard]] std::vector<std::string> command_names(std::string_view prefix);
/// Returns how many commands were refused.
std::uint32_t run_commands(Console::State& state, std::string_view text, const RunOptions& options);

}  // namespace script

}  // namespace darkroom
