// SPDX-License-Identifier: MIT
#pragma once
// The measure of tests of tables.

#include <cmath>

#include "tables/evaluate.hpp"

namespace darkroom::test {

/// Of the channel that is furthest apart.
inline double distance(const TableColor& a, const TableColor& b) {
    double out = 0;
    for (std::size_t i = 0; i < 3; ++i) out = std::max(out, std::abs(a[i] - b[i]));
    return out;
}

}  // namespace darkroom::test
