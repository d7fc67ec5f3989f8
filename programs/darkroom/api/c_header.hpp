// SPDX-License-Identifier: MIT
#pragma once
// What darkroom.h declares, as data, read from its own text: what bindings for other languages are made of. It is no
// parser of C: its grammar is as narrow as that header, and all else is an error, so that no declaration is left out
// unnoticed.

#include <cstdint>
#include <darkroom/result.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace app {

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
/// (vulkan_types.hpp) or declared before is one.
[[nodiscard]] darkroom::Result<CHeader> parse_c_header(std::string_view text, std::string_view shown);

/// A declaration in C: "const char* const* names", "float jitter[2]".
[[nodiscard]] std::string in_c(const CVariable& variable);
/// "VkResult" and, with pointers, "const char*".
[[nodiscard]] std::string in_c(const CType& type);

}  // namespace app
