// SPDX-License-Identifier: MIT
#include "image/color/icc_profile.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace darkroom {
namespace {

using Bytes = std::span<const std::byte>;

/// Empty where it lies outside.
Bytes piece(Bytes bytes, std::size_t offset, std::size_t size) {
    return offset <= bytes.size() && size <= bytes.size() - offset ? bytes.subspan(offset, size) : Bytes();
}

std::uint32_t number(Bytes bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (const std::byte byte : piece(bytes, offset, 4)) value = value << 8 | std::to_integer<std::uint32_t>(byte);
    return value;
}

bool is(Bytes bytes, std::size_t offset, std::string_view text) {
    return std::ranges::equal(piece(bytes, offset, 4), std::as_bytes(std::span(text)));
}

Bytes tag(Bytes profile, std::string_view name) {
    constexpr std::uint32_t max_tags = 100;
    const std::uint32_t count = std::min(number(profile, 128), max_tags);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::size_t entry = 132 + std::size_t{12} * i;
        if (is(profile, entry, name)) return piece(profile, number(profile, entry + 4), number(profile, entry + 8));
    }
    return {};
}

}  // namespace

std::string profile_description(Bytes profile) {
    if (!is(profile, 36, "acsp")) return {};
    const Bytes desc = tag(profile, "desc");
    const bool is_text = is(desc, 0, "desc"), is_wide = is(desc, 0, "mluc");
    Bytes text;
    if (is_text) text = piece(desc, 12, number(desc, 8));
    if (is_wide) text = piece(desc, number(desc, 24), number(desc, 20));
    constexpr std::size_t longest = 100;
    std::string out;
    for (std::size_t i = is_wide ? 1 : 0; i < text.size() && out.size() < longest; i += is_wide ? 2 : 1) {
        const auto letter = std::to_integer<unsigned char>(text[i]);
        if (letter == 0) break;
        out += letter >= 0x20 && letter < 0x7f ? static_cast<char>(letter) : '?';
    }
    return out;
}

}  // namespace darkroom
