// SPDX-License-Identifier: MIT
#pragma once
// Words as a shell takes them.

#include <algorithm>
#include <cctype>
#include <span>
#include <string>
#include <string_view>

namespace app {

/// As it is, or in quotes where the shell would take it apart.
[[nodiscard]] inline std::string shell_quoted(const std::string& text) {
    const auto is_plain = [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("_./:=,+-@").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
    std::string out = "'";
    for (const char c : text)
        if (c == '\'')
            out += "'\\''";
        else
            out += c;
    return out + "'";
}

[[nodiscard]] inline std::string shell_quoted(std::span<const std::string> words) {
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " ") + shell_quoted(word);
    return out;
}

}  // namespace app
