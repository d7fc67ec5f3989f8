// SPDX-License-Identifier: MIT
#include "core/thread/pipeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <numeric>
#include <system_error>
#include <vector>

namespace darkroom {
namespace {

void work_a_little(std::size_t seed) { std::this_thread::sleep_for(std::chrono::microseconds(seed * 7919 % 1500)); }

/// What happened to the items, and the properties that must hold whatever the threads do.
struct Recorder {
    std::mutex mutex;
    std::vector<std::size_t> begun, finished, encoded, reported;
    std::vector<std::string> errors;
    std::size_t alive = 0, max_alive = 0, in_flight = 0, max_in_flight = 0;
    std::thread::id caller = std::this_thread::get_id();
    std::function<Result<>(char stage, std::size_t item)> fails = [](char, std::size_t) { return Result<>(); };

    PipelineTimes run(PipelineDesc desc) {
        const auto locked = [this](const auto& change) {
            const std::lock_guard lock(mutex);
            change();
        };
        return run_pipeline(desc, {.decode =
                                       [&](std::size_t i) {
                                           locked([&] { max_alive = std::max(max_alive, ++alive); });
                                           work_a_little(i);
                                           return fails('d', i);
                                       },
                                   .begin =
                                       [&](std::size_t i) {
                                           EXPECT_EQ(std::this_thread::get_id(), caller);
                                           begun.push_back(i);
                                           max_in_flight = std::max(max_in_flight, ++in_flight);
                                           return fails('b', i);
                                       },
                                   .finish =
                                       [&](std::size_t i) {
                                           EXPECT_EQ(std::this_thread::get_id(), caller);
                                           --in_flight;
                                           finished.push_back(i);
                                           return fails('f', i);
                                       },
                                   .encode =
                                       [&](std::size_t i) {
                                           work_a_little(i + 3);
                                           locked([&] { encoded.push_back(i); });
                                           return fails('e', i);
                                       },
                                   .is_done =
                                       [&](std::size_t i, const Result<>& result) {
                                           locked([&] {
                                               --alive;
                                               reported.push_back(i);
                                               if (!result) errors.push_back(result.error().text);
                                           });
                                       }});
    }
};

std::vector<std::size_t> up_to(std::size_t count) {
    std::vector<std::size_t> out(count);
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
}

TEST(Pipeline, TakesEveryItemThroughAllStagesInOrderWithinItsWindow) {
    for (const std::size_t jobs : {1, 2, 5})
        for (const std::size_t in_flight : {1, 2}) {
            Recorder recorder;
            const PipelineDesc desc{.count = 40, .jobs = jobs, .in_flight = in_flight};
            const PipelineTimes times = recorder.run(desc);
            EXPECT_EQ(recorder.begun, up_to(40));
            EXPECT_EQ(recorder.finished, up_to(40));
            EXPECT_EQ(recorder.reported, up_to(40));
            std::ranges::sort(recorder.encoded);
            EXPECT_EQ(recorder.encoded, up_to(40));
            EXPECT_LE(recorder.max_in_flight, in_flight);
            EXPECT_LE(recorder.max_alive, 40u);
            EXPECT_GT(times.decode, 0);
            EXPECT_GT(times.encode, 0);
            EXPECT_GE(times.wall, times.wait_for_decode);
        }
}

TEST(Pipeline, DecodesNoFurtherAheadThanItsWindow) {
    Recorder recorder;
    const PipelineDesc desc{.count = 60, .jobs = 3, .in_flight = 1};
    std::atomic<std::size_t> done{0}, decoded{0}, farthest{0};
    run_pipeline(desc, {.decode = [&](std::size_t) -> Result<> {
                            farthest = std::max<std::size_t>(farthest, ++decoded - done);
                            return {};
                        },
                        .begin = [](std::size_t) -> Result<> { return {}; },
                        .finish = [](std::size_t) -> Result<> {
                            std::this_thread::sleep_for(std::chrono::milliseconds(1));
                            return {};
                        },
                        .encode = [](std::size_t) -> Result<> { return {}; },
                        .is_done = [&](std::size_t, const Result<>&) { ++done; }});
    EXPECT_LE(farthest, desc.window());
    EXPECT_GT(farthest, 1u) << "decodes ahead";
}

// Who is told of an item may take long, as a slow pipe does: those behind it are encoded meanwhile, within the window.
TEST(Pipeline, OthersGoOnWhileOneIsTold) {
    const PipelineDesc desc{.count = 40, .jobs = 2, .in_flight = 1};
    std::mutex mutex;
    std::condition_variable changed;
    std::size_t encoded = 0, decoded = 0, told = 0, max_ahead = 0;
    const auto nothing = [](std::size_t) { return Result<>(); };
    run_pipeline(desc, {.decode =
                            [&](std::size_t) {
                                const std::lock_guard lock(mutex);
                                max_ahead = std::max(max_ahead, ++decoded - told);
                                return Result<>();
                            },
                        .begin = nothing,
                        .finish = nothing,
                        .encode =
                            [&](std::size_t) {
                                const std::lock_guard lock(mutex);
                                ++encoded;
                                changed.notify_all();
                                return Result<>();
                            },
                        .is_done =
                            [&](std::size_t item, const Result<>&) {
                                std::unique_lock lock(mutex);
                                const auto is_full = [&] { return encoded == desc.window(); };
                                if (item == 0) {
                                    EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(20), is_full))
                                        << encoded << " encoded while the first was told";
                                }
                                EXPECT_EQ(told++, item);
                            }});
    EXPECT_EQ(told, desc.count);
    EXPECT_LE(max_ahead, desc.window());
}

