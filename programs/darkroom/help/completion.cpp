// SPDX-License-Identifier: MIT
// darkroom completion: what shells offer while a command is typed, made from what the parser takes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <span>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "help.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

using Names = std::vector<std::string>;

std::string join(const Names& words, const char* between = " ") { return fmt::format("{}", fmt::join(words, between)); }

std::string first_sentence(const std::string& doc) {
    const std::size_t end = std::min({doc.find(". "), doc.find("; "), doc.find(": ")});
    return doc.substr(0, end);
}

std::string replaced(std::string text, std::string_view characters, std::string_view before) {
    for (std::size_t i = 0; i < text.size(); ++i)
        if (characters.find(text[i]) != std::string_view::npos) {
            text.insert(i, before);
            i += before.size();
        }
    return text;
}

std::string single_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

/// The program as the shells' scripts need it.
struct Completion {
    std::vector<CommandText> commands;  ///< that can be run
    Names first;                        ///< words behind the program's name
    std::map<std::string, Names> children;
    Names effects;

    explicit Completion(const CLI::App& program) : commands(describe_all(program)) {
        for (CommandText& command : commands) {
            for (FlagText& flag : command.flags)
                if (const std::string effect = effect_of_group(flag.group); !effect.empty())
                    if (std::ranges::find(effects, effect) == effects.end()) effects.push_back(effect);
            const std::size_t space = command.name.find(' ');
            const std::string word = command.name.substr(0, space);
            if (first.empty() || first.back() != word) first.push_back(word);
            if (space != std::string::npos) children[word].push_back(command.name.substr(space + 1));
        }
        for (CommandText& command : commands)
            for (FlagText& flag : command.flags)
                if (flag.value == "[EFFECT]") flag.choices = effects;
    }
};

/// Flags of one shape, and who has them.
struct Shared {
    const FlagText* flag = nullptr;
    std::string name;
    Names commands;
};

/// Every flag once for each meaning that it has.
std::vector<Shared> shared_flags(const Completion& all) {
    std::vector<Shared> out;
    std::map<std::string, std::size_t> places;
    for (const CommandText& command : all.commands)
        for (const FlagText& flag : command.flags)
            for (const std::string& name : flag.names) {
                const std::string key = fmt::format("{}\n{}\n{}\n{}", name, flag.value, flag.doc, flag.choices.size());
                const auto [place, is_new] = places.try_emplace(key, out.size());
                if (is_new) out.push_back({&flag, name, {}});
                out[place->second].commands.push_back(command.name);
            }
    return out;
}

std::string bash_answer(const FlagText& flag) {
    if (!flag.choices.empty()) return fmt::format("compgen -W {} -- \"$current\"", single_quoted(join(flag.choices)));
    return flag.takes_file() ? "compgen -f -- \"$current\"" : ":";
}

