// SPDX-License-Identifier: MIT
#include "gpu/device/loader.hpp"

#include <fmt/format.h>

namespace darkroom::gpu {

Result<PFN_vkGetInstanceProcAddr> open_vulkan_loader(const char* library) {
    const Result<void*> loaded = load_library(library);
    if (!loaded) return machine_error(fmt::format("no Vulkan loader: {}", loaded.error().text), ErrorCode::Unsupported);
    const auto function = reinterpret_cast<PFN_vkGetInstanceProcAddr>(symbol_of(*loaded, "vkGetInstanceProcAddr"));
    if (function == nullptr) {
        return machine_error(fmt::format("no Vulkan loader: {} has no vkGetInstanceProcAddr", library),
                             ErrorCode::Unsupported);
    }
    return function;
}

}  // namespace darkroom::gpu
