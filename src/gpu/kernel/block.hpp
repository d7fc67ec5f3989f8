// SPDX-License-Identifier: MIT
#pragma once
// The blocks of values that kernels read, as data: members in order, from which come the offsets that C++ writes at and
// the GLSL that reads there. They are uniform buffers with the layout of std430 scalars, which GLSL allows only for
// storage buffers unless the host enabled a feature: every member has an explicit offset, and arrays are read as words.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::gpu {

struct BlockMember {
    enum class Type : std::uint8_t { Float, Int, Uint, Vec4 };
    Type type = Type::Float;
    std::string name;
    std::uint32_t count = 0;  ///< elements of an array of scalars, read as NAME[i]; 0: no array
};

/// Words that the members take: scalars follow each other, a Vec4 starts at a multiple of four words.
[[nodiscard]] std::uint32_t word_count(std::span<const BlockMember> members);

struct BlockSource {
    std::string members;                   ///< declarations for a block that begins `first_word` before them
    std::string accessors;                 ///< NAME_at(index) of the arrays, from uvec4 darkroom_words[]
    std::vector<std::string_view> arrays;  ///< their names
};
/// `first_word` is a multiple of four.
[[nodiscard]] BlockSource block_source(std::span<const BlockMember> members, std::uint32_t first_word);

}  // namespace darkroom::gpu
