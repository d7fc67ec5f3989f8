// SPDX-License-Identifier: MIT
#include "help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <darkroom/effect.hpp>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/text/param_text.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/program.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> out;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) out.push_back(part);
    return out;
}

// "8|16|half" are words to choose from; "NAME|INDEX" are names of what is meant.
std::vector<std::string> choices_of(const std::string& value) {
    const bool has_capitals = std::ranges::any_of(value, [](unsigned char c) { return std::isupper(c) != 0; });
    if (has_capitals || value.find('|') == std::string::npos) return {};
    return split(value, '|');
}

FlagText flag_of(const CLI::Option& option) {
    FlagText out{.doc = option.get_description(),
                 .group = option.get_group(),
                 .fallback = option.get_default_str(),
                 .is_required = option.get_required(),
                 .is_repeated = option.get_expected_max() > 1 ||
                                option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll,
                 .is_positional = option.get_positional()};
    if (out.is_positional) {
        out.names = {option.get_name(true)};
        out.choices = choices_of(option.get_option_text());
        return out;
    }
    for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
    // Values of the look have no type for the parser.
    out.value = option.get_option_text();
    if (out.value.empty() && option.get_type_size() != 0) out.value = option.get_type_name();
    out.choices = choices_of(out.value);
    return out;
}

void add_all(const CLI::App& command, std::vector<CommandText>& to) {
    const std::vector<const CLI::App*> children = command.get_subcommands([](const CLI::App*) { return true; });
    if (children.empty()) to.push_back(describe(command));
    for (const CLI::App* const child : children) add_all(*child, to);
}

}  // namespace

bool FlagText::takes_file() const {
    if (is_positional) return choices.empty() && names.front() != "NAME";
    return std::ranges::any_of(std::array{"FILE", "OUT", "FRAME", "DIR"},
                               [&](const char* const word) { return value.starts_with(word); });
}

std::string FlagText::shown() const {
    // The sentence of a choice lists them, too.
    constexpr std::size_t longest = 90;
    const std::string taken = value.empty() ? "" : choices.empty() || value.size() <= longest ? " " + value : " NAME";
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name + taken;
    return out;
}

bool CommandText::has_effects() const {
    return std::ranges::any_of(flags, [](const FlagText& flag) { return !effect_of_group(flag.group).empty(); });
}

std::string CommandText::usage() const {
    std::string out = program + (name.empty() ? "" : " " + name);
    if (!children.empty()) return out + " COMMAND";
    for (const FlagText& positional : positionals) {
        const std::string shown = positional.names.front() + (positional.is_repeated ? "..." : "");
        out += positional.is_required ? " " + shown : " [" + shown + "]";
    }
    for (const FlagText& flag : flags)
        if (flag.is_required) out += " " + flag.names.front() + " " + flag.value;
    return out + " [FLAGS]";
}

CommandText describe(const CLI::App& command) {
    CommandText out{.doc = command.get_description(), .examples = split(command.get_footer(), '\n')};
    const CLI::App* app = &command;
    for (; app->get_parent() != nullptr; app = app->get_parent())
        out.name = app->get_name() + (out.name.empty() ? "" : " " + out.name);
    out.program = app->get_name();
    for (const CLI::Option* const option : command.get_options()) {
        FlagText flag = flag_of(*option);
        (flag.is_positional ? out.positionals : out.flags).push_back(std::move(flag));
    }
    out.children = command.get_subcommands([](const CLI::App*) { return true; });
    for (FlagText& flag : out.flags)
        if (flag.names.back() == help_flag && out.has_effects()) flag.value = "[EFFECT]";
    return out;
}

std::vector<CommandText> describe_all(const CLI::App& program) {
    std::vector<CommandText> out;
    add_all(program, out);
    return out;
}

std::string effect_group(std::string_view effect, std::string_view doc) { return fmt::format("{}: {}", effect, doc); }

std::string effect_of_group(const std::string& group) {
    const std::size_t colon = group.find(": ");
    return colon == std::string::npos ? std::string() : group.substr(0, colon);
}

