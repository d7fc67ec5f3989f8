// SPDX-License-Identifier: MIT
#pragma once
// Which of a device's memory types an allocation is best served by.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <vector>

namespace darkroom::gpu {

enum class MemoryKind : std::uint8_t {
    Device,     ///< read and written by the GPU alone
    Constants,  ///< small, written by the CPU every frame, read by the GPU: device-local where the CPU can write there
    Upload,     ///< staging: written once by the CPU, copied once by the GPU
    Readback,   ///< copied into by the GPU, read by the CPU, which is slow unless it is cached
};

/// Indices of all types that would do, best first. `type_bits` is VkMemoryRequirements::memoryTypeBits. Types with a
/// property whose feature is not enabled (protected, AMD's device-coherent ones) and lazily allocated memory, which
/// only transient attachments may have, are never among them; all but Device's are host-visible and coherent.
[[nodiscard]] std::vector<std::uint32_t> memory_types_for(const VkPhysicalDeviceMemoryProperties& properties,
                                                          std::uint32_t type_bits, MemoryKind kind);

}  // namespace darkroom::gpu
