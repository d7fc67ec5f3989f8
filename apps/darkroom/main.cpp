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
#include "apps/darkroom/flags/program.hpp"
#include "apps/darkroom/help/help.hpp"
#include "apps/darkroom/run/report.hpp"
#include "commands.hpp"
#include "core/files.hpp"

namespace {

/// The command that is called `asked`, or all of them where none is. Flags of all effects in seven commands take longer
/// to make than everything else before the work.
std::vector<app::Command> add_commands(app::CommandFlags program, std::span<const darkroom::LookEntry> named,
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
        {{"bake"}, [&] { return Commands{app::add_bake(program, named)}; }},
        {{"effects"}, [&] { return Commands{app::add_effects(program)}; }},
        {{"devices"}, [&] { return Commands{app::add_devices(program)}; }},
        {{"compare"}, [&] { return Commands{app::add_compare(program)}; }},
        {{"capture"}, [&] { return Commands{app::add_capture(program)}; }},
        {{"judge"}, [&] { return Commands{app::add_judge(program)}; }},
        {{"info"}, [&] { return Commands{app::add_info(program)}; }},
        {{"lut"}, [&] { return app::add_lut(program, named); }},
        {{"farm"}, [&] { return app::add_farm(program, named); }},
#ifdef DARKROOM_VIEWER
        {{"play", "edit"}, [&] { return app::add_viewer(program, named); }},
#endif
        {{"new"}, [&] { return Commands{app::add_new(program)}; }},
        {{"api"}, [&] { return Commands{app::add_api(program)}; }},
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
    const app::Program program;
    const std::span<char* const> arguments(argv, static_cast<std::size_t>(argc));
    app::add_help_flags(program.flags().parser());
    const std::vector<darkroom::LookEntry> named = app::effects_named_by(arguments);
    const std::vector<app::Command> commands = add_commands(program.flags(), named, argc > 1 ? argv[1] : "");
    for (const app::Command& command : commands) app::add_voice(command.flags);
    if (const std::optional<int> code = app::answer_help(program.flags().parser(), arguments)) return *code;
    const darkroom::Result<std::optional<int>> answered = program.parse(arguments);
    if (!answered) return app::fail(answered.error());
    if (*answered) return **answered;
    const auto chosen = std::ranges::find_if(commands, app::is_asked, &app::Command::flags);
    if (const darkroom::Result<> done = app::check_values(chosen->flags); !done) return app::fail(done.error());
    return chosen->run();
}

}  // namespace

int main(int argc, char** argv) {
    darkroom::AtomicPath::remove_on_signals();
    // Exceptions come from third parties and from the allocator alone.
    try {
        return app::end_output(run(argc, argv));
    } catch (const std::bad_alloc&) {
        app::complain("out of memory");
    } catch (const std::exception& error) {
        app::complain(error.what());
    }
    return app::exit_machine;
}
