// SPDX-License-Identifier: MIT
#include "apps/darkroom/commands.hpp"

#include <fmt/format.h>

#include <memory>

#include "apps/darkroom/run/report.hpp"
#include "apps/viewer/input/keys.hpp"
#include "apps/viewer/input/view_flags.hpp"

namespace app {

namespace {

Command add_view(CommandFlags program, const char* name, const char* doc, bool is_edit,
                 std::span<const darkroom::LookEntry> named) {
    const CommandFlags command = program.add_command(name, doc);
    command.examples(
        fmt::format("darkroom {0} scene.toml\n"
                    "darkroom {0} scene.toml --look my.toml --fullscreen\n"
                    "darkroom {0} 'shot.####.exr' --fps 24",
                    name));
    const auto flags = std::make_shared<ViewFlags>();
    flags->add_to(command, is_edit, named);
    return {command, [flags] {
                if (flags->asks_for_keys()) {
                    fmt::print("{}", keys_text());
                    return exit_ok;
                }
                darkroom::Result<ViewerJob> job = flags->job();
                return job ? run_viewer(std::move(*job)) : fail(job.error());
            }};
}

}  // namespace

std::vector<Command> add_viewer(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    return {add_view(program, "play", "Walks through a scene, live, in a window", false, named),
            add_view(program, "edit", "Shows a scene or frames, live, with every parameter at hand", true, named)};
}

}  // namespace app
