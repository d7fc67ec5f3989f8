// SPDX-License-Identifier: MIT
#include "panels/show/timings.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace darkroom::panels {
namespace {

void add(TimingHistory& history, std::uint64_t frame, const std::vector<PassTime>& passes, double record = 50) {
    history.add({.frame_index = frame, .passes = passes}, record);
}

TEST(PanelTimingHistory, KeepsTheLastFramesInOrder) {
    TimingHistory history;
    for (std::uint64_t frame = 0; frame < 1000; ++frame)
        add(history, frame, {{"bloom", static_cast<double>(frame)}, {"tail", 1}}, static_cast<double>(frame));
    ASSERT_EQ(history.frames().size(), TimingHistory::max_frames);
    EXPECT_EQ(history.frames().front().frame_index, 760U);
    EXPECT_EQ(history.frames().back().frame_index, 999U);
    EXPECT_EQ(history.frames().back().milliseconds, 1000);
    EXPECT_EQ(history.frames().back().record_microseconds, 999);
    EXPECT_EQ(history.name(history.frames().back().passes[1].name), "tail");
    EXPECT_EQ(history.name_count(), 2U);
}

TEST(PanelTimingHistory, TakesARecordingOnce) {
    TimingHistory history;
    for (int i = 0; i < 3; ++i) add(history, 7, {{"bloom", 1}});
    add(history, 8, {});
    EXPECT_EQ(history.frames().size(), 1U);
    // A Composer that was made anew counts from the start.
    add(history, 0, {{"bloom", 1}});
    EXPECT_EQ(history.frames().size(), 2U);
}

TEST(PanelTimingHistory, MediansAndWorstAreThoseOfTheFramesKept) {
    TimingHistory history;
    add(history, 0, {{"a", 100}}, 3);
    for (std::uint64_t frame = 1; frame <= TimingHistory::max_frames; ++frame)
        add(history, frame,
            {{"a", static_cast<double>(frame % 3 + 1)}, {frame % 2 == 0 ? "b" : "c", static_cast<double>(frame % 4)}},
            10);
    EXPECT_EQ(history.of_pass(0).median, 2);
    EXPECT_EQ(history.of_pass(0).worst, 3);
    EXPECT_EQ(history.of_recording().worst, 10);
    const std::uint32_t b = history.frames().back().passes[1].name;
    EXPECT_EQ(history.name(b), "b");
    EXPECT_EQ(history.of_pass(b).worst, 2);
    EXPECT_EQ(history.of_frames().worst, 6);
    EXPECT_EQ(TimingHistory().of_frames().worst, 0);
}

TEST(PanelTimingHistory, NumbersThatAreNoneCountAsNothing) {
    TimingHistory history;
    add(history, 0, {{"a", std::numeric_limits<double>::quiet_NaN()}, {"b", 2}},
        std::numeric_limits<double>::infinity());
    EXPECT_EQ(history.frames().back().milliseconds, 2);
    EXPECT_EQ(history.frames().back().record_microseconds, 0);
}

TEST(PanelTimingHistory, AFewSlowFramesScaleNothing) {
    TimingHistory history;
    EXPECT_EQ(history.max_shown(), 0);
    for (std::uint64_t frame = 0; frame < 100; ++frame) add(history, frame, {{"a", 2}});
    EXPECT_NEAR(history.max_shown(), 2.1, 1e-6);
    for (std::uint64_t frame = 100; frame < 105; ++frame) add(history, frame, {{"a", 400}});
    EXPECT_NEAR(history.max_shown(), 3, 1e-6);
    for (std::uint64_t frame = 200; frame < 240; ++frame) add(history, frame, {{"a", 400}});
    EXPECT_NEAR(history.max_shown(), 420, 1e-3) << "many are no spike";
}

TEST(PanelTimingHistory, StaysSmallWhateverPassesAreCalled) {
    TimingHistory history;
    std::vector<std::string> names;
    for (std::uint64_t frame = 0; frame < 2000; ++frame) {
        names = {fmt::format("pass {}", frame), fmt::format("other {}", frame)};
        add(history, frame, {{names[0], 1}, {names[1], 2}});
        ASSERT_LE(history.name_count(), std::max(2 * TimingHistory::max_passes, 2 * TimingHistory::max_frames + 2));
        const TimingHistory::Frame& first = history.frames().front();
        ASSERT_EQ(history.name(first.passes[1].name), fmt::format("other {}", first.frame_index));
    }
    const std::vector<PassTime> many(1000, {"a", 1});
    add(history, 5000, many);
    EXPECT_EQ(history.frames().back().passes.size(), TimingHistory::max_passes);
    EXPECT_EQ(history.frames().back().milliseconds, 1000);
}

}  // namespace
}  // namespace darkroom::panels
