// SPDX-License-Identifier: MIT
#pragma once
// What a Console is made of, for console.cpp (variables and the configuration file) and commands.cpp.

#include <darkroom/console.hpp>
#include <map>
#include <set>

#include "script/variables.hpp"

namespace darkroom {

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
    std::set<std::string> locked, archived;                              ///< `<entry>.<member>`
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
