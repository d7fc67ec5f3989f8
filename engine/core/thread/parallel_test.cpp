// SPDX-License-Identifier: MIT
#include "core/thread/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <new>
#include <set>
#include <system_error>
#include <vector>

namespace darkroom {

namespace {

std::jthread no_thread(const std::function<void()>&) {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
}

TEST(CoreParallel, VisitsEachIndexOnce) {
    for (const std::size_t threads : {0U, 1U, 2U, 7U}) {
        std::vector<std::atomic<int>> visits(1000);
        parallel_for(visits.size(), threads, [&](std::size_t i) { ++visits[i]; });
        for (const std::atomic<int>& visit : visits) ASSERT_EQ(visit, 1) << threads;
    }
    parallel_for(0, 4, [](std::size_t) { FAIL(); });
}

TEST(CoreParallel, TheCallerAloneDoesAllWhereNoThreadCanBeStarted) {
    std::vector<std::thread::id> workers(100);
    parallel_for(
        workers.size(), 8, [&](std::size_t i) { workers[i] = std::this_thread::get_id(); }, no_thread);
    for (const std::thread::id worker : workers) EXPECT_EQ(worker, std::this_thread::get_id());
    EXPECT_FALSE(start_thread([] {}, no_thread));
}

TEST(CoreParallel, ThreadsThatCouldBeStartedAreUsedAndWaitedFor) {
    int started = 0;
    std::atomic<int> done{0};
    const auto two_threads = [&](const std::function<void()>& run) {
        if (started == 2) return no_thread(run);
        ++started;
        return std::jthread(run);
    };
    parallel_for(
        64, 8, [&](std::size_t) { ++done; }, two_threads);
    EXPECT_EQ(started, 2);
    EXPECT_EQ(done, 64);
}

TEST(CoreParallel, NeverMoreThreadsThanAllowedOrItems) {
    int started = 0;
    const auto counted = [&](const std::function<void()>& run) {
        ++started;
        return std::jthread(run);
    };
    parallel_for(
        100, 3, [](std::size_t) {}, counted);
    EXPECT_EQ(started, 2) << "the caller is the third";
    started = 0;
    parallel_for(
        2, 16, [](std::size_t) {}, counted);
    EXPECT_EQ(started, 1);
}

TEST(CoreParallel, TheFirstExceptionReachesTheCallerAndEndsTheWork) {
    for (const std::size_t threads : {1U, 4U}) {
        std::atomic<std::size_t> begun{0}, ended{0};
        const auto work = [&](std::size_t i) {
            ++begun;
            // All that are beside it are at work when it throws.
            while (begun < threads) std::this_thread::yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            ++ended;
            if (i == 1) throw std::bad_alloc();
        };
        EXPECT_THROW(parallel_for(100'000, threads, work), std::bad_alloc) << threads;
        EXPECT_LT(begun, 1000U);
        EXPECT_EQ(begun, ended) << "all threads have ended";
    }
}

}  // namespace

}  // namespace darkroom
