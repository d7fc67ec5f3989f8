// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/hud_inertia.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace darkroom {
namespace {

// From rest with velocity `push`: x(t) = push t exp(-rate t).
double exact(double push, double rate, double seconds) { return push * seconds * std::exp(-rate * seconds); }
double exact_velocity(double push, double rate, double seconds) {
    return push * (1 - rate * seconds) * std::exp(-rate * seconds);
}

bool moves_visibly(double position, double velocity) { return std::abs(position) > 1e-4 || std::abs(velocity) > 1e-3; }

HudInertia standing(double yaw = 0) {
    HudInertia inertia;
    inertia.step(0.01, yaw, true, 0);
    return inertia;
}

// The reference puts what is nearly at rest to rest; until then the curve is the exact one, to the rounding of a float.
TEST(HudInertia, IsTheExactSolutionAtEveryFrameRate) {
    for (const double rate : {10.0, 17.0, 24.0, 30.0, 59.94, 60.0, 72.0, 144.0, 250.0, 333.3, 1000.0}) {
        SCOPED_TRACE(rate);
        HudInertia jump = standing(), turn = standing();
        bool moves = true;
        for (int frame = 1; frame <= rate; ++frame) {
            const double t = frame / rate;
            const double y = exact(-0.2, 18, t), x = exact(-0.18, 14, t);
            const Vec2 jumped = jump.step(1 / rate, 0, false, 200), turned = turn.step(1 / rate, 90, true, 0);
            if (moves_visibly(y, exact_velocity(-0.2, 18, t))) {
                EXPECT_NEAR(jumped.y, y, 1e-6) << t;
            }
            if (moves_visibly(x, exact_velocity(-0.18, 14, t))) {
                EXPECT_NEAR(turned.x, x, 1e-6) << t;
            }
            EXPECT_EQ(jumped.x, 0);
            EXPECT_EQ(turned.y, 0);
            moves = jumped.y != 0 || turned.x != 0;
        }
        EXPECT_FALSE(moves) << "after a second it rests";
    }
}

// -0.004088 after 55.6 ms and -0.004730 after 71.4 ms. Sampled within half a frame of 144 Hz of that, a parabola of
// curvature rate^2 misses by at most (18 * 0.0035)^2 / 2, 0.2 %.
TEST(HudInertia, PeaksAreThoseOfTheReference) {
    for (const double rate : {144.0, 250.0, 1000.0}) {
        SCOPED_TRACE(rate);
        HudInertia jump = standing(), turn = standing();
        Vec2 lowest{}, when{};
        for (int frame = 1; frame <= rate; ++frame) {
            const float y = jump.step(1 / rate, 0, false, 1).y, x = turn.step(1 / rate, 90, true, 0).x;
            if (y < lowest.y) when.y = static_cast<float>(frame / rate);
            if (x < lowest.x) when.x = static_cast<float>(frame / rate);
            lowest = {std::min(lowest.x, x), std::min(lowest.y, y)};
        }
        EXPECT_NEAR(lowest.y, -0.004088, 9e-6);
        EXPECT_NEAR(lowest.x, -0.004730, 9e-6);
        EXPECT_NEAR(when.y, 0.0556, 0.51 / rate);
        EXPECT_NEAR(when.x, 0.0714, 0.51 / rate);
    }
}

TEST(HudInertia, PushesAddUpAndAJumpStartsAnew) {
    HudInertia inertia = standing();
    inertia.step(0.02, 30, true, 0);
    const double x = exact(-0.06, 14, 0.02), velocity = exact_velocity(-0.06, 14, 0.02) - 0.002 * 20;
    const double slope = velocity + 14 * x;
    EXPECT_NEAR(inertia.step(0.03, 50, true, 0).x, (x + slope * 0.03) * std::exp(-14 * 0.03), 1e-9);

    // The push of a jump replaces what was left of the last one.
    HudInertia jumper = standing();
    jumper.step(0.02, 0, false, 5);
    jumper.step(0.001, 0, true, 0);
    const double before = jumper.offset().y;
    EXPECT_NEAR(jumper.step(0.01, 0, false, 5).y, (before + (-0.2 + 18 * before) * 0.01) * std::exp(-0.18), 1e-8);
}

// Of many pushes, one in every other frame, every step is the sum of what each of them alone has become by then.
TEST(HudInertia, EveryStepIsTheSumOfAllPushesBefore) {
    for (const double rate : {10.0, 24.0, 60.0, 144.0, 1000.0}) {
        HudInertia inertia = standing();
        std::vector<std::pair<double, double>> pushes;  // when, and by how much
        double yaw = 0;
        for (int frame = 0; frame < 200; ++frame) {
            if (frame % 2 == 0) {
                const double degrees = (frame % 4 == 0 ? 1 : -1) * (30.0 + frame * 37 % 60);
                yaw += degrees;
                pushes.emplace_back(frame / rate, -0.002 * degrees);
            }
            const Vec2 offset = inertia.step(1 / rate, yaw, true, 0);
            double expected = 0;
            for (const auto& [when, push] : pushes) expected += exact(push, 14, (frame + 1) / rate - when);
            ASSERT_NEAR(offset.x, expected, 1e-6) << rate << ", frame " << frame;
        }
    }
}

TEST(HudInertia, OnlyLeavingTheGroundUpwardIsAJump) {
    HudInertia inertia = standing();
    EXPECT_EQ(inertia.step(0.01, 0, true, 300).y, 0) << "still on the ground";
    EXPECT_EQ(inertia.step(0.01, 0, false, -1).y, 0) << "falling off an edge";
    EXPECT_EQ(inertia.step(0.01, 0, false, 300).y, 0) << "thrown while in the air";
    HudInertia fresh;
    EXPECT_EQ(fresh.step(0.01, 0, false, 300).y, 0) << "the first frame";
}

TEST(HudInertia, TheFirstFrameAndAResetDoNotKick) {
    HudInertia inertia;
    EXPECT_EQ(inertia.step(0.01, 170, true, 0).x, 0);
    inertia.step(0.01, 90, false, 300);
    EXPECT_NE(inertia.offset().x, 0);
    EXPECT_NE(inertia.offset().y, 0);
    inertia.reset();
    EXPECT_EQ(inertia.offset().x, 0);
    const Vec2 after = inertia.step(0.01, -45, false, 300);
    EXPECT_EQ(after.x, 0);
    EXPECT_EQ(after.y, 0);
}

TEST(HudInertia, YawTurnsTheShorterWayRound) {
    for (const auto& [from, to, degrees] : {std::array{350.0, 10.0, 20.0},
                                            {-170.0, 170.0, -20.0},
                                            {10.0, 350.0, -20.0},
                                            {3590.0, -3590.0, 20.0},
                                            {0.0, 725.0, 5.0}}) {
        HudInertia inertia = standing(from);
        EXPECT_NEAR(inertia.step(0.05, to, true, 0).x, exact(-0.002 * degrees, 14, 0.05), 1e-9) << from << " " << to;
    }
}

TEST(HudInertia, LongFramesAreShortenedAndThoseWithoutTimeWait) {
    HudInertia slow = standing(), longest = standing();
    EXPECT_EQ(slow.step(5, 90, false, 1).x, longest.step(0.1, 90, false, 1).x);
    EXPECT_EQ(slow.offset().y, longest.offset().y);

    // What happens in a frame without time is seen by the next one.
    HudInertia paused = standing(), running = standing();
    for (const double nothing : {0.0, -1.0, std::nan("")}) EXPECT_EQ(paused.step(nothing, 90, false, 1).x, 0);
    EXPECT_EQ(paused.step(0.02, 90, false, 1).x, running.step(0.02, 90, false, 1).x);
    EXPECT_EQ(paused.offset().y, running.offset().y);
    EXPECT_NE(running.offset().y, 0);
}

TEST(HudInertia, WhatIsNearlyAtRestRests) {
    for (const double rate : {24.0, 60.0, 1000.0}) {
        SCOPED_TRACE(rate);
        HudInertia inertia = standing();
        inertia.step(1 / rate, 5, true, 0);
        EXPECT_NE(inertia.offset().x, 0);
        for (int frame = 0; frame < rate; ++frame) inertia.step(1 / rate, 5, true, 0);
        EXPECT_EQ(inertia.offset().x, 0);
    }
    // What is slight is not at rest at once: 0.4 degrees push by 0.0008 a second.
    HudInertia inertia = standing();
    EXPECT_NEAR(inertia.step(0.005, 0.4, true, 0).x, exact(-0.0008, 14, 0.005), 1e-9);
    for (double at = 0.01; at < 0.095; at += 0.005)
        EXPECT_NEAR(inertia.step(0.005, 0.4, true, 0).x, exact(-0.0008, 14, at), 1e-9) << at;
    for (int frame = 0; frame < 3; ++frame) inertia.step(0.005, 0.4, true, 0);
    EXPECT_EQ(inertia.offset().x, 0);
}

// Turning by r degrees a second is a force of turn_push r, and the offset goes to that over rate^2. A frame's turn
// pushes at its start: half a frame early, and off the integral by (rate dt)^2 / 12.
TEST(HudInertia, TurningWithoutEndIsTheSameAtEveryFrameRate) {
    for (const double degrees : {1.0, 60.0, 360.0})
        for (const double rate : {24.0, 30.0, 60.0, 120.0, 144.0, 240.0, 500.0, 1000.0}) {
            SCOPED_TRACE(testing::Message() << degrees << " degrees a second, frames a second: " << rate);
            HudInertia inertia = standing();
            const double limit = -0.002 * degrees / (14 * 14);
            for (int frame = 1; frame <= rate; ++frame) {
                const Vec2 offset = inertia.step(1 / rate, degrees * frame / rate, true, 0);
                const double t = 14 * (frame + 0.5) / rate;
                const double error = std::pow(14 / rate, 2) / 6;
                EXPECT_NEAR(offset.x, limit * (1 - (1 + t) * std::exp(-t)), std::abs(limit) * (error + 1e-4)) << frame;
            }
        }
}

TEST(HudInertia, NumbersThatAreNotFiniteAreUnknown) {
    constexpr double infinity = std::numeric_limits<double>::infinity(), huge = std::numeric_limits<double>::max();
    HudInertia inertia = standing(40);
    for (const double yaw : {std::nan(""), infinity, -infinity}) EXPECT_EQ(inertia.step(0.01, yaw, true, yaw).x, 0);
    EXPECT_NEAR(inertia.step(0.01, 50, true, 0).x, exact(-0.02, 14, 0.01), 1e-9) << "the yaw before still counts";
    inertia.step(infinity, 60, true, 0);
    for (const double yaw : {huge, -huge, huge}) inertia.step(0.01, yaw, false, huge);
    EXPECT_TRUE(std::isfinite(inertia.offset().x) && std::isfinite(inertia.offset().y));
}

}  // namespace
}  // namespace darkroom
