// SPDX-License-Identifier: MIT
#pragma once
// All of a main function: arguments to the commands, and errors to exit codes.

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "programs/darkroom/commands.hpp"

namespace app {

/// Adds the command that is called `asked`, or all of them where none is.
using AddCommands = std::function<std::vector<Command>(CommandFlags program, std::span<const darkroom::LookEntry> named,
                                                       std::string_view asked)>;

/// In the environment of what a task of a farm starts: the task's number, with which it ends.
inline constexpr const char* task_of_farm = "DARKROOM_TASK_OF_FARM";

/// Runs what the arguments ask for. Returns the exit code; errors have been told.
[[nodiscard]] int run_program(int argc, char** argv, const AddCommands& add_commands);

}  // namespace app
