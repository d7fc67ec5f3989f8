// SPDX-License-Identifier: MIT
#include "program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "confined/process.hpp"
#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "programs/darkroom/effects/named_effects.hpp"
#include "programs/darkroom/help/help.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

// The flags and commands that an unknown argument may have been meant to be.
std::vector<std::string> known_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* const option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const CLI::App* const child : command.get_subcommands({})) names.push_back(child->get_name());
    return names;
}

std::vector<std::string> names_of_commands(const CLI::App& program) {
    std::vector<std::string> names;
    for (const CLI::App* const command : program.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

// "lut info": a command and whose it is.
std::string full_name(const CLI::App& command) {
    const CLI::App* const above = command.get_parent();
    const bool is_below_another = above != nullptr && above->get_parent() != nullptr;
    return is_below_another ? fmt::format("{} {}", above->get_name(), command.get_name()) : command.get_name();
}

std::string unknown_argument(const CLI::App& command, const std::string& argument) {
    const std::string name = argument.substr(0, argument.find('='));
    const std::vector<std::string> known = known_names(command);
    // The amount of some effects has the effect's own name.
    for (const std::string_view amount : {"-intensity", "-amount", "-strength"}) {
        const std::string effect = name.ends_with(amount) ? name.substr(0, name.size() - amount.size()) : "";
        if (std::ranges::find(known, effect) != known.end())
            return fmt::format("{}: unknown argument '{}', did you mean '{}'?", full_name(command), printable(argument),
                               effect);
    }
    std::string hint = darkroom::suggestion(name, known);
    if (hint.empty() && command.get_option_no_throw("MORE") != nullptr)
        hint = "; flags of develop and render stand behind --";
    return fmt::format("{}: unknown argument '{}'{}", full_name(command), printable(argument), hint);
}

// Of the commands that were typed, and theirs, the one with an argument that nobody took.
const CLI::App* command_with_rest(const CLI::App& program) {
    for (const CLI::App* const command : program.get_subcommands()) {
        if (const CLI::App* const inner = command_with_rest(*command)) return inner;
        if (!command->remaining().empty()) return command;
    }
    return nullptr;
}

// The first argument nobody took.
std::string unknown_argument(const CLI::App& program) {
    if (const CLI::App* const command = command_with_rest(program))
        return unknown_argument(*command, command->remaining().front());
    const std::vector<std::string> rest = program.remaining();
    if (rest.empty()) return fmt::format("a command is needed: {}", fmt::join(names_of_commands(program), ", "));
    return unknown_command(program, rest.front());
}

darkroom::Failure value_needed(std::string_view flag) {
    return user_error(fmt::format("{}: one value is needed", printable(flag)));
}

// "--size: At Most 1 required but received 2": it stands twice.
darkroom::Failure mismatch(std::string_view text) {
    constexpr std::string_view too_often = ": At Most 1 required but received ";
    const std::string_view flag = text.substr(0, text.find(':'));
    const std::size_t found = text.find(too_often);
    if (found == std::string_view::npos) return value_needed(flag);
    return user_error(
        fmt::format("{}: stands {} times, once is allowed", printable(flag), text.substr(found + too_often.size())));
}

// "--look --output a.png": the flag that CLI11 took for a value, since that is missing.
std::string flag_for_value(const CLI::App& command) {
    for (const CLI::Option* const option : command.get_options()) {
        if (option->get_positional()) continue;
        for (const std::string& value : option->results())
            if (value.starts_with('-') && command.get_option_no_throw(value.substr(0, value.find('='))) != nullptr)
                return fmt::format("{}: one value is needed, before '{}'", option->get_name(), printable(value));
    }
    return {};
}

// "--vignette 0.5", "--tonemap agx": a switch takes no value, and what stands behind it was taken for a file. Empty:
// nothing of the kind.
std::string value_of_switch(const CLI::App& command, std::span<char* const> arguments) {
    std::error_code error;
    for (std::size_t i = 1; i + 1 < arguments.size(); ++i) {
        const std::string flag = arguments[i], value = arguments[i + 1];
        const CLI::Option* const option = flag.starts_with("--") ? command.get_option_no_throw(flag) : nullptr;
        if (option == nullptr || option->get_expected_max() != 0 || std::filesystem::exists(value, error)) continue;
        const bool is_number = darkroom::parse_number(value).has_value();
        if (!is_number && !std::ranges::all_of(value, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; }))
            continue;
        for (const std::string_view meant : {"-intensity", "-amount", "-strength", "-curve"}) {
            const std::string name = flag + std::string(meant);
            if (is_number != (meant == "-curve") && command.get_option_no_throw(name) != nullptr)
                return fmt::format("{}: takes no value, did you mean '{} {}'?", flag, name, value);
        }
    }
    return {};
}

std::string missing(const CLI::App& program) {
    if (const auto typed = program.get_subcommands(); !typed.empty()) return missing(*typed.front());
    if (program.get_require_subcommand_min() > 0)
        return (program.get_parent() == nullptr ? "" : program.get_name() + ": ") + unknown_argument(program);
    if (!program.remaining().empty()) return unknown_argument(program, program.remaining().front());
    if (std::string text = flag_for_value(program); !text.empty()) return text;
    const CommandText command = describe(program);
    for (const std::vector<FlagText>* const list : {&command.positionals, &command.flags})
        for (const FlagText& flag : *list)
            if (flag.is_required && program.get_option(flag.names.front())->empty())
                return fmt::format("{}: {}{} is needed: {}", full_name(program), flag.names.front(),
                                   flag.value.empty() ? "" : " " + flag.value, flag.doc);
    return fmt::format("{}: an argument is missing", full_name(program));
}

}  // namespace

