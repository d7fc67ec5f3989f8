// SPDX-License-Identifier: MIT
#pragma once
// Text and bytes for pages and drawings that are put together by hand: HTML, SVG.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace darkroom {

/// As text of a tag's content or of an attribute in either kind of quotes. What an attribute's words may mean (a
/// script, a link) is the caller's to check.
void append_escaped(std::string& out, std::string_view text);
[[nodiscard]] std::string escaped(std::string_view text);

/// RFC 4648, section 4, padded, in one line.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

}  // namespace darkroom