TEST(Pipeline, EndsAtTheFirstFailureAndDoesWhatComesBefore) {
    for (const char stage : {'d', 'b', 'f', 'e'}) {
        Recorder recorder;
        recorder.fails = [stage](char at, std::size_t item) -> Result<> {
            if (at == stage && item >= 11) return user_error("item " + std::to_string(item));
            return {};
        };
        recorder.run({.count = 50, .jobs = 4, .in_flight = 2});
        EXPECT_EQ(recorder.reported, up_to(12)) << stage;
        EXPECT_EQ(recorder.errors, std::vector<std::string>{"item 11"}) << stage;
        EXPECT_LT(recorder.begun.size(), 30u) << stage;
    }
}

TEST(Pipeline, KeepsGoingWhereAsked) {
    for (const char stage : {'d', 'b', 'f', 'e'}) {
        Recorder recorder;
        recorder.fails = [stage](char at, std::size_t item) -> Result<> {
            if (at == stage && item % 10 == 3) return user_error(std::to_string(item));
            return {};
        };
        recorder.run({.count = 30, .jobs = 3, .in_flight = 2, .keeps_going = true});
        EXPECT_EQ(recorder.reported, up_to(30)) << stage;
        EXPECT_EQ(recorder.errors, (std::vector<std::string>{"3", "13", "23"})) << stage;
    }
}

TEST(Pipeline, ExceptionsAreFailures) {
    Recorder recorder;
    recorder.fails = [](char at, std::size_t item) -> Result<> {
        if (at == 'd' && item == 2) throw std::bad_alloc();
        return {};
    };
    recorder.run({.count = 5, .jobs = 2});
    EXPECT_EQ(recorder.errors, std::vector<std::string>{"out of memory"});
}

TEST(Pipeline, WorksWithoutAnyFurtherThread) {
    Recorder recorder;
    recorder.run({.count = 9, .jobs = 2, .in_flight = 2, .start = [](const std::function<void()>&) -> std::jthread {
                      throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
                  }});
    EXPECT_EQ(recorder.reported, up_to(9));
}

}  // namespace
}  // namespace darkroom