std::string unknown_command(const CLI::App& program, const std::string& name) {
    const std::string near = darkroom::suggestion(name, known_names(program));
    return fmt::format("unknown command '{}'{} allowed is {}", printable(name), near.empty() ? ":" : near,
                       fmt::join(names_of_commands(program), ", "));
}

Program::Program()
    : parser_(std::make_unique<CLI::App>("Renders scenes, and develops raw HDR frames into finished pictures.",
                                         "darkroom")) {
    parser_->set_version_flag("--version", "darkroom " DARKROOM_VERSION);
    parser_->require_subcommand(1);
    parser_->footer(
        "darkroom render scene.toml --size 640x360 -o picture.png\n"
        "darkroom develop frame.exr --exposure 2 --vignette-intensity 0.3 -o picture.png\n"
        "darkroom develop --help bloom");
}

Program::~Program() = default;

Result<std::optional<int>> Program::parse(std::span<char* const> arguments) const {
    // CLI11 would take the next argument for the value.
    for (std::size_t i = 1; i < arguments.size(); ++i) {
        const std::string_view argument = arguments[i];
        if (argument.starts_with("--") && argument.ends_with('=') && argument.find('=') == argument.size() - 1)
            return value_needed(argument.substr(0, argument.size() - 1));
    }
    try {
        parser_->parse(static_cast<int>(arguments.size()), arguments.data());
    } catch (const CLI::Success& done) {  // --version
        return std::optional<int>(parser_->exit(done));
    } catch (const CLI::ExtrasError&) {
        const CLI::App* const command = command_with_rest(*parser_);
        std::string text = command == nullptr ? std::string() : flag_for_value(*command);
        return user_error(text.empty() ? unknown_argument(*parser_) : std::move(text));
    } catch (const CLI::ArgumentMismatch& error) {
        return mismatch(error.what());
    } catch (const CLI::ConversionError& error) {  // "Could not convert: --strict = maybe": of switches alone
        const std::string text = error.what();
        const std::size_t end = text.find(": ");
        return user_error(fmt::format("{}: allowed is true or false",
                                      printable(end == std::string::npos ? text : text.substr(end + 2))));
    } catch (const CLI::RequiredError&) {
        return user_error(missing(*parser_));
    } catch (const CLI::ParseError& error) {
        return user_error(printable(error.what()));
    }
    return std::optional<int>();
}

