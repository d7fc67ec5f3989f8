// SPDX-License-Identifier: MIT
#include "gpu/kernel/block.hpp"

#include <fmt/format.h>

namespace darkroom::gpu {

std::string member_source(const BlockMember& member, std::uint32_t word) {
    return fmt::format("    layout(offset = {}) {} {};\n", 4 * word, member.type_name(), member.name);
}

std::string block_source(std::span<const BlockMember> members, std::uint32_t first_word) {
    std::string out;
    visit_members(members, first_word,
                  [&](const BlockMember& member, std::uint32_t word) { out += member_source(member, word); });
    return out;
}

}  // namespace darkroom::gpu
