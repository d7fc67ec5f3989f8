// SPDX-License-Identifier: MIT
#pragma once
// What every function of the C interface does: it catches what is thrown, makes a code and a text of an error, and
// reads and writes structs of other versions.

#include <darkroom/darkroom.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/caught.hpp"
#include "core/try.hpp"

namespace darkroom::c {

/// Makes an error this thread's last one. `function` empty: its text names it.
DarkroomResult tell(const char* function, const Error& error) noexcept;
/// The text of the last one.
[[nodiscard]] const char* last_error();
/// The code that an error has here.
[[nodiscard]] DarkroomResult code_of(const Error& error);

/// Runs `work`, which returns a Result<>.
template <class Work>
DarkroomResult call(const char* function, const Work& work) noexcept {
    try {
        if (Result<> done = work(); !done) return tell(function, done.error());
        return DARKROOM_OK;
    } catch (...) {
        return tell("", caught(function).value());
    }
}
/// The same for functions that return something else: `otherwise` after an error.
template <class Value, class Work>
Value call_for(const char* function, Value otherwise, const Work& work) noexcept {
    Value out = otherwise;
    call(function, [&]() -> Result<> {
        out = work();
        return {};
    });
    return out;
}

[[nodiscard]] inline Failure is_null(std::string_view what) { return user_error(fmt::format("{}: it is null", what)); }
/// Pointers that have to be there: needs("composer", composer, "desc", desc).
[[nodiscard]] inline Result<> needs() { return {}; }
template <class Pointer, class... Rest>
[[nodiscard]] Result<> needs(const char* name, Pointer pointer, Rest... rest) {
    if (pointer == nullptr) return is_null(name);
    return needs(rest...);
}

/// Longest arrays of structs and of words that a call may bring.
inline constexpr std::uint32_t max_elements = 65536;

/// A struct as this library knows it, of one whose size says how much the caller knows. `name` is its type's.
template <class T>
[[nodiscard]] Result<T> read(const T* given, std::string_view name, std::size_t size) {
    static_assert(std::is_trivially_copyable_v<T>);
    T out{};
    // The first version of each struct is the present one.
    if (size < sizeof(T) || size > 16 * sizeof(T))
        return user_error(
            fmt::format("{}.struct_size = {}: allowed is sizeof({}), {} in this version", name, size, name, sizeof(T)));
    const auto* const bytes = reinterpret_cast<const unsigned char*>(given);
    if (std::any_of(bytes + sizeof(T), bytes + size, [](unsigned char byte) { return byte != 0; }))
        return user_error(fmt::format("{}: a member after its first {} bytes is set, which this version does not know",
                                      name, sizeof(T)));
    std::memcpy(&out, bytes, sizeof(T));
    return out;
}
template <class T>
[[nodiscard]] Result<T> read(const T* given, std::string_view name) {
    return read(given, name, given->struct_size);
}
/// Null: all zero.
template <class T>
[[nodiscard]] Result<T> read_or_default(const T* given, std::string_view name) {
    return given == nullptr ? Result<T>(T{}) : read(given, name);
}
/// One of an array of structs: the size of the first is that of all.
template <class T>
[[nodiscard]] Result<T> read_at(const T* first, std::uint32_t index, std::string_view name) {
    if (first == nullptr) return is_null(fmt::format("{}[{}]", name, index));
    const auto* const bytes = reinterpret_cast<const unsigned char*>(first);
    const std::size_t size = first->struct_size;
    return read(reinterpret_cast<const T*>(bytes + size * index), name, size);
}
template <class T>
[[nodiscard]] Result<std::vector<T>> read_all(const T* first, std::uint32_t count, std::string_view name) {
    std::vector<T> out;
    if (count > max_elements)
        return user_error(fmt::format("{} {}: allowed are at most {}", count, name, max_elements));
    out.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        DARKROOM_TRY_VALUE(auto one, read_at(first, i, name));
        out.push_back(one);
    }
    return out;
}
/// Fills in a struct of the caller's, whose size it has set.
template <class T>
[[nodiscard]] Result<> write(T* out, T value, std::string_view name) {
    DARKROOM_TRY(read(out, name));
    value.struct_size = out->struct_size;
    std::memcpy(out, &value, sizeof(T));
    return {};
}
/// One of an array of the caller's.
template <class T>
[[nodiscard]] Result<> write_at(T* first, std::size_t index, const T& value, std::string_view name) {
    auto* const out = reinterpret_cast<T*>(reinterpret_cast<unsigned char*>(first) + first->struct_size * index);
    out->struct_size = first->struct_size;
    return write(out, value, name);
}
/// Copies `from` into an array with room for `*count`, which becomes how many there are.
template <class T>
void write_all(std::span<const T> from, T* out, std::uint32_t* count) {
    if (out != nullptr) std::copy_n(from.begin(), std::min<std::size_t>(*count, from.size()), out);
    *count = static_cast<std::uint32_t>(from.size());
}

[[nodiscard]] inline std::string_view view(const char* text) {
    return text == nullptr ? std::string_view{} : std::string_view(text);
}
[[nodiscard]] inline std::string string(const char* text) { return std::string(view(text)); }

/// A value of an enum that ends at `last`. Of a caller's, which may be any number, not even the load is sure.
template <class To, class From>
[[nodiscard]] Result<To> enumerator(const From& value, From last, std::string_view name) {
    static_assert(sizeof(From) == sizeof(std::int32_t));
    std::int32_t number = 0;
    std::memcpy(&number, &value, sizeof number);
    if (number < 0 || number > static_cast<std::int32_t>(last))
        return user_error(fmt::format("{} = {}: allowed is 0 to {}", name, number, static_cast<std::int32_t>(last)));
    return static_cast<To>(number);
}

}  // namespace darkroom::c
