// SPDX-License-Identifier: MIT
#pragma once
// Names that the compiler knows: of members, types and enumerators, as text in constant evaluation. What param.hpp
// derives the names of parameters and of their choices from; nothing else needs it.

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace darkroom::detail {

// The compiler knows how a template argument is spelled; asking it keeps a name from being written twice. GCC and
// Clang; the static_asserts fail first if a compiler changes its wording.
constexpr std::string_view last_identifier(std::string_view pretty, std::string_view key) {
    pretty.remove_prefix(pretty.find(key) + key.size());
    pretty = pretty.substr(0, pretty.find_first_of(";]"));
    return pretty.substr(pretty.rfind(':') + 1);
}
template <auto V>
constexpr std::string_view name_of() {
    return last_identifier(__PRETTY_FUNCTION__, "V = ");
}
template <class T>
constexpr std::string_view name_of() {
    return last_identifier(__PRETTY_FUNCTION__, "T = ");
}

/// An enumerator's name as users write it: AcesNarkowicz -> aces_narkowicz.
struct SnakeName {
    std::array<char, 48> text{};
    std::size_t size = 0;
    [[nodiscard]] constexpr std::string_view view() const { return {text.data(), size}; }
};
constexpr SnakeName snake_name(std::string_view pascal) {
    SnakeName out;
    for (std::size_t i = 0; i < pascal.size(); ++i) {
        const bool is_upper = pascal[i] >= 'A' && pascal[i] <= 'Z';
        if (is_upper && i > 0) out.text[out.size++] = '_';
        out.text[out.size++] = is_upper ? static_cast<char>(pascal[i] - 'A' + 'a') : pascal[i];
    }
    return out;
}

template <class E>
struct Enumerators {
    static constexpr std::size_t limit = 32;
    static constexpr std::size_t count = [] {
        std::size_t n = 0;
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            // A value without an enumerator prints as "(E)3".
            ((n += name_of<static_cast<E>(I)>().find(')') == std::string_view::npos ? 1u : 0u), ...);
        }
        (std::make_index_sequence<limit>{});
        return n;
    }();
    static constexpr std::array<SnakeName, count> storage = [] {
        std::array<SnakeName, count> out{};
        [&]<std::size_t... I>(std::index_sequence<I...>) { ((out[I] = snake_name(name_of<static_cast<E>(I)>())), ...); }
        (std::make_index_sequence<count>{});
        return out;
    }();
    static constexpr std::array<std::string_view, count> names = [] {
        std::array<std::string_view, count> out{};
        for (std::size_t i = 0; i < count; ++i) out[i] = storage[i].view();
        return out;
    }();
};

}  // namespace darkroom::detail
