// SPDX-License-Identifier: MIT
#pragma once
// What the types of Vulkan that darkroom.h names are to a language that has no header of Vulkan.

#include <cstddef>
#include <span>
#include <string_view>

namespace app {

struct VulkanType {
    enum class Kind {
        Handle,    ///< a pointer to what only Vulkan knows
        Object,    ///< a handle that is a number of 64 bits on every machine
        Enum,      ///< a signed number of 32 bits
        Integer,   ///< unsigned; flags and sizes, too
        Struct,    ///< of its members
        Function,  ///< a pointer to one
        Opaque     ///< only pointed to
    };
    struct Member {
        std::string_view name, type;
    };
    std::string_view name;
    Kind kind = Kind::Opaque;
    std::size_t size = 0;  ///< bytes; 0 of what is only pointed to
    std::span<const Member> members{};
};

/// A struct stands behind those that it is made of.
[[nodiscard]] std::span<const VulkanType> vulkan_types();
/// "handle", "object" and so on.
[[nodiscard]] std::string_view name_of(VulkanType::Kind kind);

}  // namespace app
