// SPDX-License-Identifier: MIT
#pragma once
// What the commands take, as data: read from the parser itself, so that help, completions and manual pages offer
// exactly what is parsed.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/flags.hpp"

namespace app {

/// A flag, or an argument that has a place instead of a name.
struct FlagText {
    std::vector<std::string> names;    ///< as they are typed, short ones first: "-o", "--output"
    std::string value;                 ///< what it takes, "OUT"; empty: nothing
    std::vector<std::string> choices;  ///< where the value is one of a few
    std::string doc, group, fallback;  ///< fallback: what stands for it where it is left out; may be empty
    bool is_required = false, is_repeated = false, is_positional = false;

    [[nodiscard]] bool takes_file() const;
    /// "-o OUT, --output OUT".
    [[nodiscard]] std::string shown() const;
};

struct CommandText {
    std::string program, name;  ///< name: "develop", "lut export"; empty of the program itself
    std::string doc;
    std::vector<FlagText> positionals, flags;
    std::vector<std::string> examples;        ///< whole command lines
    std::vector<const CLI::App*> children{};  ///< a command that only holds others has no flags of its own

    [[nodiscard]] bool has_effects() const;
    /// "darkroom develop INPUT... -o OUT [FLAGS]".
    [[nodiscard]] std::string usage() const;
};

inline constexpr const char* help_flag = "--help";

[[nodiscard]] CommandText describe(const CLI::App& command);
/// All that can be run, those below other commands in their place.
[[nodiscard]] std::vector<CommandText> describe_all(const CLI::App& program);

/// What the flags of one effect are grouped under: "bloom: What is bright glows."
[[nodiscard]] std::string effect_group(std::string_view effect, std::string_view doc);
/// The effect of such a group; empty for other groups.
[[nodiscard]] std::string effect_of_group(const std::string& group);

// Help is short: what a command does, three examples, its own flags. Those of the effects, of which there are hundreds,
// are told effect by effect, or all at once.

[[nodiscard]] Command add_completion(CommandFlags program);
[[nodiscard]] Command add_man(CommandFlags program);

/// Adds --help and --help-all to the program, and to every command that is added afterwards.
void add_help_flags(CLI::App& program);
/// Answers the first of -h, --help [EFFECT] and --help-all among the arguments, and returns the exit code; nothing
/// where there is none. What else is typed need not be right.
[[nodiscard]] std::optional<int> answer_help(const CLI::App& program, std::span<char* const> arguments);

}  // namespace app