namespace {

constexpr std::size_t column = 34, width = 110;

/// Words of a text in lines of `width`, those after the first indented.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t used) {
    std::string out;
    std::size_t at = used;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = std::min(text.find(' ', start), text.size());
        const std::size_t length = end - start;
        if (at > indent && at + 1 + length > width) {
            out += "\n" + std::string(indent, ' ');
            at = indent;
        } else if (at > indent) {
            out += ' ';
            ++at;
        }
        out += text.substr(start, length);
        at += length;
        start = end + 1;
    }
    return out;
}

void print_row(const std::string& name, const std::string& doc) {
    if (name.size() + 4 <= column)
        fmt::print("  {:<{}}{}\n", name, column - 2, wrapped(doc, column, column));
    else
        fmt::print("  {}\n{:{}}{}\n", name, "", column, wrapped(doc, column, column));
}

void print_flag(const FlagText& flag) {
    const bool tells_default = !flag.fallback.empty() && flag.doc.find("default") == std::string::npos;
    print_row(flag.shown(), flag.doc + (tells_default ? fmt::format(", default {}", flag.fallback) : ""));
}

void print_head(const CommandText& command) {
    fmt::print("{}\n\nUsage: {}\n", command.doc, command.usage());
    if (command.examples.empty()) return;
    fmt::print("\nExamples:\n");
    for (const std::string& example : command.examples) fmt::print("  {}\n", example);
}

/// The effects whose flags a command takes, in the order of their groups.
std::vector<std::string> effects_of(const CommandText& command) {
    std::vector<std::string> names;
    for (const FlagText& flag : command.flags) {
        const std::string name = effect_of_group(flag.group);
        if (!name.empty() && (names.empty() || names.back() != name)) names.push_back(name);
    }
    return names;
}

/// Of groups that `is_shown` says yes to, in the order in which they begin.
template <typename Predicate>
void print_groups(const CommandText& command, Predicate is_shown) {
    std::vector<std::string> groups;
    for (const FlagText& flag : command.flags)
        if (is_shown(flag.group) && std::ranges::find(groups, flag.group) == groups.end()) groups.push_back(flag.group);
    for (const std::string& group : groups) {
        fmt::print("\n{}\n", group == "Options" ? "Flags:" : group.ends_with('.') ? group : group + ':');
        for (const FlagText& flag : command.flags)
            if (flag.group == group) print_flag(flag);
    }
}

void print_children(const CommandText& command) {
    fmt::print("\nCommands:\n");
    std::vector<std::string> aside;
    for (const CLI::App* const child : command.children)
        if (CommandFlags::is_aside(*child))
            aside.push_back(child->get_name());
        else
            print_row(child->get_name(), child->get_description());
    if (!aside.empty())
        fmt::print("\nFor packages, hosts and drivers; `darkroom help COMMAND` tells of each:\n  {}\n",
                   fmt::join(aside, " "));
}

int print_help(const CommandText& command, bool has_all) {
    print_head(command);
    if (!command.positionals.empty()) fmt::print("\n");
    for (const FlagText& positional : command.positionals) print_flag(positional);
    if (!command.children.empty()) print_children(command);
    for (const CLI::App* const child : has_all ? command.children : std::vector<const CLI::App*>()) {
        fmt::print("\n");
        print_help(describe(*child), false);
    }
    print_groups(command, [&](const std::string& group) { return has_all || effect_of_group(group).empty(); });
    const std::vector<std::string> effects = effects_of(command);
    if (!effects.empty() && !has_all)
        fmt::print("\nEffects, of which --help EFFECT tells the flags, and --help-all those of all:\n  {}\n",
                   wrapped(fmt::format("{}", fmt::join(effects, " ")), 2, 2));
    if (command.name.empty())
        fmt::print(
            "\nExit codes: 0 done, 1 the request is wrong, 2 the machine failed; 3, of `compare`: they differ,\n"
            "of `farm status`: pictures are missing.\n"
            "DARKROOM_VALIDATE=1 turns the Vulkan validation layer on.\n");
    return exit_ok;
}

