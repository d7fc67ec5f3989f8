// SPDX-License-Identifier: MIT
#pragma once
// What a parameter is: the types it may have, and its row, which the GLSL block, the TOML keys, the command-line flags,
// the console variables, the sliders, the documentation and the error messages all read. Rows are written in the
// effect's source, by describe.hpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace darkroom {

/// What a number measures; printed behind values and intervals.
struct Unit {
    std::string_view symbol;
};
namespace unit {
inline constexpr Unit none{""}, pixels{"px"}, nits{"cd/m2"}, metres{"m"}, per_metre{"1/m"}, degrees{"deg"},
    seconds{"s"};
/// How many times as much light; its texts may say stops instead: "1.5ev".
inline constexpr Unit multiplier{"x"};
}  // namespace unit

enum class Scale : std::uint8_t { Linear, Log };

/// The values a number may take: [min, max]. Empty unless said: a number without a range does not compile.
struct Range {
    double min = 0.0;
    double max = 0.0;
    Scale scale = Scale::Linear;
};

// The only types a parameter may have, beside float, std::int32_t and enums of 4 bytes. All are made of 4-byte scalars,
// so a struct of them needs no padding and has the same offsets in C++ and in a std430 block of scalars.
struct Vec2 {
    float x = 0, y = 0;
};
struct Vec3 {
    float x = 0, y = 0, z = 0;
};
struct Vec4 {
    float x = 0, y = 0, z = 0, w = 0;
};
/// Linear Rec. 709.
struct Rgb {
    float r = 0, g = 0, b = 0;
};
struct Toggle {
    std::uint32_t on = 0;
    constexpr Toggle() = default;
    constexpr Toggle(bool value) : on(value) {}
    constexpr explicit operator bool() const { return on != 0; }
};
/// A function of one variable: up to 16 points, x ascending, linear between them and constant outside.
struct Curve {
    static constexpr std::size_t capacity = 16;
    std::uint32_t count = 0;
    std::array<float, capacity> x{}, y{};
};
/// An image or table that the host gave the Composer a name for; 0 is none. Never in the GLSL block.
struct Resource {
    std::uint32_t id = 0;
};

/// Which pixels the sizes of an effect are measured in.
enum class Reach : std::uint32_t {
    Pixels,  ///< those of the picture, whatever its size
    Height,  ///< those of a picture of 1080 lines: the same part of the height at every size
};
/// A size in pixels of a picture of this height.
constexpr double pixels_of(Reach reach, double size, double height) {
    return reach == Reach::Height ? size * height / 1080 : size;
}

enum class Kind : std::uint8_t { Float, Int, Toggle, Choice, Vec2, Vec3, Vec4, Rgb, Curve, Resource };

/// One row, free of templates: what everything derived from it reads.
struct ParamInfo {
    std::string_view name;
    std::string_view doc;
    Unit unit;
    Range range;
    Kind kind = Kind::Float;
    bool is_loop_count = false;                   ///< see field().as_loop_count()
    bool is_amount = false;                       ///< 0 switches the effect off: see field().as_amount()
    bool is_picture = false;                      ///< of Kind::Resource: see field().as_picture()
    bool is_at_compile = false;                   ///< see field().at_compile()
    std::uint32_t switched_word = ~0u;            ///< of a toggle: see field().as_amount_of()
    std::uint32_t reach_word = ~0u;               ///< of a Reach: see field().as_size_of()
    std::uint32_t word = 0;                       ///< offset in the struct, in 4-byte words
    std::uint32_t words = 1;                      ///< size, in 4-byte words
    std::span<const std::string_view> choices{};  ///< names in snake_case, for Kind::Choice
    std::string_view formerly{};                  ///< a former name of the key, still read
    std::string_view also{};                      ///< another name of the console variable: see field().also_named()
    bool is_archived = false;                     ///< the console keeps it in its configuration file
};

/// All rows of one struct, in the order of its members, and the words of its defaults.
struct ParamTable {
    std::string_view struct_name;
    std::span<const ParamInfo> rows;
    std::span<const std::uint32_t> defaults;

    [[nodiscard]] std::size_t words() const { return defaults.size(); }
    [[nodiscard]] const ParamInfo* find(std::string_view name) const {
        for (const ParamInfo& row : rows)
            if (row.name == name || (!row.formerly.empty() && row.formerly == name)) return &row;
        return nullptr;
    }
};

}  // namespace darkroom
