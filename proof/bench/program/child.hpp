// SPDX-License-Identifier: MIT
#pragma once
// Other programs, timed from start to end.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/measure.hpp"

namespace darkroom::bench {

/// Runs `arguments`, the program (looked for along PATH) first, and waits; what it prints goes to the file `log`. The
/// CPU time is that of all its threads. Nothing: there is no such program. An error: it failed, with its last line.
[[nodiscard]] Result<std::optional<Sample>> run_program(std::vector<std::string> arguments,
                                                        const std::filesystem::path& log);

}  // namespace darkroom::bench
