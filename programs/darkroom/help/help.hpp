// SPDX-License-Identifier: MIT
#pragma once
// Help is short: what a command does, three examples, its own flags. Those of the effects, of which there are hundreds,
// are told effect by effect, or all at once.

#include <optional>
#include <span>

#include "programs/darkroom/commands.hpp"

namespace app {

[[nodiscard]] Command add_completion(CommandFlags program);
[[nodiscard]] Command add_man(CommandFlags program);

/// Adds --help and --help-all to the program, and to every command that is added afterwards.
void add_help_flags(CLI::App& program);
/// Answers the first of -h, --help [EFFECT] and --help-all among the arguments, and returns the exit code; nothing
/// where there is none. What else is typed need not be right.
[[nodiscard]] std::optional<int> answer_help(const CLI::App& program, std::span<char* const> arguments);

}  // namespace app
