// SPDX-License-Identifier: MIT
#pragma once
// Other programs, run to their end: Slurm's commands, and this program once more, whose crash is then a chunk's failure
// and not the end of who watches over it.

#include <darkroom/result.hpp>
#include <string>
#include <vector>

namespace app {

struct ProcessOutcome {
    int code = 0;     ///< 128 and more: 128 + the signal that ended it
    std::string out;  ///< its standard output, where that was kept
    /// The last errors that it told as this program does; where it told none, and failed, its last words.
    std::vector<std::string> errors;
};

enum class ProcessOutput {
    Kept,  ///< for the caller alone
    Told,  ///< standard output and standard error are ours
};

/// The first argument is the program, looked for in PATH unless it has a slash. The machine's error: it cannot be run.
[[nodiscard]] darkroom::Result<ProcessOutcome> run_process(const std::vector<std::string>& arguments,
                                                           ProcessOutput output);

}  // namespace app
