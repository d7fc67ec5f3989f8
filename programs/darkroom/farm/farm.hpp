// SPDX-License-Identifier: MIT
#pragma once
// The commands below `farm`, which add themselves to it.

#include <span>

#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/flags.hpp"

namespace app {

[[nodiscard]] Command add_farm_slurm(CommandFlags farm, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_farm_task(CommandFlags farm, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_farm_status(CommandFlags farm);

}  // namespace app
