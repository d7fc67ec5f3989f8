// SPDX-License-Identifier: MIT
#pragma once
// Takes from a process what drawing needs not, before it reads anything of a stranger's: other processes, the network,
// and files but to read those of some folders. Where the kernel has no Landlock, all files can be read as before; where
// it has no seccomp, calls are not held back.

#include <string>
#include <vector>

namespace darkroom {

struct Confinement {
    bool has_landlock = false;
    bool has_seccomp = false;
};

/// For good, for this process and all its threads; call it while there is one.
Confinement confine(const std::vector<std::string>& readable_folders);

}  // namespace darkroom