std::string bash_script(const Completion& all) {
    std::string out;
    const auto to = std::back_inserter(out);
    fmt::format_to(
        to,
        "# bash completion of darkroom\n"
        "_darkroom() {{\n"
        "    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} command= words i\n"
        "    if [[ $current == = ]]; then\n"
        "        current=\n"
        "    elif [[ $previous == = ]]; then\n"
        "        previous=${{COMP_WORDS[COMP_CWORD - 2]}}\n"
        "    fi\n"
        "    for ((i = 1; i < COMP_CWORD; ++i)); do\n"
        "        case \"$command ${{COMP_WORDS[i]}}\" in\n");
    Names known;
    for (const std::string& word : all.first) known.push_back(fmt::format("\" {}\"", word));
    for (const auto& [parent, children] : all.children)
        for (const std::string& child : children) known.push_back(fmt::format("\"{} {}\"", parent, child));
    fmt::format_to(to,
                   "            {}) command=${{command:+$command }}${{COMP_WORDS[i]}} ;;\n"
                   "            *) break ;;\n"
                   "        esac\n"
                   "    done\n"
                   "    case \"$command $previous\" in\n",
                   join(known, " | "));
    std::map<std::string, Names> cases;  // by what is answered
    for (const Shared& shared : shared_flags(all)) {
        if (shared.flag->value.empty()) continue;
        for (const std::string& command : shared.commands)
            cases[bash_answer(*shared.flag)].push_back(fmt::format("\"{} {}\"", command, shared.name));
    }
    for (const auto& [answer, patterns] : cases)
        fmt::format_to(to, "        {}) mapfile -t COMPREPLY < <({}); return ;;\n", join(patterns, " | "), answer);
    fmt::format_to(to,
                   "    esac\n"
                   "    case $command in\n"
                   "        '') words='{} --help --help-all --version' ;;\n",
                   join(all.first));
    for (const auto& [parent, children] : all.children)
        fmt::format_to(to, "        {}) words='{} --help' ;;\n", parent, join(children));
    for (const CommandText& command : all.commands) {
        Names names;
        for (const FlagText& flag : command.flags) names.insert(names.end(), flag.names.begin(), flag.names.end());
        fmt::format_to(to, "        {}) words='{}' ;;\n", single_quoted(command.name), join(names));
    }
    fmt::format_to(to,
                   "    esac\n"
                   "    case $command in\n");
    for (const CommandText& command : all.commands)
        if (!command.positionals.empty() && !command.positionals.front().choices.empty())
            fmt::format_to(to, "        {}) [[ $current == -* ]] || words='{}' ;;\n", single_quoted(command.name),
                           join(command.positionals.front().choices));
    Names without_files{"''"};
    for (const auto& [parent, children] : all.children) without_files.push_back(parent);
    for (const CommandText& command : all.commands)
        if (std::ranges::none_of(command.positionals, &FlagText::takes_file))
            without_files.push_back(single_quoted(command.name));
    fmt::format_to(
        to,
        "        {}) ;;\n"
        "        *) [[ $current == -* ]] || {{ mapfile -t COMPREPLY < <(compgen -f -- \"$current\"); return; }} ;;\n"
        "    esac\n"
        "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
        "}}\n"
        "complete -o filenames -F _darkroom darkroom\n",
        join(without_files, " | "));
    return out;
}

/// As _arguments of zsh takes it.
std::string zsh_spec(const FlagText& flag, const std::string& name) {
    std::string out = (flag.is_repeated ? "*" : "") + name;
    out += '[' + replaced(first_sentence(flag.doc), "[]\\", "\\") + ']';
    if (!flag.value.empty()) {
        out += flag.value == "[EFFECT]" ? "::" : ":";
        out += replaced(flag.choices.empty() ? flag.value : "value", ":[]\\", "\\") + ":";
        if (!flag.choices.empty())
            out += "(" + join(flag.choices) + ")";
        else
            out += flag.takes_file() ? "_files" : " ";
    }
    return single_quoted(out);
}

std::string zsh_script(const Completion& all) {
    std::string out;
    const auto to = std::back_inserter(out);
    fmt::format_to(to,
                   "#compdef darkroom\n"
                   "_darkroom() {{\n"
                   "    local -a commands\n"
                   "    commands=(\n");
    for (const CommandText& command : all.commands)
        if (command.name.find(' ') == std::string::npos)
            fmt::format_to(to, "        {}\n", single_quoted(command.name + ":" + first_sentence(command.doc)));
    for (const auto& [parent, children] : all.children) fmt::format_to(to, "        {}\n", parent);
    fmt::format_to(to,
                   "    )\n"
                   "    if ((CURRENT == 2)); then\n"
                   "        _describe command commands\n"
                   "        compadd -- --help --help-all --version\n"
                   "        return\n"
                   "    fi\n"
                   "    local command=$words[2]\n"
                   "    shift words\n"
                   "    ((CURRENT--))\n");
    for (const auto& [parent, children] : all.children)
        fmt::format_to(to,
                       "    if [[ $command == {} ]]; then\n"
                       "        if ((CURRENT == 2)); then\n"
                       "            compadd -- {} --help\n"
                       "            return\n"
                       "        fi\n"
                       "        command+=\" $words[2]\"\n"
                       "        shift words\n"
                       "        ((CURRENT--))\n"
                       "    fi\n",
                       parent, join(children));
    fmt::format_to(to, "    case $command in\n");
    for (const CommandText& command : all.commands) {
        fmt::format_to(to, "        {})\n            _arguments -S \\\n", single_quoted(command.name));
        for (const FlagText& flag : command.flags)
            for (const std::string& name : flag.names)
                fmt::format_to(to, "                {} \\\n", zsh_spec(flag, name));
        const bool has_choices = !command.positionals.empty() && !command.positionals.front().choices.empty();
        const bool has_files = std::ranges::any_of(command.positionals, &FlagText::takes_file);
        fmt::format_to(to, "                {}\n            ;;\n",
                       has_choices ? fmt::format("'1:name:({})'", join(command.positionals.front().choices))
                       : has_files ? std::string("'*:file:_files'")
                                   : std::string("'*: : '"));
    }
    fmt::format_to(to, "    esac\n}}\ncompdef _darkroom darkroom\n");
    return out;
}

