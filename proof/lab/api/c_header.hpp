// SPDX-License-Identifier: MIT
#pragma once
// What darkroom.h declares, as data, read from its own text: what bindings for other languages are made of. It is no
// parser of C: its grammar is as narrow as that header, and all else is an error, so that no declaration is left out
// unnoticed.

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace app {

/// What the types of Vulkan that darkroom.h names are to a language that has no header of Vulkan.
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

struct CType {
    std::string name;  ///< "char", "DarkroomPlan", "VkImage"
    bool is_const = false;
    std::vector<bool> stars;   ///< is the pointer itself const? `const char* const*`: yes, no
    std::uint32_t length = 0;  ///< of an array, and of a parameter how many it points to; 0: it is none
};
/// A member, or a parameter.
struct CVariable {
    std::string name;
    CType type;
    std::string doc;
};
struct CConstant {
    std::string name;
    std::uint64_t value = 0;
    std::string doc, type;  ///< type: empty of an enum's
};
/// A pointer to what only the library knows.
struct CHandle {
    std::string name, doc;
};
/// Another name of an integer.
struct CAlias {
    std::string name, type, doc;
};
struct CEnum {
    std::string name, doc;
    std::vector<CConstant> values;
};
struct CStruct {
    std::string name, doc;
    std::vector<CVariable> members;
};
/// One of the library, or the type of one of the host's that it calls.
struct CFunction {
    std::string name, doc;
    CType result;
    std::vector<CVariable> parameters;
};

/// Each list in the order of the header.
struct CHeader {
    std::vector<CConstant> constants;
    std::vector<CHandle> handles;
    std::vector<CAlias> aliases;
    std::vector<CEnum> enums;
    std::vector<CStruct> structs;
    std::vector<CFunction> callbacks, functions;
};

/// Errors are "shown:line: what stands there: what is expected". A type that is not of C, of Vulkan
/// (vulkan_types()) or declared before is one.
[[nodiscard]] darkroom::Result<CHeader> parse_c_header(std::string_view text, std::string_view shown);

/// A declaration in C: "const char* const* names", "float jitter[2]".
[[nodiscard]] std::string in_c(const CVariable& variable);
/// "VkResult" and, with pointers, "const char*".
[[nodiscard]] std::string in_c(const CType& type);

}  // namespace app
