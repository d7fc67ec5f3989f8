// SPDX-License-Identifier: MIT
#pragma once
// The words of a line that describes something.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace darkroom::custom {

inline constexpr std::string_view blanks = " \t\r";

[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Takes the first word off the text.
inline std::string_view next_word(std::string_view& text) {
    text = trimmed(text);
    const std::size_t end = std::min(text.find_first_of(blanks), text.size());
    const std::string_view word = text.substr(0, end);
    text = trimmed(text.substr(end));
    return word;
}

[[nodiscard]] inline std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> out;
    for (;;) {
        const std::size_t end = text.find(separator);
        out.push_back(trimmed(text.substr(0, end)));
        if (end == std::string_view::npos) return out;
        text.remove_prefix(end + 1);
    }
}

/// In [1, most].
[[nodiscard]] inline std::optional<std::uint32_t> parse_count(std::string_view text, std::uint32_t most) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value == 0 || value > most) return std::nullopt;
    return value;
}

template <class T, std::size_t Count>
using Names = std::array<std::pair<std::string_view, T>, Count>;

template <class T, std::size_t Count>
[[nodiscard]] std::optional<T> named(const Names<T, Count>& names, std::string_view word) {
    for (const auto& [name, value] : names)
        if (name == word) return value;
    return std::nullopt;
}
template <class T, std::size_t Count>
[[nodiscard]] std::string listed(const Names<T, Count>& names) {
    std::string out;
    for (const auto& [name, value] : names) out += (out.empty() ? "" : ", ") + std::string(name);
    return out;
}

}  // namespace darkroom::custom
