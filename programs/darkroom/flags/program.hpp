// SPDX-License-Identifier: MIT
#pragma once
// The whole command line: the program that commands add themselves to, and the words for what is wrong with what was
// typed. What a flag's value means is for its command to say.

#include <darkroom/result.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flags.hpp"
#include "programs/darkroom/commands.hpp"

namespace app {

class Program {
  public:
    Program();
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    [[nodiscard]] CommandFlags flags() const { return CommandFlags(*parser_); }
    /// Returns the exit code of what was answered at once: --version.
    [[nodiscard]] darkroom::Result<std::optional<int>> parse(std::span<char* const> arguments) const;

  private:
    std::unique_ptr<CLI::App> parser_;
};

[[nodiscard]] std::string unknown_command(const CLI::App& program, const std::string& name);
/// -q and -v.
void add_voice(CommandFlags command);
/// Whether the command line names it.
[[nodiscard]] bool is_asked(CommandFlags command);
/// An option was given an empty text, which names nothing. Those without a type are values of the look, which say
/// themselves what they allow.
[[nodiscard]] darkroom::Result<> check_values(CommandFlags command);

/// A program whose commands only say whether they would take some arguments.
class Trial {
  public:
    Trial();
    ~Trial();
    Trial(const Trial&) = delete;
    Trial& operator=(const Trial&) = delete;

    [[nodiscard]] CommandFlags program() const { return CommandFlags(*parser_); }
    /// The first of `arguments` names `command`, which was added to the program.
    [[nodiscard]] darkroom::Result<> parse(std::vector<std::string> arguments, CommandFlags command) const;

  private:
    std::unique_ptr<CLI::App> parser_;
};

// All of a main function: arguments to the commands, and errors to exit codes.

/// Adds the command that is called `asked`, or all of them where none is.
using AddCommands = std::function<std::vector<Command>(CommandFlags program, std::span<const darkroom::LookEntry> named,
                                                       std::string_view asked)>;

/// In the environment of what a task of a farm starts: the task's number, with which it ends.
inline constexpr const char* task_of_farm = "DARKROOM_TASK_OF_FARM";

/// Runs what the arguments ask for. Returns the exit code; errors have been told.
[[nodiscard]] int run_program(int argc, char** argv, const AddCommands& add_commands);

}  // namespace app
