// SPDX-License-Identifier: MIT
#include <dlfcn.h>

#include <system_error>

#include "core/system/module.hpp"

namespace darkroom {

const char* const vulkan_loader_name = "libvulkan.so.1";

Result<void*> load_library(const std::filesystem::path& library) {
    void* const loaded = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (loaded != nullptr) return loaded;
    const char* const reason = ::dlerror();
    return machine_error(reason == nullptr ? library.string() : reason, ErrorCode::Unsupported);
}

void* symbol_of(void* library, const char* name) { return ::dlsym(library, name); }

std::filesystem::path running_program() {
    std::error_code ignored;
    return std::filesystem::read_symlink("/proc/self/exe", ignored);
}

std::filesystem::path own_library() {
    Dl_info own{};
    const bool is_known = ::dladdr(reinterpret_cast<const void*>(&own_library), &own) != 0 && own.dli_fname != nullptr;
    return is_known ? own.dli_fname : std::filesystem::path();
}

}  // namespace darkroom
