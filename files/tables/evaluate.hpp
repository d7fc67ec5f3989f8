// SPDX-License-Identifier: MIT
#pragma once
// What a colour table says of a colour, in double precision. Header only, because the references of effects read
// tables, too, and link nothing of this folder.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <darkroom/resource.hpp>
#include <span>

namespace darkroom {

/// How a 3D table is read between its entries.
enum class TableInterpolation : std::uint32_t { Tetrahedral, Trilinear };

using TableColor = std::array<double, 3>;

namespace table_detail {

/// A place among `count` entries: two neighbours, and how far it is from the first of them. NaN is the first entry.
struct Place {
    std::array<std::size_t, 2> entries{};
    double fraction = 0;
};

inline Place place_of(double value, double min, double max, std::uint32_t count) {
    const double at = (value - min) / (max - min) * (count - 1.0);
    const double inside = at > 0 ? std::min(at, count - 1.0) : 0.0;
    const auto index = static_cast<std::size_t>(inside);
    return {{index, std::min(index + 1, std::size_t{count} - 1)}, inside - static_cast<double>(index)};
}

class Cube {
  public:
    Cube(const ColorTable& table, const TableColor& color) : table_(table) {
        for (std::size_t i = 0; i < 3; ++i)
            places_[i] = place_of(color[i], double{table.min[i]}, double{table.max[i]}, table.size);
    }

    /// Kasson, Nin, Plouffe and Hafner, "Performing color space conversions with three-dimensional linear
    /// interpolation", 1995: the cell is six tetrahedra about its grey diagonal, and the colour's place says which.
    [[nodiscard]] TableColor tetrahedral() const {
        std::array<std::size_t, 3> axes{0, 1, 2};
        std::ranges::stable_sort(axes, [&](std::size_t a, std::size_t b) { return fraction(a) > fraction(b); });
        std::array<std::size_t, 3> corner{};
        TableColor out{};
        add(out, corner, 1 - fraction(axes[0]));
        for (std::size_t i = 0; i < 3; ++i) {
            corner[axes[i]] = 1;
            add(out, corner, fraction(axes[i]) - (i < 2 ? fraction(axes[i + 1]) : 0.0));
        }
        return out;
    }

    [[nodiscard]] TableColor trilinear() const {
        TableColor out{};
        for (std::size_t number = 0; number < 8; ++number) {
            const std::array<std::size_t, 3> corner{number & 1, number >> 1 & 1, number >> 2};
            double weight = 1;
            for (std::size_t i = 0; i < 3; ++i) weight *= corner[i] == 1 ? fraction(i) : 1 - fraction(i);
            add(out, corner, weight);
        }
        return out;
    }

  private:
    [[nodiscard]] double fraction(std::size_t axis) const { return places_[axis].fraction; }
    void add(TableColor& out, const std::array<std::size_t, 3>& corner, double weight) const {
        const std::size_t r = places_[0].entries[corner[0]], g = places_[1].entries[corner[1]],
                          b = places_[2].entries[corner[2]];
        const float* const entry = &table_.cube[((b * table_.size + g) * table_.size + r) * 3];
        for (std::size_t i = 0; i < 3; ++i) out[i] += weight * double{entry[i]};
    }

    const ColorTable& table_;
    std::array<Place, 3> places_;
};

}  // namespace table_detail

/// `color` clamped to the shaper's inputs and shaped, then clamped to the cube's and looked up. A table of neither
/// changes nothing.
[[nodiscard]] inline TableColor evaluate(const ColorTable& table, TableColor color,
                                         TableInterpolation interpolation = TableInterpolation::Tetrahedral) {
    for (std::size_t i = 0; table.shaper_size > 0 && i < 3; ++i) {
        const auto [entries, fraction] = table_detail::place_of(color[i], double{table.shaper_min[i]},
                                                                double{table.shaper_max[i]}, table.shaper_size);
        const double low{table.shaper[entries[0] * 3 + i]}, high{table.shaper[entries[1] * 3 + i]};
        color[i] = low * (1 - fraction) + high * fraction;
    }
    if (table.size == 0) return color;
    const table_detail::Cube cube(table, color);
    return interpolation == TableInterpolation::Tetrahedral ? cube.tetrahedral() : cube.trilinear();
}

}  // namespace darkroom
