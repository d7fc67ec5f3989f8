// SPDX-License-Identifier: MIT
#include "scene/walk/walk.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/walk/walk_test_support.hpp"

namespace darkroom::scene {

namespace {

using test::box;
using test::ground_of;

constexpr WalkInput ahead{.move = {0, 1}};  ///< along -z
constexpr WalkInput running{.move = {0, 1}, .is_running = true};

/// For so many seconds at this rate; `look` is called after every frame.
template <class Look>
void go(Walk& walk, const Ground& ground, const WalkInput& input, float seconds, float rate, Look&& look) {
    const auto frames = std::lround(seconds * rate);
    for (long i = 0; i < frames; ++i) {
        advance(walk, ground, input, seconds / static_cast<float>(frames));
        look();
    }
}

void go(Walk& walk, const Ground& ground, const WalkInput& input, float seconds, float rate = 60) {
    go(walk, ground, input, seconds, rate, [] {});
}

}  // namespace

TEST(SceneWalk, StandsWithTheEyeAtEyeHeight) {
    const Ground ground = ground_of({test::floor, box({2, 0, 2}, {4, 1, 4})});
    EXPECT_EQ(stand(ground, {0, 5, 0}).eye(), vec3(0, Walk::eye_height, 0));
    EXPECT_EQ(stand(ground, {3, 5, 3}).eye(), vec3(3, 1 + Walk::eye_height, 3));
    EXPECT_EQ(stand(ground, {0, 0.5F, 0}).eye(), vec3(0, Walk::eye_height, 0)) << "a low camera rises";
}

TEST(SceneWalk, WhereNothingIsThereIsAFloor) {
    const Ground thing = ground_of({box({-1, 2, -1}, {1, 3, 1})});
    Walk walk = stand(thing, {0, 4, 9});
    EXPECT_EQ(walk.feet, vec3(0, 2, 9));
    go(walk, thing, {.move = {1, 0}}, 5);
    EXPECT_NEAR(walk.feet.y, 2, 1e-6F);
    EXPECT_GT(walk.feet.x, 14);
    Walk nowhere = stand({}, {1, 2, 3});
    go(nowhere, {}, ahead, 1);
    EXPECT_NEAR(nowhere.feet.y, 0.3F, 1e-6F);
}

TEST(SceneWalk, WalksAtItsSpeedWhereItLooks) {
    const Ground ground = ground_of({test::floor});
    for (const float yaw : {0.0F, 90.0F, -135.0F}) {
        Walk walk = stand(ground, {0, 2, 0});
        go(walk, ground, {.move = {0, 5}, .yaw = yaw}, 2);
        const vec3 before = walk.feet;
        go(walk, ground, {.move = {0, 5}, .yaw = yaw}, 1);
        const float angle = glm::radians(yaw);
        const vec3 moved = walk.feet - before;
        EXPECT_NEAR(moved.x, -std::sin(angle) * Walk::walking_speed, 1e-3F);
        EXPECT_NEAR(moved.z, -std::cos(angle) * Walk::walking_speed, 1e-3F);
        EXPECT_NEAR(walk.feet.y, 0, 1e-6F);
        EXPECT_TRUE(walk.is_on_ground);
        go(walk, ground, {}, 1);
        EXPECT_NEAR(glm::length(walk.velocity), 0, 1e-4F);
    }
    Walk walk = stand(ground, {0, 2, 0});
    go(walk, ground, {.move = {1, 0}, .is_running = true}, 2);
    EXPECT_NEAR(walk.velocity.x, Walk::running_speed, 1e-4F);
}

TEST(SceneWalk, AJumpRisesByItsFormulaAndComesBack) {
    const Ground ground = ground_of({test::floor});
    Walk walk = stand(ground, {0, 2, 0});
    const float rising = Walk::jump_speed / Walk::gravity;
    advance(walk, ground, {.jumps = true}, rising / 32);
    EXPECT_FALSE(walk.is_on_ground);
    EXPECT_NEAR(walk.velocity.y, Walk::jump_speed * 31 / 32, 1e-4F);
    for (int i = 1; i < 32; ++i) advance(walk, ground, {}, rising / 32);
    EXPECT_NEAR(walk.feet.y, Walk::jump_speed * Walk::jump_speed / (2 * Walk::gravity), 1e-4F);
    EXPECT_NEAR(walk.velocity.y, 0, 1e-4F);
    for (int i = 0; i < 31; ++i) advance(walk, ground, {.jumps = true}, rising / 32);
    EXPECT_FALSE(walk.is_on_ground);
    EXPECT_NEAR(walk.velocity.y, -Walk::jump_speed * 31 / 32, 1e-4F) << "no second jump in the air";
    go(walk, ground, {}, 0.1F);
    EXPECT_TRUE(walk.is_on_ground);
    EXPECT_NEAR(walk.feet.y, 0, 1e-6F);
    EXPECT_EQ(walk.velocity.y, 0);
}

TEST(SceneWalk, ACeilingEndsAJump) {
    const Ground ground = ground_of({test::floor, box({-5, 2.2F, -5}, {5, 2.4F, 5})});
    Walk walk = stand(ground, {0, 2, 0});
    float highest = 0;
    advance(walk, ground, {.jumps = true}, 1.0F / 60);
    go(walk, ground, {}, 1, 60, [&] { highest = std::max(highest, walk.feet.y); });
    EXPECT_NEAR(highest, 2.2F - Walk::body_height, 1e-3F);
    EXPECT_NEAR(walk.feet.y, 0, 1e-6F);
}

TEST(SceneWalk, ClimbsStairsAndGoesDownThem) {
    std::vector<Entity> entities{test::floor};
    for (int i = 0; i < 10; ++i) {
        const auto at = static_cast<float>(i);
        entities.push_back(box({-2, 0, -3.5F - at * 0.5F}, {2, 0.3F * (at + 1), -3 - at * 0.5F}));
    }
    const Ground ground = ground_of(std::move(entities));
    Walk walk = stand(ground, {0, 2, 0});
    float eye = walk.eye().y;
    const auto look = [&] {
        EXPECT_TRUE(walk.is_on_ground);
        EXPECT_LT(std::abs(walk.eye().y - eye), 0.1F) << "the eye is led over steps of 0.3 m";
        eye = walk.eye().y;
    };
    go(walk, ground, ahead, 2.6F, 60, look);
    EXPECT_NEAR(walk.feet.y, 3, 1e-6F);
    go(walk, ground, {.move = {0, -1}}, 2.9F, 60, look);
    EXPECT_NEAR(walk.feet.y, 0, 1e-6F);
    go(walk, ground, running, 1.5F, 4);
    EXPECT_NEAR(walk.feet.y, 3, 1e-6F) << "three steps a frame";
}

TEST(SceneWalk, AHighStepIsAWallThatAJumpClears) {
    const Ground ground = ground_of({test::floor, box({-9, 0, -9}, {9, 0.7F, -3})});
    Walk walk = stand(ground, {0, 2, 0});
    go(walk, ground, ahead, 3);
    EXPECT_NEAR(walk.feet.y, 0, 1e-6F);
    EXPECT_NEAR(walk.feet.z, -3 + Walk::body_radius, 0.01F);
    advance(walk, ground, {.move = {0, 1}, .jumps = true}, 1.0F / 60);
    go(walk, ground, ahead, 1);
    EXPECT_NEAR(walk.feet.y, 0.7F, 1e-6F);
    EXPECT_TRUE(walk.is_on_ground);
}

TEST(SceneWalk, WallsStopAndLeadAlong) {
    // A sheet of 1 cm, run at in frames of a quarter of a second.
    const Ground ground = ground_of({test::floor, box({-40, 0, -3.01F}, {40, 3, -3}), box({4, 0, -9}, {4.01F, 3, 9})});
    for (const float rate : {4.0F, 30.0F, 144.0F}) {
        Walk walk = stand(ground, {0, 2, 0});
        go(walk, ground, running, 3, rate);
        EXPECT_NEAR(walk.feet.z, -3 + Walk::body_radius, 0.01F) << rate;
        EXPECT_NEAR(walk.velocity.z, 0, 0.01F);
        Walk slanted = stand(ground, {0, 2, 0});
        go(slanted, ground, {.move = {0.6F, 0.8F}}, 2, rate);
        EXPECT_NEAR(slanted.feet.z, -3 + Walk::body_radius, 0.01F) << rate;
        EXPECT_NEAR(slanted.feet.x, 0.6F * Walk::walking_speed * (2 - 1.0F / 12), 0.05F) << "as fast along it";
        go(slanted, ground, {.move = {0.6F, 0.8F}, .is_running = true}, 3, rate);
        EXPECT_NEAR(slanted.feet.x, 4 - Walk::body_radius, 0.01F) << "a corner holds";
        EXPECT_NEAR(slanted.feet.z, -3 + Walk::body_radius, 0.01F);
    }
}

TEST(SceneWalk, AWallThatIsPassedAtASmallAngleIsKeptApart) {
    const Ground ground = ground_of({test::floor, box({-40, 0, -1}, {40, 3, -0.9F})});
    for (const float rate : {4.0F, 60.0F, 1000.0F}) {
        Walk walk = stand(ground, {-20, 2, 0});
        go(walk, ground, {.move = {1, 0.04F}, .is_running = true}, 6, rate);
        EXPECT_GT(walk.feet.x, 15);
        EXPECT_NEAR(walk.feet.z, -0.9F + Walk::body_radius, 1e-3F) << rate;
    }
}

TEST(SceneWalk, APostIsMetByTheShouldersToo) {
    const Ground ground = ground_of({test::floor, box({0.2F, 0, -3.1F}, {0.3F, 3, -3})});
    Walk walk = stand(ground, {0, 2, 0});
    go(walk, ground, ahead, 2);
    EXPECT_GT(walk.feet.z, -3);
}

TEST(SceneWalk, GentleSlopesAreGroundAndSteepOnesWalls) {
    for (const float degrees : {30.0F, 70.0F}) {
        Entity ramp = box({-5, -1, -20}, {5, 0, 0});
        ramp.transform.position = {0, 0, -2};
        ramp.transform.rotation = glm::angleAxis(glm::radians(degrees), vec3(1, 0, 0));
        const Ground ground = ground_of({test::floor, ramp});
        Walk walk = stand(ground, {0, 2, 0});
        go(walk, ground, ahead, 3);
        if (degrees < 45) {
            EXPECT_NEAR(walk.feet.y, (-2 - walk.feet.z) * std::tan(glm::radians(degrees)), 1e-3F);
            EXPECT_GT(walk.feet.y, 2);
        } else {
            EXPECT_LT(walk.feet.y, Walk::step_height + 0.1F);
        }
    }
}

TEST(SceneWalk, WhoFallsOutOfTheWorldIsPutBack) {
    const Ground ground = ground_of({box({-2, -1, -2}, {2, 0, 2})});
    Walk walk = stand(ground, {1, 2, 1});
    float lowest = 0;
    bool has_fallen = false;
    go(walk, ground, ahead, 2.5F, 60, [&] {
        lowest = std::min(lowest, walk.feet.y);
        has_fallen = has_fallen || !walk.is_on_ground;
    });
    EXPECT_TRUE(has_fallen);
    EXPECT_LT(lowest, -5);
    go(walk, ground, {}, 3, 60, [&] { lowest = std::min(lowest, walk.feet.y); });
    EXPECT_NEAR(glm::length(walk.feet - vec3(1, 0, 1)), 0, 1e-6F);
    EXPECT_TRUE(walk.is_on_ground);
    EXPECT_GT(lowest, -25);
}

TEST(SceneWalk, AHoleIsFallenInto) {
    const Ground ground =
        ground_of({box({-5, -9, -3}, {5, 0, 5}), box({-5, -9, -5}, {5, -4, -3}), box({-5, -9, -9}, {5, 0, -5})});
    Walk walk = stand(ground, {0, 2, 0});
    go(walk, ground, ahead, 0.9F);
    EXPECT_NEAR(walk.feet.y, 0, 1e-6F);
    go(walk, ground, ahead, 1.4F);
    EXPECT_NEAR(walk.feet.y, -4, 1e-6F);
    EXPECT_TRUE(walk.is_on_ground);
    go(walk, ground, {.move = {0, -1}}, 2);
    EXPECT_NEAR(walk.feet.y, -4, 1e-6F) << "its wall holds";
}

TEST(SceneWalk, TheRateOfFramesDoesNotShow) {
    std::vector<Entity> entities{test::floor, box({-9, 0, -11}, {9, 3, -10.5F})};
    for (int i = 0; i < 6; ++i) {
        const auto at = static_cast<float>(i);
        entities.push_back(box({-9, 0, -6 - at * 0.5F}, {9, 0.2F * (at + 1), -5.5F - at * 0.5F}));
    }
    const Ground ground = ground_of(std::move(entities));
    const auto way = [&](float rate) {
        std::vector<Walk> out;
        Walk walk = stand(ground, {0, 2, 0});
        const auto leg = [&](const WalkInput& input, float seconds) {
            go(walk, ground, input, seconds, rate);
            out.push_back(walk);
        };
        leg(running, 0.5F);
        leg({.move = {0, 1}, .is_running = true, .jumps = true}, 0.5F);
        leg(ahead, 0.5F);             // lands
        leg({.move = {1, 1}}, 0.5F);  // up the stairs, aslant
        leg({.move = {-1, 1}}, 2);    // down from the last, and along the wall
        leg({.move = {-1, 0.2F}, .yaw = 20}, 2);
        return out;
    };
    const std::vector<Walk> expected = way(60);
    for (const float rate : {4.0F, 30.0F, 90.0F, 144.0F, 1000.0F}) {
        const std::vector<Walk> found = way(rate);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_LT(glm::length(found[i].feet - expected[i].feet), 0.01F) << "leg " << i << " at " << rate;
            EXPECT_EQ(found[i].is_on_ground, expected[i].is_on_ground) << "leg " << i << " at " << rate;
        }
    }
}

TEST(SceneWalk, NoTimeIsNoStepAndALongPauseIsNoLeap) {
    const Ground ground = ground_of({test::floor});
    Walk walk = stand(ground, {0, 2, 0});
    const Walk before = walk;
    for (const float seconds : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
        advance(walk, ground, running, seconds);
        EXPECT_EQ(walk.feet, before.feet);
    }
    advance(walk, ground, running, 1e9F);
    EXPECT_LT(glm::length(walk.feet), 0.25F * Walk::running_speed);
}

}  // namespace darkroom::scene
