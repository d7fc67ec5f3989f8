// SPDX-License-Identifier: MIT
#include "vulkan_types.hpp"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <type_traits>

namespace app {

namespace {

using Kind = VulkanType::Kind;
using Member = VulkanType::Member;

/// Of a type that is what it is said to be.
template <class T, Kind kind>
constexpr VulkanType type(std::string_view name) {
    static_assert(kind != Kind::Handle || (std::is_pointer_v<T> && sizeof(T) == sizeof(void*)));
    static_assert(kind != Kind::Function || std::is_pointer_v<T>);
    static_assert(kind != Kind::Object || sizeof(T) == 8);
    static_assert(kind != Kind::Enum || (std::is_enum_v<T> && sizeof(T) == 4));
    static_assert(kind != Kind::Integer || std::is_unsigned_v<T>);
    return {.name = name, .kind = kind, .size = sizeof(T)};
}
template <class T>
constexpr VulkanType composed(std::string_view name, std::span<const Member> members) {
    return {.name = name, .kind = Kind::Struct, .size = sizeof(T), .members = members};
}

static_assert(std::is_same_v<decltype(VkExtent2D{}.width), std::uint32_t> && sizeof(VkExtent2D) == 8);
constexpr Member extent[]{{"width", "uint32_t"}, {"height", "uint32_t"}};
static_assert(std::is_same_v<decltype(VkOffset2D{}.x), std::int32_t> && sizeof(VkOffset2D) == 8);
constexpr Member offset[]{{"x", "int32_t"}, {"y", "int32_t"}};
static_assert(offsetof(VkRect2D, extent) == sizeof(VkOffset2D) && sizeof(VkRect2D) == 16);
constexpr Member rectangle[]{{"offset", "VkOffset2D"}, {"extent", "VkExtent2D"}};

constexpr VulkanType types[]{
    type<VkInstance, Kind::Handle>("VkInstance"),
    type<VkPhysicalDevice, Kind::Handle>("VkPhysicalDevice"),
    type<VkDevice, Kind::Handle>("VkDevice"),
    type<VkCommandBuffer, Kind::Handle>("VkCommandBuffer"),
    type<VkImage, Kind::Object>("VkImage"),
    type<VkImageView, Kind::Object>("VkImageView"),
    type<VkBuffer, Kind::Object>("VkBuffer"),
    type<VkDeviceMemory, Kind::Object>("VkDeviceMemory"),
    type<VkPipelineCache, Kind::Object>("VkPipelineCache"),
    type<VkResult, Kind::Enum>("VkResult"),
    type<VkFormat, Kind::Enum>("VkFormat"),
    type<VkImageLayout, Kind::Enum>("VkImageLayout"),
    type<VkBool32, Kind::Integer>("VkBool32"),
    type<VkDeviceSize, Kind::Integer>("VkDeviceSize"),
    type<VkImageUsageFlags, Kind::Integer>("VkImageUsageFlags"),
    type<VkPipelineStageFlags2, Kind::Integer>("VkPipelineStageFlags2"),
    type<VkAccessFlags2, Kind::Integer>("VkAccessFlags2"),
    composed<VkOffset2D>("VkOffset2D", offset),
    composed<VkExtent2D>("VkExtent2D", extent),
    composed<VkRect2D>("VkRect2D", rectangle),
    type<PFN_vkGetInstanceProcAddr, Kind::Function>("PFN_vkGetInstanceProcAddr"),
    {.name = "VkPhysicalDeviceFeatures2", .kind = Kind::Opaque},
    {.name = "VkAllocationCallbacks", .kind = Kind::Opaque},
};

}  // namespace

std::span<const VulkanType> vulkan_types() { return types; }

std::string_view name_of(Kind kind) {
    switch (kind) {
        case Kind::Handle:
            return "handle";
        case Kind::Object:
            return "object";
        case Kind::Enum:
            return "enum";
        case Kind::Integer:
            return "integer";
        case Kind::Struct:
            return "struct";
        case Kind::Function:
            return "function";
        case Kind::Opaque:
            return "opaque";
    }
    return "";
}

}  // namespace app
