// SPDX-License-Identifier: MIT
#pragma once
// The blocks of values that kernels read, as data: members in order, from which come the offsets that C++ writes at and
// the GLSL that reads there. They are uniform buffers with the layout of std430 scalars, which GLSL allows only for
// storage buffers unless the host enabled a feature: every member has an explicit offset.

#include <array>
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

    [[nodiscard]] std::string_view type_name() const {
        constexpr std::array<std::string_view, 4> names{"float", "int", "uint", "vec4"};
        return names[static_cast<std::size_t>(type)];
    }
};

/// Calls `visit(member, word)` with the word that each begins at; returns the word after the last. Scalars follow each
/// other, a Vec4 starts at a multiple of four words. `first_word` is a multiple of four.
template <class Visit>
std::uint32_t visit_members(std::span<const BlockMember> members, std::uint32_t first_word, const Visit& visit) {
    std::uint32_t word = first_word;
    for (const BlockMember& member : members) {
        const bool is_vector = member.type == BlockMember::Type::Vec4;
        if (is_vector) word = (word + 3) / 4 * 4;
        visit(member, word);
        word += is_vector ? 4 : 1;
    }
    return word;
}

/// Words that the members take.
[[nodiscard]] inline std::uint32_t word_count(std::span<const BlockMember> members) {
    return visit_members(members, 0, [](const BlockMember&, std::uint32_t) {});
}

/// A member's declaration in a block.
[[nodiscard]] std::string member_source(const BlockMember& member, std::uint32_t word);
/// All of them, in a block that begins `first_word` before them.
[[nodiscard]] std::string block_source(std::span<const BlockMember> members, std::uint32_t first_word);

}  // namespace darkroom::gpu
