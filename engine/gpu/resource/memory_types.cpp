// SPDX-License-Identifier: MIT
#include "gpu/resource/memory_types.hpp"

#include <algorithm>

namespace darkroom::gpu {

namespace {

constexpr VkMemoryPropertyFlags never = VK_MEMORY_PROPERTY_PROTECTED_BIT | VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT |
                                        VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD |
                                        VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD;
constexpr VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

/// `first` weighs more than `second`: each is a property, and whether it is wanted.
struct Wish {
    VkMemoryPropertyFlags needed = 0;
    VkMemoryPropertyFlags first = 0;
    bool wants_first = false;
    VkMemoryPropertyFlags second = 0;
    bool wants_second = false;
};

Wish wish_of(MemoryKind kind) {
    switch (kind) {
        case MemoryKind::Device:
            // What the CPU can also write is scarce on a discrete GPU, and left to those who write.
            return {0, local, true, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, false};
        case MemoryKind::Constants:
            return {host, local, true, cached, false};
        case MemoryKind::Upload:
            return {host, local, false, cached, false};
        case MemoryKind::Readback:
            return {host, cached, true, local, false};
    }
    return {};
}

int penalty(const Wish& wish, VkMemoryPropertyFlags flags) {
    const bool misses_first = ((flags & wish.first) != 0) != wish.wants_first;
    const bool misses_second = ((flags & wish.second) != 0) != wish.wants_second;
    return (misses_first ? 2 : 0) + (misses_second ? 1 : 0);
}

}  // namespace

std::vector<std::uint32_t> memory_types_for(const VkPhysicalDeviceMemoryProperties& properties, std::uint32_t type_bits,
                                            MemoryKind kind) {
    const Wish wish = wish_of(kind);
    const auto flags_of = [&](std::uint32_t type) { return properties.memoryTypes[type].propertyFlags; };
    std::vector<std::uint32_t> types;
    for (std::uint32_t type = 0; type < properties.memoryTypeCount; ++type) {
        const bool is_allowed = (type_bits & (1U << type)) != 0 && (flags_of(type) & never) == 0;
        if (is_allowed && (flags_of(type) & wish.needed) == wish.needed) types.push_back(type);
    }
    // Of equals the driver lists the faster one first.
    std::ranges::stable_sort(types, {}, [&](std::uint32_t type) { return penalty(wish, flags_of(type)); });
    return types;
}

}  // namespace darkroom::gpu
