// SPDX-License-Identifier: MIT
#include "gpu/resource/memory_types.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace darkroom::gpu {

namespace {

using Types = std::vector<std::uint32_t>;

constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr VkMemoryPropertyFlags lazy = VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT;
constexpr VkMemoryPropertyFlags secret = VK_MEMORY_PROPERTY_PROTECTED_BIT;
constexpr VkMemoryPropertyFlags amd_coherent = VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD;
constexpr VkMemoryPropertyFlags amd_uncached = amd_coherent | VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD;

constexpr std::uint32_t all = ~0U;

VkPhysicalDeviceMemoryProperties device_with(std::initializer_list<VkMemoryPropertyFlags> flags) {
    VkPhysicalDeviceMemoryProperties properties{};
    for (const VkMemoryPropertyFlags of_type : flags) {
        properties.memoryTypes[properties.memoryTypeCount++].propertyFlags = of_type;
    }
    return properties;
}

// The types of RADV on a discrete GPU: each once more for device-coherent memory.
const VkPhysicalDeviceMemoryProperties discrete_amd =
    device_with({local, host, local | host, host | cached, local | amd_uncached, host | amd_uncached,
                 local | host | amd_uncached, host | cached | amd_uncached});
const VkPhysicalDeviceMemoryProperties discrete_nvidia = device_with({0, local, host, host | cached, local | host});
const VkPhysicalDeviceMemoryProperties integrated = device_with({local | host, local | host | cached});
const VkPhysicalDeviceMemoryProperties software = device_with({local | host | cached});
const VkPhysicalDeviceMemoryProperties mobile =
    device_with({local | secret, local | lazy, local, local | host, local | host | cached});

TEST(MemoryTypes, ImagesLieInDeviceLocalMemory) {
    EXPECT_EQ(memory_types_for(discrete_amd, all, MemoryKind::Device), (Types{0, 2, 1, 3})) << "host memory comes last";
    EXPECT_EQ(memory_types_for(discrete_nvidia, all, MemoryKind::Device), (Types{1, 4, 0, 2, 3}));
    EXPECT_EQ(memory_types_for(integrated, all, MemoryKind::Device), (Types{0, 1}));
    EXPECT_EQ(memory_types_for(software, all, MemoryKind::Device), (Types{0}));
}

TEST(MemoryTypes, ConstantsLieWhereTheGpuIsAndTheCpuCanWrite) {
    EXPECT_EQ(memory_types_for(discrete_amd, all, MemoryKind::Constants), (Types{2, 1, 3}));
    EXPECT_EQ(memory_types_for(discrete_nvidia, all, MemoryKind::Constants), (Types{4, 2, 3}));
    EXPECT_EQ(memory_types_for(integrated, all, MemoryKind::Constants), (Types{0, 1}));
    EXPECT_EQ(memory_types_for(discrete_nvidia, 0b01111, MemoryKind::Constants), (Types{2, 3}))
        << "there is no such memory for this buffer";
}

TEST(MemoryTypes, StagingLeavesDeviceMemoryToOthers) {
    EXPECT_EQ(memory_types_for(discrete_amd, all, MemoryKind::Upload), (Types{1, 3, 2}));
    EXPECT_EQ(memory_types_for(discrete_nvidia, all, MemoryKind::Upload), (Types{2, 3, 4}));
    EXPECT_EQ(memory_types_for(software, all, MemoryKind::Upload), (Types{0}));
}

TEST(MemoryTypes, ReadBackIsCached) {
    EXPECT_EQ(memory_types_for(discrete_amd, all, MemoryKind::Readback), (Types{3, 1, 2}));
    EXPECT_EQ(memory_types_for(discrete_nvidia, all, MemoryKind::Readback), (Types{3, 2, 4}));
    EXPECT_EQ(memory_types_for(integrated, all, MemoryKind::Readback), (Types{1, 0}));
}

TEST(MemoryTypes, WhatNeedsAFeatureOrATransientAttachmentIsNeverTaken) {
    EXPECT_EQ(memory_types_for(mobile, all, MemoryKind::Device), (Types{2, 3, 4}));
    EXPECT_EQ(memory_types_for(mobile, 0b00011, MemoryKind::Device), Types{}) << "not even as the last resort";
    EXPECT_EQ(memory_types_for(discrete_amd, 0b11110000, MemoryKind::Readback), Types{});
    for (const MemoryKind kind :
         {MemoryKind::Device, MemoryKind::Constants, MemoryKind::Upload, MemoryKind::Readback}) {
        for (const std::uint32_t type : memory_types_for(discrete_amd, all, kind)) EXPECT_LT(type, 4U);
    }
}

TEST(MemoryTypes, OnlyWhatTheResourceAllows) {
    for (std::uint32_t type = 0; type < discrete_nvidia.memoryTypeCount; ++type) {
        EXPECT_EQ(memory_types_for(discrete_nvidia, 1U << type, MemoryKind::Device), (Types{type}));
    }
    EXPECT_EQ(memory_types_for(discrete_nvidia, 0b00011, MemoryKind::Upload), Types{}) << "nothing there is mapped";
}

}  // namespace

}  // namespace darkroom::gpu
