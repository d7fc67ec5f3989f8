// SPDX-License-Identifier: MIT
#pragma once
// The commands below `farm`, which add themselves to it.

#include <CLI/CLI.hpp>
#include <span>

#include "apps/darkroom/commands.hpp"

namespace app {

[[nodiscard]] Command add_farm_slurm(CLI::App& farm, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_farm_task(CLI::App& farm);
[[nodiscard]] Command add_farm_status(CLI::App& farm);

}  // namespace app
