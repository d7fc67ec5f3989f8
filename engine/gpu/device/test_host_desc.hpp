// SPDX-License-Identifier: MIT
#pragma once
// For tests only: what a host would say of the shared test device. Not part of the library.

#include <darkroom/device.hpp>

#include "gpu/test_run.hpp"

namespace darkroom::gpu::test {

inline bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

inline const std::string cache_folder = ::testing::TempDir() + "darkroom_test_cache";

inline AdoptDesc host_desc(const VkPhysicalDeviceFeatures2* features) {
    const Context& shared = context();
    return {.instance = shared.instance,
            .physical_device = shared.physical_device,
            .device = shared.device,
            .queue_family = shared.queue_family,
            .enabled_features = features,
            .get_proc = shared.vk.GetInstanceProcAddr,
            .cache_folder = cache_folder};
}

}  // namespace darkroom::gpu::test
