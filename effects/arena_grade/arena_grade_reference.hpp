// SPDX-License-Identifier: MIT
#pragma once
// Arena grade in double precision, with its published constants, and the entries of its tables.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <darkroom/effects/arena_grade.hpp>
#include <darkroom/reference.hpp>
#include <vector>

#include "shared/finite_reference.hpp"
#include "tables/evaluate.hpp"

namespace darkroom {

inline constexpr std::uint32_t arena_edge = 16;

/// 16^3 triples of code values, red fastest: of a table that is given, its colours at 16 steps, rounded to 8 bits.
[[nodiscard]] std::vector<std::uint8_t> arena_codes(ArenaTable preset, const ColorTable* given);

inline double arena_power(double light) { return std::pow(std::max(light, 0.0), 0.4545449912548065); }

/// By the middles of texels: a coordinate of c * 0.9375 + 0.03125 in a texture of 16.
inline TableColor arena_lookup(const std::vector<std::uint8_t>& codes, const TableColor& color) {
    ColorTable table{.size = arena_edge};
    for (const std::uint8_t code : codes) table.cube.push_back(static_cast<float>(code) / 255.0f);
    TableColor place{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double texel = (color[i] * 0.9375 + 0.03125) * arena_edge - 0.5;
        place[i] = texel / (arena_edge - 1);
    }
    return evaluate(table, place, TableInterpolation::Trilinear);
}

inline ReferenceImage arena_grade_reference(const void* parameters, const ReferenceInput& input) {
    const ArenaGrade& values = *static_cast<const ArenaGrade*>(parameters);
    const auto codes = arena_codes(values.preset, find_resource<ColorTable>(input.resources, values.table));
    ReferenceImage out = *input.picture;
    for (Rgba& color : out.pixels) {
        const TableColor light{finite_reference(color.r), finite_reference(color.g), finite_reference(color.b)};
        TableColor srgb{};
        for (std::size_t i = 0; i < 3; ++i) srgb[i] = arena_power(light[i]);
        const TableColor found = arena_lookup(codes, srgb);
        const double alpha = std::clamp(finite_reference(color.a), 0.0, 1.0);
        std::array<double, 3> graded{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double mixed = ((found[i] - srgb[i]) * 0.99961 + srgb[i]) * 1.3703;
            graded[i] = light[i] + (std::pow(mixed, 2.2) - light[i]) * alpha;
        }
        color = {graded[0], graded[1], graded[2], alpha};
    }
    return out;
}

}  // namespace darkroom
