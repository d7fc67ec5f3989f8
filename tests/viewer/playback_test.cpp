// SPDX-License-Identifier: MIT
// Which frame of a sequence is shown while it plays, is stepped through and loops.
#include "viewer/playback.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace app {
namespace {

std::vector<std::size_t> numbers(Playback& playback, int count, double seconds) {
    std::vector<std::size_t> out;
    for (int i = 0; i < count; ++i) {
        out.push_back(playback.number());
        playback.advance(seconds);
    }
    return out;
}
using Numbers = std::vector<std::size_t>;

TEST(Playback, ShowsEveryFrameOnceAndBeginsAnew) {
    Playback playback(3, 24);
    EXPECT_EQ(numbers(playback, 8, 1.0 / 24), (Numbers{0, 1, 2, 0, 1, 2, 0, 1}));
    Playback slow(2, 12);
    EXPECT_EQ(numbers(slow, 6, 1.0 / 24), (Numbers{0, 0, 1, 1, 0, 0}));
    Playback fast(5, 48);
    EXPECT_EQ(numbers(fast, 4, 1.0 / 24), (Numbers{0, 2, 4, 1}));
}

TEST(Playback, StaysOnTheBeatForLong) {
    Playback playback(24, 24);
    for (int i = 0; i < 24 * 600; ++i) {
        ASSERT_EQ(playback.number(), static_cast<std::size_t>(i % 24));
        playback.advance(1.0 / 24);
    }
}

TEST(Playback, PlaysBetweenItsEndsAndStopsWithoutALoop) {
    Playback playback(10, 24);
    playback.seek(3);
    playback.begin_here();
    playback.seek(5);
    playback.end_here();
    playback.seek(3);
    EXPECT_EQ(numbers(playback, 5, 1.0 / 24), (Numbers{3, 4, 5, 3, 4}));
    playback.set_looping(false);
    EXPECT_TRUE(playback.advance(0));
    EXPECT_FALSE(playback.advance(1));
    EXPECT_EQ(playback.number(), 5U);
    EXPECT_TRUE(playback.is_at_end());
    playback.play_all();
    EXPECT_FALSE(playback.is_at_end());
    EXPECT_EQ(playback.last(), 9U);
}

TEST(Playback, StepsAreWholeFrames) {
    Playback playback(4, 24);
    playback.advance(0.5 / 24);
    playback.step(1);
    EXPECT_EQ(playback.number(), 1U);
    playback.advance(0.6 / 24);
    EXPECT_EQ(playback.number(), 1U) << "a step begins a frame";
    playback.step(-2);
    EXPECT_EQ(playback.number(), 3U);
    playback.step(5);
    EXPECT_EQ(playback.number(), 0U);
}

TEST(Playback, AnEndBeforeTheBeginningTakesItAlong) {
    Playback playback(10, 24);
    playback.seek(6);
    playback.begin_here();
    playback.seek(2);
    playback.end_here();
    EXPECT_EQ(playback.first(), 2U);
    EXPECT_EQ(playback.last(), 2U);
    EXPECT_EQ(numbers(playback, 3, 1), (Numbers{2, 2, 2}));
}

TEST(Playback, AnotherRateKeepsTheFrame) {
    Playback playback(100, 24);
    playback.advance(1);
    const std::size_t before = playback.number();
    playback.set_rate(60);
    EXPECT_EQ(playback.number(), before);
    playback.set_rate(0);
    EXPECT_GT(playback.rate(), 0);
}

TEST(Playback, OfNothingItStandsStill) {
    Playback playback;
    EXPECT_TRUE(playback.advance(5));
    playback.step(3);
    EXPECT_EQ(playback.number(), 0U);
}

}  // namespace
}  // namespace app
