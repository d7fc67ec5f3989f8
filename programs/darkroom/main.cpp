// SPDX-License-Identifier: MIT
// darkroom: renders scenes and develops raw HDR frames into finished pictures. No effect is named here and no picture
// is touched.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>

#include "core/program_module.hpp"
#include "core/system/spawn.hpp"
#include "core/text/param_text.hpp"
#include "programs/darkroom/flags/program.hpp"
#include "programs/darkroom/run/report.hpp"

namespace {

/// Windows and references are programs of their own, which nobody waits for who wants a picture: this process becomes
/// the one that is called `name`. The flags are right, and that program reads them again.
int start(const char* name, std::span<char* const> arguments) {
    const std::string program = darkroom::program_module(name).string();
    const int reason = darkroom::become(program, arguments);
    app::complain(fmt::format("{} {}: {}; `cmake --build BUILD --target {}` builds it, to be installed again, and ./darkroom does, too",
                              arguments[1], darkroom::printable(program), std::strerror(reason), name));
    return app::exit_machine;
}

/// The command that is called `asked`, or all of them where none is. Flags of all effects in seven commands take longer
/// to make than everything else before the work. Help, completion and manual tell of all others.
std::vector<app::Command> add_commands(const app::CommandHost& host, std::string_view asked) {
    const std::vector<app::CommandRow>& all = app::all_commands();
    const auto own = std::ranges::find_if(all, [&](const app::CommandRow& row) {
        return row.names.front() != "help" && std::ranges::find(row.names, asked) != row.names.end();
    });
    if (own != all.end()) return add_commands(*own, host);
    std::vector<app::Command> out;
    for (const app::CommandRow& row : all) std::ranges::move(add_commands(row, host), std::back_inserter(out));
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    const std::span<char* const> arguments(argv, static_cast<std::size_t>(argc));
    return app::run_program(argc, argv, [arguments](auto program, auto named, auto asked) {
        return add_commands({.program = program,
                             .named = named,
                             .become = [arguments](const char* name) { return start(name, arguments); }},
                            asked);
    });
}
