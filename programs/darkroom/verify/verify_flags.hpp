// SPDX-License-Identifier: MIT
#pragma once
// The flags of `verify`.

#include <string>
#include <vector>

#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/flags.hpp"

namespace app {

struct VerifyFlags {
    void add_to(CommandFlags command);

    std::string device, report, folder;
    std::vector<std::string> effects;
    NumberFlag seconds{"--seconds", {.least = 1, .most = 86400, .unit = "s"}};
    NumberFlag seed{"--seed", {.least = 0, .most = 4294967295, .is_whole = true}};
    bool is_json = false;
};

/// Verifies what the flags ask for. Returns the exit code.
using Verify = std::function<int(const VerifyFlags&)>;
[[nodiscard]] Command add_verify(CommandFlags program, const Verify& verify);

}  // namespace app
