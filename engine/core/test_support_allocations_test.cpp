// SPDX-License-Identifier: MIT
#include "core/test_support_allocations.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <vector>

namespace darkroom::test {

namespace {

/// As if somebody read it: a compiler may leave out an allocation that nobody reads.
void use(const void* memory) {
    [[maybe_unused]] static const void* volatile used = nullptr;
    used = memory;
}

}  // namespace

TEST(TestAllocations, AreCounted) {
    if (!counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    const std::uint64_t before = allocation_count(), bytes_before = allocated_bytes();
    const std::vector<int> numbers(100);
    use(numbers.data());
    EXPECT_EQ(allocation_count(), before + 1);
    EXPECT_EQ(allocated_bytes(), bytes_before + 100 * sizeof(int));
    EXPECT_EQ(numbers.size(), 100u);
}

TEST(TestAllocations, CountAlignedOnes) {
    if (!counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    struct alignas(64) Wide {
        int value = 7;
    };
    const std::uint64_t before = allocation_count();
    const auto wide = std::make_unique<Wide>();
    use(wide.get());
    EXPECT_EQ(allocation_count(), before + 1);
    EXPECT_EQ(wide->value, 7);
}

TEST(TestAllocations, LiveBytesComeAndGo) {
    if (!counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    const std::int64_t before = live_bytes();
    auto numbers = std::make_unique<std::vector<int>>(1000);
    use(numbers->data());
    EXPECT_GE(live_bytes() - before, std::int64_t{1000} * 4);
    EXPECT_EQ(numbers->size(), 1000u);
    numbers.reset();
    EXPECT_EQ(live_bytes(), before);
}

TEST(TestAllocations, ThatAreSparedDoNotFail) {
    if (!counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    const FailingAllocation failing(0);
    {
        const SparedAllocations spared;
        const std::vector<int> numbers(100);
        use(numbers.data());
    }
    EXPECT_FALSE(failing.has_failed());
    EXPECT_THROW(use(std::vector<int>(100).data()), std::bad_alloc);
    EXPECT_TRUE(failing.has_failed());
}

}  // namespace darkroom::test
