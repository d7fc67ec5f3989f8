// SPDX-License-Identifier: MIT
// darkroom: renders scenes and develops raw HDR frames into finished pictures. Arguments to library calls, and errors
// to exit codes; no effect is named here and no picture is touched.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <iterator>
#include <new>
#include <optional>

#include "apps/darkroom/effects/named_effects.hpp"
#include "apps/darkroom/help/help.hpp"
#include "apps/darkroom/run/report.hpp"
#include "commands.hpp"
#include "core/files.hpp"
#include "core/text/param_text.hpp"

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

void add_voice(CLI::App& command) {
    command.add_flag_callback(
        "-q,--quiet", [] { app::set_voice(app::Voice::Quiet); }, "Says nothing but warnings and errors");
    command.add_flag_callback(
        "-v,--verbose", [] { app::set_voice(app::Voice::Verbose); },
        "Says more: the device, and all that is left out with the reason");
}

/// The command that is called `asked`, or all of them where none is. Flags of all effects in seven commands take longer
/// to make than everything else before the work.
std::vector<app::Command> add_commands(CLI::App& program, std::span<const darkroom::LookEntry> named,
                                       std::string_view asked) {
    using Commands = std::vector<app::Command>;
    struct Adding {
        std::vector<std::string_view> names;
        std::function<Commands()> add;
    };
    const std::vector<Adding> all{
        {{"render"}, [&] { return Commands{app::add_render(program, named)}; }},
        {{"develop"}, [&] { return Commands{app::add_develop(program, named)}; }},
        {{"probe"}, [&] { return Commands{app::add_probe(program, named)}; }},
        {{"plan"}, [&] { return Commands{app::add_plan(program, named)}; }},
        {{"effects"}, [&] { return Commands{app::add_effects(program)}; }},
        {{"devices"}, [&] { return Commands{app::add_devices(program)}; }},
        {{"compare"}, [&] { return Commands{app::add_compare(program)}; }},
        {{"info"}, [&] { return Commands{app::add_info(program)}; }},
        {{"lut"}, [&] { return app::add_lut(program, named); }},
        {{"farm"}, [&] { return app::add_farm(program, named); }},
#ifdef DARKROOM_VIEWER
        {{"play", "edit"}, [&] { return app::add_viewer(program, named); }},
#endif
        {{"new"}, [&] { return Commands{app::add_new(program)}; }},
        // These tell of all others.
        {{},
         [&] {
             return Commands{app::add_completion(program), app::add_man(program)};
         }},
    };
    for (const Adding& one : all)
        if (std::ranges::find(one.names, asked) != one.names.end()) return one.add();
    Commands out;
    for (const Adding& one : all) std::ranges::move(one.add(), std::back_inserter(out));
    return out;
}

int run(int argc, char** argv) {
    CLI::App program("Renders scenes, and develops raw HDR frames into finished pictures.", "darkroom");
    program.set_version_flag("--version", "darkroom " DARKROOM_VERSION);
    program.require_subcommand(1);
    program.footer(
        "darkroom render scene.toml --size 640x360 -o picture.png\n"
        "darkroom develop frame.exr --exposure 2 --vignette-intensity 0.3 -o picture.png\n"
        "darkroom develop --help bloom");
    app::add_help_flags(program);
    const std::vector<darkroom::LookEntry> named = app::effects_named_by({argv, static_cast<std::size_t>(argc)});
    const std::vector<app::Command> commands = add_commands(program, named, argc > 1 ? argv[1] : "");
    for (const app::Command& command : commands) add_voice(*command.app);
    if (const std::optional<int> code = app::answer_help(program, {argv, static_cast<std::size_t>(argc)})) return *code;
    // CLI11 would take the next argument for the value.
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument.starts_with("--") && argument.ends_with('=') && argument.find('=') == argument.size() - 1)
            return app::fail_user(
                fmt::format("{}: one value is needed", darkroom::printable(argument.substr(0, argument.size() - 1))));
    }
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& done) {  // --version
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
