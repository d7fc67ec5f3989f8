// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "gpu/resource/resources.hpp"

namespace darkroom::gpu {

namespace {

// What the null device's counter showed at each mark.
std::vector<std::uint64_t>& shown() {
    static std::vector<std::uint64_t> ticks;
    return ticks;
}

/// One tick is a microsecond; the results are there at once.
void fill_null(Context& context, std::uint32_t valid_bits) {
    context.traits.timestamp_period_ns = 1000;
    context.traits.timestamp_valid_bits = valid_bits;
    context.vk.CreateQueryPool = [](VkDevice, const VkQueryPoolCreateInfo*, const VkAllocationCallbacks*,
                                    VkQueryPool* pool) {
        *pool = reinterpret_cast<VkQueryPool>(std::uintptr_t{1});
        return VK_SUCCESS;
    };
    context.vk.DestroyQueryPool = [](VkDevice, VkQueryPool, const VkAllocationCallbacks*) {};
    context.vk.GetQueryPoolResults = [](VkDevice, VkQueryPool, std::uint32_t first, std::uint32_t count, std::size_t,
                                        void* data, VkDeviceSize, VkQueryResultFlags) {
        if (first + count > shown().size()) return VK_NOT_READY;
        std::copy_n(shown().begin() + first, count, static_cast<std::uint64_t*>(data));
        return VK_SUCCESS;
    };
}

TEST(Timers, AThousandPassesAreTimed) {
    constexpr std::uint32_t marks = 1001;
    Context context;
    fill_null(context, 64);
    Result<Timers> timers = Timers::create(context, 2, marks);
    ASSERT_TRUE(timers) << timers.error().text;
    shown().clear();
    for (std::uint64_t i = 0; i < marks; ++i) shown().push_back(i * i);
    std::vector<double> milliseconds(marks - 1);
    ASSERT_EQ(timers->read(1, marks, milliseconds), marks - 1);
    for (std::size_t i = 0; i < milliseconds.size(); ++i)
        ASSERT_NEAR(milliseconds[i], (2 * static_cast<double>(i) + 1) * 1e-3, 1e-9) << i;
    EXPECT_EQ(timers->read(1, marks, {milliseconds.data(), 7}), 7U) << "no more than there is room for";
    shown().resize(marks - 1);
    EXPECT_EQ(timers->read(1, marks, milliseconds), 0U) << "not finished";
    const Timers moved = std::move(*timers);
    EXPECT_EQ(moved.ticks.size(), marks);
}

// A query that nothing has reset yet may not be read.
TEST(Timers, AreResetBeforeTheyAreReadWhereTheHostCan) {
    static std::pair<std::uint32_t, std::uint32_t> reset;
    reset = {};
    Context context;
    fill_null(context, 64);
    context.vk.ResetQueryPool = [](VkDevice, VkQueryPool, std::uint32_t first, std::uint32_t count) {
        reset = {first, count};
    };
    Result<Timers> later = Timers::create(context, 3, 5);
    ASSERT_TRUE(later) << later.error().text;
    EXPECT_FALSE(later->is_reset);
    EXPECT_EQ(reset.second, 0U) << "the device may lack it";
    context.traits.has_host_query_reset = true;
    Result<Timers> timers = Timers::create(context, 3, 5);
    ASSERT_TRUE(timers) << timers.error().text;
    EXPECT_TRUE(timers->is_reset);
    EXPECT_EQ(reset, (std::pair{0U, 5U})) << "of each of the three";
}

TEST(Timers, ACounterThatGoesRoundDoesNotMakeAPassLong) {
    Context context;
    fill_null(context, 36);
    Result<Timers> timers = Timers::create(context, 1, 3);
    ASSERT_TRUE(timers) << timers.error().text;
    shown() = {(std::uint64_t{1} << 36U) - 250, 750, 1750};
    std::array<double, 2> milliseconds{};
    ASSERT_EQ(timers->read(0, 3, milliseconds), 2U);
    EXPECT_DOUBLE_EQ(milliseconds[0], 1.0);
    EXPECT_DOUBLE_EQ(milliseconds[1], 1.0);
}

// Nothing of the table is there to be called.
TEST(Timers, ADeviceWithoutTimestampsIsNotAsked) {
    Context context;
    context.traits.timestamp_period_ns = 0;
    Result<Timers> timers = Timers::create(context, 2, 3);
    ASSERT_TRUE(timers) << timers.error().text;
    timers->begin(VK_NULL_HANDLE, 1);
    timers->mark(VK_NULL_HANDLE, 1, 2);
    std::array<double, 2> milliseconds{};
    EXPECT_EQ(timers->read(1, 3, milliseconds), 0U);
}

TEST(Timers, ElapsedTicksHonourTheValidBits) {
    EXPECT_EQ(elapsed_ticks(10, 30, 64), 20U);
    EXPECT_EQ(elapsed_ticks(~std::uint64_t{0}, 4, 64), 5U);
    EXPECT_EQ(elapsed_ticks(0xff, 0x01, 8), 2U);
    EXPECT_EQ(elapsed_ticks(0x00, 0xff, 8), 255U);
    EXPECT_EQ(elapsed_ticks(0xfffffff0, 0x10, 32), 32U);
}

}  // namespace

}  // namespace darkroom::gpu
