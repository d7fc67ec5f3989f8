// SPDX-License-Identifier: MIT
#pragma once
// Starting another program, with files of the caller's choice in the place of its own.

#include <spawn.h>
#include <sys/types.h>

#include <atomic>
#include <span>
#include <string>

namespace darkroom {

/// Where AtomicPath::remove_on_signals() is in force, the signal that ends this process is sent to that one, too; 0:
/// none.
inline std::atomic<pid_t> process_that_ends_with_us{0};

class Spawn {
  public:
    Spawn();
    Spawn(const Spawn&) = delete;
    Spawn& operator=(const Spawn&) = delete;
    ~Spawn();

    /// Descriptor `to` of the program is this file.
    Spawn& open(int to, const char* path, int flags, mode_t mode = 0);
    /// Descriptor `to` of the program is our `from`.
    Spawn& give(int from, int to);
    /// The program has no descriptor from this one on.
    Spawn& close_from(int first);

    /// Starts `program`, looked for in PATH unless it has a slash. 0, or why it failed, as errno has it.
    [[nodiscard]] int start(pid_t& process, const std::string& program, std::span<const std::string> arguments) const;

  private:
    posix_spawn_file_actions_t actions_{};
};

/// This process becomes `program`, with these arguments. Returns only where that failed: why, as errno has it.
[[nodiscard]] int become(const std::string& program, std::span<char* const> arguments);

}  // namespace darkroom
