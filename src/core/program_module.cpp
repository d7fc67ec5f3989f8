// SPDX-License-Identifier: MIT
#include "core/program_module.hpp"

#include <system_error>

namespace darkroom {

std::filesystem::path program_module(const char* file) {
    std::error_code ignored;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    // From the folder of programs to that of modules, as installed: src/core/CMakeLists.txt.
    std::filesystem::path installed = folder / DARKROOM_MODULES / file;
    return std::filesystem::exists(installed, ignored) ? installed : folder / "../lib/darkroom" / file;
}

}  // namespace darkroom
