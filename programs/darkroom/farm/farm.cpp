// SPDX-License-Identifier: MIT
// darkroom farm: a sequence over many machines.
#include "farm.hpp"

namespace app {

static std::vector<Command> add_farm(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    const CommandFlags farm = program.add_command("farm", "Makes the pictures of a sequence on many machines");
    farm.require_command();
    farm.examples(
        "darkroom farm slurm 'shot.####.exr' --look my.toml -o . --chunk 1 --dry-run\n"
        "darkroom farm task 'shot.####.exr' --look my.toml -o . --frames 1-2\n"
        "darkroom farm status .");
    return {add_farm_slurm(farm, named), add_farm_task(farm, named), add_farm_status(farm)};
}

CommandRow farm_command() {
    return {.names = {"farm"}, .place = 110, .add = [](const CommandHost& host) {
                return add_farm(host.program, host.named);
            }};
}

}  // namespace app
