// SPDX-License-Identifier: MIT
#pragma once
// What the public headers cost in every file of a host: the CPU time of compiling a file that includes one, against a
// file with Vulkan's header and the same headers of the standard library.

#include <vector>

#include "bench/rows.hpp"

namespace darkroom::bench {

/// By the compiler that made this program. Nothing where it is not there any more.
[[nodiscard]] Result<std::vector<Figure>> header_figures(std::uint32_t rounds);

}  // namespace darkroom::bench
