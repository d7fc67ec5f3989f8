// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>

#include "programs/darkroom/commands.hpp"
#include "view_flags.hpp"

namespace app {

namespace {

Command add_view(CommandFlags program, const char* name, const char* doc, bool is_edit,
                 std::span<const darkroom::LookEntry> named, const View& view) {
    const CommandFlags command = program.add_command(name, doc);
    command.examples(
        fmt::format("darkroom {0} scene.toml\n"
                    "darkroom {0} scene.toml --look my.toml --fullscreen\n"
                    "darkroom {0} 'shot.####.exr' --fps 24",
                    name));
    const auto flags = std::make_shared<ViewFlags>();
    flags->add_to(command, is_edit, named);
    return {command, [flags, view] { return view(*flags); }};
}

}  // namespace

std::vector<Command> add_view(CommandFlags program, std::span<const darkroom::LookEntry> named, const View& view) {
    return {
        add_view(program, "play", "Walks through a scene, live, in a window", false, named, view),
        add_view(program, "edit", "Shows a scene or frames, live, with every parameter at hand", true, named, view)};
}

CommandRow view_command() {
    return {.names = {"play", "edit"}, .place = 30, .add = [](const CommandHost& host) {
                return add_view(host.program, host.named,
                                [become = host.become](const ViewFlags&) { return become("darkroom_viewer"); });
            }};
}

}  // namespace app
