// SPDX-License-Identifier: MIT
#include "describe.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

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
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name + (value.empty() ? "" : " " + value);
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

}  // namespace app
