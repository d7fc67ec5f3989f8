// SPDX-License-Identifier: MIT
#pragma once
// Takes from a process what its work needs not, before it reads anything of a stranger's: other processes, the network,
// and files but to read those of some folders, or all files. Where the kernel has no Landlock, a process that may read
// some can read all as before; where it has no seccomp, calls are not held back.

#include <span>
#include <string>
#include <vector>

namespace darkroom {

struct Confinement {
    bool has_landlock = false;
    bool has_seccomp = false;
};

/// For good, for this process and all its threads; call it while there is one. Without a folder it opens nothing, and
/// cannot ask what there is.
Confinement confine(const std::vector<std::string>& readable_folders);

/// Why it must not go on: its calls are not held back, and none of its arguments is allow_unconfined_flag. Else empty.
[[nodiscard]] std::string why_not_confined(const Confinement& done, std::span<const char* const> arguments);

}  // namespace darkroom
