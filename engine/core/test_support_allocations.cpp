// SPDX-License-Identifier: MIT
#ifndef _WIN32
#include <malloc.h>
#endif

#include <cstddef>
#include <cstdlib>
#include <new>

#include "core/test_support_allocations.hpp"

namespace {

constexpr std::uint64_t never = ~std::uint64_t{0};
thread_local std::uint64_t count = 0, bytes = 0;
thread_local std::uint64_t failing = never;  ///< the value of `count` with which an allocation fails
thread_local std::int64_t live = 0;
thread_local int spared = 0;  ///< how many SparedAllocations there are

}  // namespace

// AddressSanitizer brings its own operator new, and forms of it that do not call this one. On Windows so does the DLL
// of the C++ library.
#if !defined(__SANITIZE_ADDRESS__) && !defined(_WIN32)
namespace {

void* allocate(std::size_t size, std::size_t alignment) {
    if (spared == 0) {
        if (count++ == failing) throw std::bad_alloc();
        bytes += size;
    }
    const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
    void* memory = alignment <= alignof(std::max_align_t) ? std::malloc(size == 0 ? 1 : size)
                                                          : std::aligned_alloc(alignment, rounded);
    if (memory == nullptr) throw std::bad_alloc();
    if (spared == 0) live += static_cast<std::int64_t>(::malloc_usable_size(memory));
    return memory;
}

void release(void* memory) {
    if (spared == 0) live -= static_cast<std::int64_t>(::malloc_usable_size(memory));
    std::free(memory);
}

}  // namespace

// The forms for arrays and the non-throwing ones call these.
void* operator new(std::size_t size) { return allocate(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

bool darkroom::test::counts_allocations() { return true; }
#else
bool darkroom::test::counts_allocations() { return false; }
#endif

std::uint64_t darkroom::test::allocation_count() { return count; }
std::uint64_t darkroom::test::allocated_bytes() { return bytes; }
std::int64_t darkroom::test::live_bytes() { return live; }

darkroom::test::FailingAllocation::FailingAllocation(std::uint64_t others) { failing = count + others; }
darkroom::test::FailingAllocation::~FailingAllocation() { failing = never; }
bool darkroom::test::FailingAllocation::has_failed() const { return count > failing; }

darkroom::test::SparedAllocations::SparedAllocations() { ++spared; }
darkroom::test::SparedAllocations::~SparedAllocations() { --spared; }
