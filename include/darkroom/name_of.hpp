// SPDX-License-Identifier: MIT
#pragma once
// Names that the compiler knows: of members, types and enumerators, as text in constant evaluation. What describe.hpp
// derives the names of parameters and of their choices from; nothing else needs it.

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace darkroom::detail {

// The compiler knows how a template argument is spelled; asking it keeps a name from being written twice. The
// static_asserts of describe.hpp fail first if a compiler changes its wording.
constexpr std::string_view last_identifier(std::string_view argument) {
    return argument.substr(argument.find_last_of(": ") + 1);
}
/// Of what a compiler calls name_of<A>: "... [with auto V = &darkroom::Rgb::g; ...]" (GCC), "... [V =
/// &darkroom::Rgb::g]" (Clang), "... darkroom::detail::name_of<&darkroom::Rgb::g>(void)" (MSVC).
constexpr std::string_view template_argument(std::string_view pretty, [[maybe_unused]] std::string_view key) {
#ifdef _MSC_VER
    constexpr std::string_view function = "name_of<";
    pretty.remove_prefix(pretty.rfind(function) + function.size());
    return pretty.substr(0, pretty.rfind(">(void)"));
#else
    pretty.remove_prefix(pretty.find(key) + key.size());
    return pretty.substr(0, pretty.find_first_of(";]"));
#endif
}
#ifdef _MSC_VER
#define DARKROOM_FUNCTION __FUNCSIG__
#else
#define DARKROOM_FUNCTION __PRETTY_FUNCTION__
#endif
template <auto V>
constexpr std::string_view name_of() {
    return last_identifier(template_argument(DARKROOM_FUNCTION, "V = "));
}
template <class T>
constexpr std::string_view name_of() {
    return last_identifier(template_argument(DARKROOM_FUNCTION, "T = "));
}
#undef DARKROOM_FUNCTION

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
            // A value without an enumerator prints as "(E)3", or "(enum E)0x3".
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
