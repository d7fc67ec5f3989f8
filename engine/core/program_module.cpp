// SPDX-License-Identifier: MIT
#include "core/program_module.hpp"

#include <system_error>

#include "core/system/module.hpp"

namespace darkroom {

std::filesystem::path program_module(const char* file) {
    std::error_code ignored;
    const auto folder = running_program().parent_path();
    // From the folder of programs to that of modules, as installed: engine/core/CMakeLists.txt.
    const std::filesystem::path installed = folder / DARKROOM_MODULES / file;
    if (std::filesystem::exists(installed, ignored)) return installed;
    // The running program is one of them.
    if (std::filesystem::exists(folder / file, ignored)) return folder / file;
    // In somebody else's program: beside the library that this is a part of.
    const auto beside = own_library().parent_path() / "darkroom" / file;
    if (std::filesystem::exists(beside, ignored)) return beside;
    return folder / "../lib/darkroom" / file;
}

}  // namespace darkroom
