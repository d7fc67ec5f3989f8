// SPDX-License-Identifier: MIT
#pragma once
// A folder beside this file is a command: FOLDER/FOLDER.cpp defines `CommandRow FOLDER_command()`, and nobody lists it.

#include <darkroom/look.hpp>
#include <darkroom/result.hpp>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "programs/darkroom/flags/flags.hpp"

namespace app {

struct Command {
    CommandFlags flags;
    std::function<int()> run;  ///< once the arguments are parsed; returns the exit code
    /// Of render and develop: what is wrong with flags and look, found before a scene or a frame is read.
    std::function<darkroom::Result<>()> check = {};
};

/// What commands are added to.
struct CommandHost {
    CommandFlags program;
    std::span<const darkroom::LookEntry> named{};  ///< effects of files, whose parameters are flags, too
    /// This process becomes the program of that name, with the same arguments; returns an exit code where it cannot.
    std::function<int(const char* program)> become{};
};

struct CommandRow {
    std::vector<std::string_view> names;
    int place = 0;           ///< in the help, lowest first
    bool is_rare = false;  ///< for packages, hosts and who doubts a driver: the help only names it
    std::vector<Command> (*add)(const CommandHost&) = nullptr;
};
/// Every command of this build, by place.
[[nodiscard]] const std::vector<CommandRow>& all_commands();
/// Adds those that the row has.
[[nodiscard]] std::vector<Command> add_commands(const CommandRow& row, const CommandHost& host);

}  // namespace app
