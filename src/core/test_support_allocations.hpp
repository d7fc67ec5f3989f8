// SPDX-License-Identifier: MIT
#pragma once
// Counts heap allocations, so that a test or benchmark can say that a function makes none. The implementation replaces
// the global operator new and is linked into those programs alone.

#include <cstdint>

namespace darkroom::test {

/// Allocations that the calling thread has made through operator new since it began.
[[nodiscard]] std::uint64_t allocation_count();
/// False under AddressSanitizer: the count then stays 0.
[[nodiscard]] bool counts_allocations();

}  // namespace darkroom::test
