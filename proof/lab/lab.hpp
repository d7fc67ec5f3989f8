// SPDX-License-Identifier: MIT
#pragma once
// The commands of darkroom_lab.

#include "programs/darkroom/commands.hpp"

namespace app {

[[nodiscard]] Command add_api(CommandFlags program);
[[nodiscard]] Command add_capture(CommandFlags program);
[[nodiscard]] Command add_judge(CommandFlags program);

}  // namespace app
