// SPDX-License-Identifier: MIT
// darkroom: renders scenes and develops raw HDR frames into finished pictures. No effect is named here and no picture
// is touched.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>

#include "apps/darkroom/flags/run_program.hpp"
#include "apps/darkroom/run/report.hpp"
#include "core/program_module.hpp"
#include "core/system/spawn.hpp"
#include "core/text/param_text.hpp"

namespace {

/// Windows and references are programs of their own, which nobody waits for who wants a picture: this process becomes
/// the one that is called `name`. The flags are right, and that program reads them again.
int start(const char* name, std::span<char* const> arguments) {
    const std::string program = darkroom::program_module(name).string();
    const int reason = darkroom::become(program, arguments);
    app::complain(fmt::format("{} {}: {}; `cmake --build BUILD --target {}` builds it, and ./darkroom does, too",
                              arguments[1], darkroom::printable(program), std::strerror(reason), name));
    return app::exit_machine;
}

/// The command that is called `asked`, or all of them where none is. Flags of all effects in seven commands take longer
/// to make than everything else before the work.
std::vector<app::Command> add_commands(app::CommandFlags program, std::span<const darkroom::LookEntry> named,
                                       std::string_view asked, std::span<char* const> arguments) {
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
        {{"verify"},
         [&] {
             return Commands{
                 app::add_verify(program, [=](const auto&) { return start("darkroom_verifier", arguments); })};
         }},
        {{"info"}, [&] { return Commands{app::add_info(program)}; }},
        {{"lut"}, [&] { return app::add_lut(program, named); }},
        {{"farm"}, [&] { return app::add_farm(program, named); }},
#ifdef DARKROOM_VIEWER
        {{"play", "edit"},
         [&] {
             return app::add_view(program, named, [=](const auto&) { return start("darkroom_viewer", arguments); });
         }},
#endif
        {{"new"}, [&] { return Commands{app::add_new(program)}; }},
        {{"api"}, [&] { return Commands{app::add_api(program)}; }},
        // These tell of all others.
        {{},
         [&] {
             return Commands{app::add_help(program), app::add_completion(program), app::add_man(program)};
         }},
    };
    for (const Adding& one : all)
        if (std::ranges::find(one.names, asked) != one.names.end()) return one.add();
    Commands out;
    for (const Adding& one : all) std::ranges::move(one.add(), std::back_inserter(out));
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    const std::span<char* const> arguments(argv, static_cast<std::size_t>(argc));
    return app::run_program(argc, argv, [arguments](auto program, auto named, auto asked) {
        return add_commands(program, named, asked, arguments);
    });
}
