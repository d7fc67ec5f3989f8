// SPDX-License-Identifier: MIT
// darkroom: renders scenes and develops raw HDR frames into finished pictures. Arguments to library calls, and errors
// to exit codes; no effect is named here and no picture is touched.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <optional>

#include "commands.hpp"
#include "core/files.hpp"
#include "core/param_text.hpp"
#include "named_effects.hpp"
#include "report.hpp"

namespace {

// The flags and commands that an unknown argument may have been meant to be.
std::vector<std::string> known_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* const option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const CLI::App* const child : command.get_subcommands({})) names.push_back(child->get_name());
    return names;
}

// The first argument nobody took.
std::string unknown_argument(const CLI::App& program) {
    for (const CLI::App* const command : program.get_subcommands()) {
        const std::vector<std::string> rest = command->remaining();
        if (rest.empty()) continue;
        const std::string name = rest.front().substr(0, rest.front().find('='));
        return fmt::format("{}: unknown argument '{}'{}", command->get_name(), darkroom::printable(rest.front()),
                           darkroom::suggestion(name, known_names(*command)));
    }
    std::vector<std::string> commands;
    for (const CLI::App* const command : program.get_subcommands({})) commands.push_back(command->get_name());
    const std::vector<std::string> rest = program.remaining();
    if (rest.empty()) return fmt::format("a command is needed: {}", fmt::join(commands, ", "));
    return fmt::format("unknown command '{}': allowed is {}{}", darkroom::printable(rest.front()),
                       fmt::join(commands, ", "), darkroom::suggestion(rest.front(), known_names(program)));
}

// An option whose value is an empty text, which names nothing. Those without a type are values of the look, which say
// themselves what they allow.
std::optional<std::string> empty_option(const CLI::App& command) {
    for (const CLI::Option* const option : command.get_options()) {
        if (option->get_type_name().empty()) continue;
        for (const std::string& value : option->results())
            if (value.empty()) return option->get_name();
    }
    return std::nullopt;
}

int run(int argc, char** argv) {
    CLI::App program("Renders scenes, and develops raw HDR frames into finished pictures.", "darkroom");
    program.set_version_flag("--version", "darkroom " DARKROOM_VERSION);
    program.require_subcommand(1);
    program.get_formatter()->column_width(34);
    program.footer(
        "`darkroom COMMAND --help` lists the flags of a command.\n"
        "DARKROOM_VALIDATE=1 turns the Vulkan validation layer on. Exit codes: 0 done, 1 the request is wrong, 2 the "
        "machine failed; `compare` has 3: they differ.");
    const std::vector<darkroom::LookEntry> named = app::effects_named_by({argv, static_cast<std::size_t>(argc)});
    std::vector commands{app::add_render(program, named), app::add_develop(program, named),
                         app::add_probe(program, named),  app::add_plan(program, named),
                         app::add_effects(program),       app::add_devices(program),
                         app::add_compare(program),       app::add_info(program)};
    std::ranges::move(app::add_lut(program, named), std::back_inserter(commands));
#ifdef DARKROOM_VIEWER
    std::ranges::move(app::add_viewer(program, named), std::back_inserter(commands));
#endif
    // CLI11 would take the next argument for the value.
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument.starts_with("--") && argument.ends_with('=') && argument.find('=') == argument.size() - 1)
            return app::fail_user(
                fmt::format("{}: one value is needed", darkroom::printable(argument.substr(0, argument.size() - 1))));
    }
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return program.exit(done);
    } catch (const CLI::ExtrasError&) {
        return app::fail_user(unknown_argument(program));
    } catch (const CLI::ArgumentMismatch& error) {
        const std::string text = error.what();
        return app::fail_user(
            fmt::format("{}: one value is needed", darkroom::printable(text.substr(0, text.find(':')))));
    } catch (const CLI::RequiredError& error) {
        for (const CLI::App* const command : program.get_subcommands())
            if (command->get_require_subcommand_min() > 0 && command->get_subcommands().empty())
                return app::fail_user(fmt::format("{}: {}", command->get_name(), unknown_argument(*command)));
        return app::fail_user(program.get_subcommands().empty() ? unknown_argument(program)
                                                                : std::string(error.what()));
    } catch (const CLI::ParseError& error) {
        return app::fail_user(darkroom::printable(error.what()));
    }
    const auto chosen = std::find_if(commands.begin(), commands.end(),
                                     [](const app::Command& command) { return command.app->parsed(); });
    if (const std::optional<std::string> name = empty_option(*chosen->app))
        return app::fail_user(fmt::format("{}: one value is needed", *name));
    return chosen->run();
}

}  // namespace

int main(int argc, char** argv) {
    darkroom::AtomicPath::remove_on_signals();
    // Exceptions come from third parties and from the allocator alone.
    try {
        return run(argc, argv);
    } catch (const std::bad_alloc&) {
        app::complain("out of memory");
    } catch (const std::exception& error) {
        app::complain(error.what());
    }
    return app::exit_machine;
}
