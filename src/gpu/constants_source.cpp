// SPDX-License-Identifier: MIT
#include "gpu/constants_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <regex>

namespace darkroom::gpu {

namespace {

struct Type {
    std::string_view name;
    std::string_view cast;  ///< from uint or uvecN
    std::uint32_t components = 1;
    std::uint32_t alignment = 4;
    std::uint32_t size = 4;
};

constexpr std::array types{
    Type{"float", "uintBitsToFloat", 1, 4, 4},
    Type{"int", "int", 1, 4, 4},
    Type{"uint", "uint", 1, 4, 4},
    Type{"vec2", "uintBitsToFloat", 2, 8, 8},
    Type{"ivec2", "ivec2", 2, 8, 8},
    Type{"uvec2", "uvec2", 2, 8, 8},
    Type{"vec3", "uintBitsToFloat", 3, 16, 12},
    Type{"ivec3", "ivec3", 3, 16, 12},
    Type{"uvec3", "uvec3", 3, 16, 12},
    Type{"vec4", "uintBitsToFloat", 4, 16, 16},
    Type{"ivec4", "ivec4", 4, 16, 16},
    Type{"uvec4", "uvec4", 4, 16, 16},
    Type{"mat3", "", 9, 16, 48},
    Type{"mat4", "", 16, 16, 64},
};

std::uint32_t align(std::uint32_t offset, std::uint32_t alignment) {
    return (offset + alignment - 1) / alignment * alignment;
}

std::string word_at(std::uint32_t component) {
    return fmt::format("darkroom_words[(word + {0}u) >> 2][(word + {0}u) & 3u]", component);
}

/// A function that reads element `index`, which begins `stride` bytes after its predecessor.
std::string accessor(const Type& type, std::string_view name, std::uint32_t offset, std::uint32_t stride) {
    std::string words = word_at(0);
    for (std::uint32_t component = 1; component < type.components; ++component) words += ", " + word_at(component);
    const std::string packed = type.components == 1 ? words : fmt::format("uvec{}({})", type.components, words);
    return fmt::format(
        "{0} {1}_at(uint index) {{ uint word = {2}u + index * {3}u; return {4}({5}); }}\n"
        "{0} {1}_at(int index) {{ return {1}_at(uint(index)); }}\n",
        type.name, name, offset / 4, stride / 4, type.cast, packed);
}

}  // namespace

ConstantsSource constants_source(std::string_view members) {
    static const std::regex comment(R"(//[^\n]*|/\*[\s\S]*?\*/)");
    static const std::regex declaration(
        R"(\s*(?:layout\s*\(\s*offset\s*=\s*(\d{1,9})\s*\)\s*)?(\w+)\s+([^;]+);|\s*(\S[^;]*;?))");
    static const std::regex declarator(R"((\w+)\s*(?:\[\s*(\d{1,5})\s*\])?)");
    const std::string plain = std::regex_replace(std::string(members), comment, " ");

    ConstantsSource source;
    std::string block;
    std::string accessors;
    std::uint32_t offset = 0;
    for (std::sregex_iterator statement(plain.begin(), plain.end(), declaration), end; statement != end; ++statement) {
        const std::string type_name = (*statement)[2];
        const auto* const type = std::ranges::find(types, type_name, &Type::name);
        if (type == types.end()) {
            block += "    " + statement->str() + "\n";
            continue;
        }
        const std::string names = (*statement)[3];
        if ((*statement)[1].matched) offset = static_cast<std::uint32_t>(std::stoul((*statement)[1]));
        for (std::sregex_iterator name(names.begin(), names.end(), declarator); name != end; ++name) {
            offset = align(offset, type->alignment);
            if (!(*name)[2].matched || type->cast.empty()) {
                block += fmt::format("    layout(offset = {}) {} {};\n", offset, type_name, name->str());
                offset += type->size;
                continue;
            }
            const std::uint32_t stride = align(type->size, type->alignment);
            accessors += accessor(*type, (*name)[1].str(), offset, stride);
            source.arrays.push_back((*name)[1]);
            offset += stride * static_cast<std::uint32_t>(std::stoul((*name)[2]));
        }
    }
    // Two blocks on one binding: Vulkan lets resources alias.
    if (!block.empty()) {
        source.text = fmt::format("layout(std140, set = 0, binding = 0) uniform DarkroomConstants {{\n{}}};\n", block);
    }
    if (!source.arrays.empty()) {
        source.text += fmt::format(
            "layout(std140, set = 0, binding = 0) uniform DarkroomWords {{ uvec4 darkroom_words[{}]; }};\n{}",
            align(offset, 16) / 16, accessors);
    }
    return source;
}

}  // namespace darkroom::gpu