void add_voice(CommandFlags command) {
    command.parser().add_flag_callback(
        "-q,--quiet", [] { set_voice(Voice::Quiet); }, "Says nothing but warnings and errors");
    command.parser().add_flag_callback(
        "-v,--verbose", [] { set_voice(Voice::Verbose); },
        "Says more: the device, and all that is left out with the reason");
    command.parser().add_flag_callback(
        "--allow-unconfined", [] { darkroom::ConfinedProcess::allow_unconfined(true); },
        "Decodes files even where the kernel cannot confine their decoders");
}

bool is_asked(CommandFlags command) { return command.parser().parsed(); }

Result<> check_values(CommandFlags command) {
    if (std::string text = flag_for_value(command.parser()); !text.empty()) return user_error(std::move(text));
    for (const CLI::Option* const option : command.parser().get_options()) {
        if (option->get_type_name().empty()) continue;
        for (const std::string& value : option->results())
            if (value.empty()) return value_needed(option->get_name());
    }
    return {};
}

Trial::Trial() : parser_(std::make_unique<CLI::App>()) {}
Trial::~Trial() = default;

Result<> Trial::parse(std::vector<std::string> arguments, CommandFlags command) const {
    std::ranges::reverse(arguments);  // as CLI11 takes them
    try {
        parser_->parse(arguments);
    } catch (const CLI::ExtrasError&) {
        const std::vector<std::string> rest = command.parser().remaining();
        return user_error(unknown_argument(command.parser(), rest.empty() ? std::string() : rest.front()));
    } catch (const CLI::ParseError& problem) {
        return user_error(fmt::format("{}: {}", command.name(), printable(problem.what())));
    }
    return {};
}

namespace {

int run(int argc, char** argv, const AddCommands& add_commands) {
    const Program program;
    const std::span<char* const> arguments(argv, static_cast<std::size_t>(argc));
    add_help_flags(program.flags().parser());
    const std::vector<darkroom::LookEntry> named = effects_named_by(arguments);
    const std::vector<Command> commands = add_commands(program.flags(), named, argc > 1 ? argv[1] : "");
    for (const Command& command : commands) add_voice(command.flags);
    if (const std::optional<int> code = answer_help(program.flags().parser(), arguments)) return *code;
    const darkroom::Result<std::optional<int>> answered = program.parse(arguments);
    if (!answered) return fail(answered.error());
    if (*answered) return **answered;
    const auto chosen = std::ranges::find_if(commands, is_asked, &Command::flags);
    if (const darkroom::Result<> done = check_values(chosen->flags); !done) return fail(done.error());
    if (std::string text = value_of_switch(chosen->flags.parser(), arguments); !text.empty())
        return fail(user_error(std::move(text)).value());
    return chosen->run();
}

/// Started by a task of a farm, this process ends when that one does, by whatever hand.
void end_with_task() {
    const char* const task = std::getenv(task_of_farm);
    if (task == nullptr || std::to_string(::getppid()) != task) return;
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (std::to_string(::getppid()) != task) std::raise(SIGTERM);
}

}  // namespace

std::vector<Command> add_commands(const CommandRow& row, const CommandHost& host) {
    std::vector<Command> out = row.add(host);
    if (row.is_rare)
        for (const Command& command : out) command.flags.put_aside();
    return out;
}

int run_program(int argc, char** argv, const AddCommands& add_commands) {
    hold_standard_streams();
    darkroom::AtomicPath::remove_on_signals();
    survive_size_limits();
    end_with_task();
    // Whoever reads objects reads of a wrong flag, too.
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        const bool is_json = word == "--progress" && i + 1 < argc && std::string_view(argv[i + 1]) == "json";
        if (is_json || word == "--progress=json") report_as_json();
    }
    // Exceptions come from third parties and from the allocator alone.
    try {
        return end_output(run(argc, argv, add_commands));
    } catch (const std::bad_alloc&) {
        complain("out of memory");
    } catch (const std::exception& error) {
        complain(error.what());
    }
    return exit_machine;
}

}  // namespace app
