// SPDX-License-Identifier: MIT
#pragma once
// Counts heap allocations of this program: the implementation replaces the global operator new.

#include <cstdint>

namespace darkroom::bench {

/// Allocations that the calling thread has made through operator new since it began.
[[nodiscard]] std::uint64_t allocation_count();

}  // namespace darkroom::bench