std::string fish_condition(const Names& commands) {
    Names words;
    for (const std::string& command : commands) {
        const std::string word = command.substr(command.rfind(' ') + 1);
        if (std::ranges::find(words, word) == words.end()) words.push_back(word);
    }
    return fmt::format("__fish_seen_subcommand_from {}", join(words));
}

std::string fish_script(const Completion& all) {
    std::string out;
    const auto to = std::back_inserter(out);
    fmt::format_to(to, "# fish completion of darkroom\ncomplete -c darkroom -f\n");
    for (const char* const flag : {"help", "help-all", "version"})
        fmt::format_to(to, "complete -c darkroom -n __fish_use_subcommand -l {}\n", flag);
    for (const std::string& word : all.first)
        fmt::format_to(to, "complete -c darkroom -n __fish_use_subcommand -a {}\n", word);
    for (const auto& [parent, children] : all.children)
        fmt::format_to(to, "complete -c darkroom -n '{}; and not {}' -a '{}'\n", fish_condition({parent}),
                       fish_condition(children), join(children));
    for (const CommandText& command : all.commands) {
        const bool has_choices = !command.positionals.empty() && !command.positionals.front().choices.empty();
        if (has_choices)
            fmt::format_to(to, "complete -c darkroom -n '{}' -a '{}'\n", fish_condition({command.name}),
                           join(command.positionals.front().choices));
        else if (std::ranges::any_of(command.positionals, &FlagText::takes_file))
            fmt::format_to(to, "complete -c darkroom -n '{}' -F\n", fish_condition({command.name}));
    }
    for (const Shared& shared : shared_flags(all)) {
        const bool is_long = shared.name.starts_with("--");
        fmt::format_to(to, "complete -c darkroom -n '{}' -{} {}", fish_condition(shared.commands), is_long ? 'l' : 's',
                       shared.name.substr(is_long ? 2 : 1));
        if (!shared.flag->choices.empty())
            fmt::format_to(to, " -{} '{}'", shared.flag->value == "[EFFECT]" ? "fa" : "xa", join(shared.flag->choices));
        else if (!shared.flag->value.empty())
            fmt::format_to(to, "{}", shared.flag->takes_file() ? " -rF" : " -x");
        fmt::format_to(to, " -d {}\n", single_quoted(replaced(first_sentence(shared.flag->doc), "\\", "\\")));
    }
    return out;
}

struct Options {
    std::string shell, out;
};

int run(const CLI::App& program, const Options& options) {
    const std::map<std::string, std::string (*)(const Completion&)> shells{
        {"bash", bash_script}, {"fish", fish_script}, {"zsh", zsh_script}};
    const auto found = shells.find(options.shell);
    if (found == shells.end())
        return fail_user(
            fmt::format("completion {}: allowed is bash, fish or zsh", darkroom::printable(options.shell)));
    const std::string script = found->second(Completion(program));
    if (options.out.empty()) {
        fmt::print("{}", script);
        return exit_ok;
    }
    const darkroom::Result<> done = darkroom::write_file(options.out, std::as_bytes(std::span(script)));
    return done ? exit_ok : fail(done.error());
}

}  // namespace

Command add_completion(CommandFlags program) {
    const CommandFlags command =
        program.add_command("completion", "Prints a script that lets a shell complete commands and flags");
    command.examples(
        "darkroom completion bash --output darkroom.bash\n"
        "darkroom completion zsh --output _darkroom\n"
        "darkroom completion fish > darkroom.fish");
    const auto options = std::make_shared<Options>();
    command.add_option("SHELL", options->shell, "bash, fish or zsh").required().option_text("bash|fish|zsh");
    command.add_option("-o,--output", options->out, "A file instead of standard output").type_name("OUT");
    return {command, [options, program] { return run(program.parser(), *options); }};
}

}  // namespace app
