// SPDX-License-Identifier: MIT
#include "gpu/device/loader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

namespace darkroom::gpu {

Result<PFN_vkGetInstanceProcAddr> open_vulkan_loader(const char* library) {
    // Never closed: drivers leave threads and exit handlers behind that need their code.
    void* const handle = ::dlopen(library, RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* const reason = ::dlerror();
        return machine_error(
            fmt::format("no Vulkan loader: {}", reason == nullptr ? std::string_view(library) : reason),
            ErrorCode::Unsupported);
    }
    const auto function = reinterpret_cast<PFN_vkGetInstanceProcAddr>(::dlsym(handle, "vkGetInstanceProcAddr"));
    if (function == nullptr) {
        return machine_error(fmt::format("no Vulkan loader: {} has no vkGetInstanceProcAddr", library),
                             ErrorCode::Unsupported);
    }
    return function;
}

}  // namespace darkroom::gpu
