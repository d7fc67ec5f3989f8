// SPDX-License-Identifier: MIT
#pragma once
// What a warp grid has at (u, v) in double precision: value(u, v), an array, of the four vertices around, interpolated.

#include <cmath>
#include <cstddef>
#include <darkroom/warp_grid.hpp>

namespace darkroom {

template <class Value>
auto warp_grid_reference(Vec2 grid, double u, double v, const Value& value) {
    const auto [columns, rows] = warp_grid_cells(grid);
    const double left = std::floor(u * columns), top = std::floor(v * rows);
    const double fx = u * columns - left, fy = v * rows - top;
    decltype(value(u, v)) sum{};
    for (int i = 0; i < 4; ++i) {
        const auto corner = value((left + i % 2) / columns, (top + i / 2) / rows);
        const double weight = (i % 2 == 0 ? 1 - fx : fx) * (i / 2 == 0 ? 1 - fy : fy);
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * corner[k];
    }
    return sum;
}

}  // namespace darkroom
