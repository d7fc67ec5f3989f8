// SPDX-License-Identifier: MIT
#include "gpu/kernel/block.hpp"

#include <fmt/format.h>

#include <array>

namespace darkroom::gpu {

namespace {

struct TypeText {
    const char* name;
    const char* from_word;
};
constexpr std::array types{TypeText{"float", "uintBitsToFloat"}, TypeText{"int", "int"}, TypeText{"uint", "uint"},
                           TypeText{"vec4", ""}};

/// Calls `visit(member, word)` with the word that each begins at; returns the word after the last.
template <class Visit>
std::uint32_t lay_out(std::span<const BlockMember> members, std::uint32_t word, const Visit& visit) {
    for (const BlockMember& member : members) {
        const bool is_vector = member.type == BlockMember::Type::Vec4;
        if (is_vector) word = (word + 3) / 4 * 4;
        visit(member, word);
        word += is_vector ? 4 : member.count == 0 ? 1 : member.count;
    }
    return word;
}

}  // namespace

std::uint32_t word_count(std::span<const BlockMember> members) {
    return lay_out(members, 0, [](const BlockMember&, std::uint32_t) {});
}

BlockSource block_source(std::span<const BlockMember> members, std::uint32_t first_word) {
    BlockSource source;
    lay_out(members, first_word, [&](const BlockMember& member, std::uint32_t word) {
        const TypeText& type = types[static_cast<std::size_t>(member.type)];
        if (member.count == 0) {
            source.members += fmt::format("    layout(offset = {}) {} {};\n", word * 4, type.name, member.name);
            return;
        }
        source.arrays.push_back(member.name);
        source.accessors += fmt::format(
            "{0} {1}_at(uint index) {{ uint word = {2}u + index; return {3}(darkroom_words[word >> 2][word & 3u]); }}\n"
            "{0} {1}_at(int index) {{ return {1}_at(uint(index)); }}\n",
            type.name, member.name, word, type.from_word);
    });
    return source;
}

}  // namespace darkroom::gpu