int print_effect(const CommandText& command, const std::string& name) {
    const std::vector<std::string> effects = effects_of(command);
    if (std::ranges::find(effects, name) == effects.end())
        return fail_user(effects.empty()
                             ? fmt::format("--help {}: {} has no flags of effects", darkroom::printable(name),
                                           command.name.empty() ? "the program itself" : command.name)
                             : fmt::format("--help {}: no such effect{}", darkroom::printable(name),
                                           darkroom::suggestion(name, effects)));
    print_groups(command, [&](const std::string& group) { return effect_of_group(group) == name; });
    return exit_ok;
}

/// An argument that may be the effect that --help is asked about, and no file that is to be worked on.
bool may_be_effect(std::string_view argument) {
    return !argument.empty() && argument.front() != '-' && argument.find_first_of("./%#") == std::string_view::npos;
}

const CLI::App* child_of(const CLI::App& command, std::string_view name) {
    const auto named = command.get_subcommands([&](const CLI::App* child) { return child->get_name() == name; });
    return named.empty() ? nullptr : named.front();
}

/// What `help` tells: of the program, of a command, of an effect of a command.
int print_named(const CLI::App& program, std::span<const std::string> words) {
    const CLI::App* command = &program;
    for (const std::string& word : words) {
        const CLI::App* const child = child_of(*command, word);
        if (child == nullptr && command != &program) return print_effect(describe(*command), word);
        if (child == nullptr && darkroom::find_effect(word) != nullptr)
            return fail_user(
                fmt::format("help {}: it is an effect: darkroom effects {} tells of it, darkroom help "
                            "develop {} of its flags",
                            word, word, word));
        if (child == nullptr) return fail_user(unknown_command(program, word));
        command = child;
    }
    return print_help(describe(*command), false);
}

}  // namespace

void add_help_flags(CLI::App& program) {
    program.set_help_flag(fmt::format("-h,{}", help_flag), "Prints this help; with EFFECT, the flags of that effect");
    program.set_help_all_flag("--help-all", "Prints this help with the flags of all effects, and other commands");
}

static Command add_help(CommandFlags program) {
    const CommandFlags command = program.add_command("help", "Tells of a command, or of an effect's flags");
    command.examples(
        "darkroom help\n"
        "darkroom help lut export\n"
        "darkroom help develop bloom");
    const auto words = std::make_shared<std::vector<std::string>>();
    command.add_option("COMMAND", *words, "A command, and an effect whose flags it has; without it all commands");
    return {command, [=] { return print_named(program.parser(), *words); }};
}

std::optional<int> answer_help(const CLI::App& program, std::span<char* const> arguments) {
    if (arguments.size() < 2) return print_help(describe(program), false);
    const CLI::App* command = &program;
    bool is_command = true;
    for (std::size_t i = 1; i < arguments.size(); ++i) {
        const std::string_view argument = arguments[i];
        const CLI::App* const child = is_command ? child_of(*command, argument) : nullptr;
        is_command = child != nullptr;
        if (is_command) command = child;
        if (argument == "--help-all") return print_help(describe(*command), true);
        if (argument.starts_with("--help="))
            return print_effect(describe(*command), std::string(argument.substr(argument.find('=') + 1)));
        if (argument != help_flag && argument != "-h") continue;
        if (i + 1 < arguments.size() && may_be_effect(arguments[i + 1])) {
            const CLI::App* const named = child_of(*command, arguments[i + 1]);
            return named != nullptr ? print_help(describe(*named), false)
                                    : print_effect(describe(*command), arguments[i + 1]);
        }
        return print_help(describe(*command), false);
    }
    return std::nullopt;
}

CommandRow help_command() {
    return {.names = {"help", "completion", "man"}, .place = 130, .add = [](const CommandHost& host) {
                std::vector out{add_help(host.program), add_completion(host.program), add_man(host.program)};
                for (std::size_t i = 1; i < out.size(); ++i) out[i].flags.put_aside();
                return out;
            }};
}

}  // namespace app
