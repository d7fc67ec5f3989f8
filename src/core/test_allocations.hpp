// SPDX-License-Identifier: MIT
#pragma once
// Counts heap allocations, so that a test can say that a function makes none. Only for tests: the implementation
// replaces the global operator new and is linked into the test program alone.

#include <cstdint>

namespace darkroom::test {

/// Allocations that the calling thread has made through operator new since it began.
[[nodiscard]] std::uint64_t allocation_count();

}  // namespace darkroom::test
