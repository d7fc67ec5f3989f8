// SPDX-License-Identifier: MIT
#pragma once
// Counts heap allocations, so that a test or benchmark can say that a function makes none, and lets one fail. The
// implementation replaces the global operator new and is linked into those programs alone.

#include <cstdint>

namespace darkroom::test {

/// Allocations that the calling thread has made through operator new since it began.
[[nodiscard]] std::uint64_t allocation_count();
/// And how much they asked for, together.
[[nodiscard]] std::uint64_t allocated_bytes();
/// Bytes that the calling thread holds: what it got less what it gave back, both without what was spared.
[[nodiscard]] std::int64_t live_bytes();
/// False under AddressSanitizer: the counts then stay 0.
[[nodiscard]] bool counts_allocations();

/// While it lives, one allocation of the calling thread throws std::bad_alloc: the first one that comes after `others`.
/// One at a time.
class FailingAllocation {
  public:
    explicit FailingAllocation(std::uint64_t others);
    FailingAllocation(const FailingAllocation&) = delete;
    FailingAllocation& operator=(const FailingAllocation&) = delete;
    ~FailingAllocation();
    [[nodiscard]] bool has_failed() const;
};

/// While it lives, allocations of the calling thread are neither counted nor fail: a driver's, which would not take it.
class SparedAllocations {
  public:
    SparedAllocations();
    SparedAllocations(const SparedAllocations&) = delete;
    SparedAllocations& operator=(const SparedAllocations&) = delete;
    ~SparedAllocations();
};

}  // namespace darkroom::test
