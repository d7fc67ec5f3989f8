// SPDX-License-Identifier: MIT
#include "gpu/device/device_facts.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace darkroom::gpu {

namespace {

/// A physical device that is nothing but what it says of itself.
struct Fake {
    std::uint32_t api_version = VK_API_VERSION_1_3;
    std::vector<const char*> extensions;
    VkBool32 has_features = VK_TRUE;
    VkQueueFlags queue = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    int feature_queries = 0;
};
Fake& fake() {
    static Fake device;
    return device;
}

Dispatch table_of(Fake device) {
    fake() = std::move(device);
    Dispatch vk;
    vk.EnumerateDeviceExtensionProperties = [](VkPhysicalDevice, const char*, std::uint32_t* count,
                                               VkExtensionProperties* out) {
        *count = static_cast<std::uint32_t>(fake().extensions.size());
        for (std::size_t i = 0; out != nullptr && i < *count; ++i) {
            std::strncpy(out[i].extensionName, fake().extensions[i], VK_MAX_EXTENSION_NAME_SIZE - 1);
        }
        return VK_SUCCESS;
    };
    vk.GetPhysicalDeviceFeatures2 = [](VkPhysicalDevice, VkPhysicalDeviceFeatures2* features) {
        ++fake().feature_queries;
        for (auto* link = static_cast<VkBaseOutStructure*>(features->pNext); link != nullptr; link = link->pNext) {
            void* const structure = link;
            if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES) {
                static_cast<VkPhysicalDeviceSynchronization2Features*>(structure)->synchronization2 =
                    fake().has_features;
            } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES) {
                static_cast<VkPhysicalDeviceDynamicRenderingFeatures*>(structure)->dynamicRendering =
                    fake().has_features;
            }
        }
    };
    vk.GetPhysicalDeviceQueueFamilyProperties = [](VkPhysicalDevice, std::uint32_t* count,
                                                   VkQueueFamilyProperties* out) {
        *count = 1;
        if (out != nullptr) out->queueFlags = fake().queue;
    };
    return vk;
}

std::vector<std::string> missing(Fake device) {
    const DeviceInfo info{.api_version = device.api_version};
    return missing_for_creation(table_of(std::move(device)), VK_NULL_HANDLE, info);
}

using Texts = std::vector<std::string>;

TEST(DeviceFacts, Vulkan13WithItsFeaturesLacksNothing) {
    EXPECT_EQ(missing({}), Texts{});
    EXPECT_EQ(missing({.has_features = VK_FALSE}),
              (Texts{"the feature synchronization2", "the feature dynamicRendering"}));
    EXPECT_EQ(missing({.queue = VK_QUEUE_COMPUTE_BIT}), (Texts{"a queue family with graphics and compute"}));
}

TEST(DeviceFacts, Vulkan12NeedsBothExtensions) {
    const std::vector<const char*> both{VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME, "VK_KHR_swapchain",
                                        VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME};
    EXPECT_EQ(missing({.api_version = VK_API_VERSION_1_2, .extensions = both}), Texts{});
    EXPECT_EQ(missing({.api_version = VK_API_VERSION_1_2, .extensions = {both[0]}}),
              (Texts{"VK_KHR_synchronization2 (needed on Vulkan 1.2)"}));
    EXPECT_EQ(fake().feature_queries, 0) << "structures of an extension that is not there are not asked for";
    EXPECT_EQ(missing({.api_version = VK_API_VERSION_1_2}).size(), 2U);
}

TEST(DeviceFacts, APortabilitySubsetIsAskedForWhereItIs) {
    const auto needed = [](Fake device) {
        const PromotedNames names = promoted_names(device.api_version);
        std::vector<VkExtensionProperties> there;
        EXPECT_EQ(device_extensions(table_of(std::move(device)), VK_NULL_HANDLE, there), VK_SUCCESS);
        const std::vector<const char*> extensions = needed_extensions(there, names);
        return std::vector<std::string>(extensions.begin(), extensions.end());
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(needed({.extensions = {"VK_KHR_swapchain"}}), Names());
    EXPECT_EQ(needed({.extensions = {"VK_KHR_swapchain", "VK_KHR_portability_subset"}}),
              Names{"VK_KHR_portability_subset"});
    EXPECT_EQ(needed({.api_version = VK_API_VERSION_1_2, .extensions = {"VK_KHR_portability_subset"}}),
              (Names{"VK_KHR_synchronization2", "VK_KHR_dynamic_rendering", "VK_KHR_portability_subset"}));
}

TEST(DeviceFacts, OlderDevicesAreToldWhatWouldDo) {
    const Texts texts = missing({.api_version = VK_API_VERSION_1_1});
    ASSERT_EQ(texts.size(), 1U);
    EXPECT_EQ(texts[0], "Vulkan 1.3, or 1.2 with VK_KHR_synchronization2 and VK_KHR_dynamic_rendering (it has 1.1)");
    EXPECT_EQ(fake().feature_queries, 0);
}

}  // namespace

}  // namespace darkroom::gpu
