// SPDX-License-Identifier: MIT
#include "core/test_allocations.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

namespace {

thread_local std::uint64_t count = 0;

void* allocate(std::size_t size, std::size_t alignment) {
    ++count;
    const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
    void* memory = alignment <= alignof(std::max_align_t) ? std::malloc(size == 0 ? 1 : size)
                                                          : std::aligned_alloc(alignment, rounded);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

}  // namespace

// The forms for arrays and the non-throwing ones call these.
void* operator new(std::size_t size) { return allocate(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace darkroom::test {

std::uint64_t allocation_count() { return count; }

TEST(TestAllocations, AreCounted) {
    const std::uint64_t before = allocation_count();
    const std::vector<int> numbers(100);
    EXPECT_EQ(allocation_count(), before + 1);
    EXPECT_EQ(numbers.size(), 100u);
}

TEST(TestAllocations, CountAlignedOnes) {
    struct alignas(64) Wide {
        int value = 7;
    };
    const std::uint64_t before = allocation_count();
    const auto wide = std::make_unique<Wide>();
    EXPECT_EQ(allocation_count(), before + 1);
    EXPECT_EQ(wide->value, 7);
}

}  // namespace darkroom::test
