// SPDX-License-Identifier: MIT
#pragma once
// The first record of a fresh process whose kernels were baked: the documented look in tests/baked/baked_host.cpp,
// which is linked without the compiler of GLSL. Counted is what comes beyond the driver's own pipelines.

#include <vector>

#include "bench/rows.hpp"

namespace darkroom::bench {

[[nodiscard]] Result<std::vector<Figure>> baked_figures(std::uint32_t rounds);

}  // namespace darkroom::bench
