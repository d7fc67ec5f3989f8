// SPDX-License-Identifier: MIT
#include "verify/test_planted/module.hpp"

#include <algorithm>

namespace darkroom::verify::test {

Module::Module(std::span<const std::uint32_t> words) : header(words.begin(), words.begin() + 5) {
    for (std::size_t at = 5; at < words.size();) {
        const std::size_t length = std::max<std::size_t>(words[at] >> 16U, 1);
        const auto part = words.subspan(at, std::min(length, words.size() - at));
        body.emplace_back(part.begin(), part.end());
        at += length;
    }
}

std::vector<std::uint32_t> Module::words() const {
    std::vector<std::uint32_t> out = header;
    for (Instruction one : body) {
        one[0] = static_cast<std::uint32_t>(one.size()) << 16U | opcode(one);
        out.insert(out.end(), one.begin(), one.end());
    }
    return out;
}

bool Module::is_vector(std::uint32_t type) const {
    return std::ranges::any_of(
        body, [&](const Instruction& one) { return opcode(one) == op::type_vector && one[1] == type; });
}

}  // namespace darkroom::verify::test
