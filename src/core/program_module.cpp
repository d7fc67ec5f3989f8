// SPDX-License-Identifier: MIT
#include "core/program_module.hpp"

#include <dlfcn.h>

#include <system_error>

namespace darkroom {

std::filesystem::path program_module(const char* file) {
    std::error_code ignored;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    // From the folder of programs to that of modules, as installed: src/core/CMakeLists.txt.
    const std::filesystem::path installed = folder / DARKROOM_MODULES / file;
    if (std::filesystem::exists(installed, ignored)) return installed;
    // In somebody else's program: beside the library that this is a part of.
    Dl_info own{};
    if (dladdr(reinterpret_cast<const void*>(&program_module), &own) != 0 && own.dli_fname != nullptr) {
        const auto beside = std::filesystem::path(own.dli_fname).parent_path() / "darkroom" / file;
        if (std::filesystem::exists(beside, ignored)) return beside;
    }
    return folder / "../lib/darkroom" / file;
}

}  // namespace darkroom
