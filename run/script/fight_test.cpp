// SPDX-License-Identifier: MIT
// The controllers that ship, over a scripted fight, against the reference's arithmetic.
#include <algorithm>
#include <array>
#include <cmath>

#include "script/test_controllers.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

using test::ControllersBed;

const std::string folder = std::string(test::source_folder) + "/controllers/";

/// What the game is like at a time.
struct Moment {
    double health = 100;
    bool face_pain = false, fire_flash = false, has_quad = false, intermission = false, is_hud_visible = true;
};
bool is_within(double time, double from, double to) { return time >= from && time < to; }

// Hits, one before the last has faded; shots; quad that ends in a hit; low health that heals; a menu; a death in the
// middle of a hit, and back before it would have faded, quad running out meanwhile; an intermission.
Moment fight(double time) {
    Moment now;
    now.face_pain = is_within(time, 0.5, 0.6) || is_within(time, 0.75, 0.95) || is_within(time, 3.1, 3.15) ||
                    is_within(time, 5.9, 6.05) || is_within(time, 8.0, 8.1);
    now.fire_flash = is_within(time, 0.55, 0.85) || is_within(time, 1.5, 1.55) || is_within(time, 1.6, 1.65);
    now.has_quad = is_within(time, 2, 3.2) || is_within(time, 5.5, 6.05);
    now.health = is_within(time, 4, 5)     ? 40 - 38 * (time - 4)
                 : is_within(time, 6, 6.1) ? -5
                 : is_within(time, 5, 6)   ? 12
                                           : 90;
    now.is_hud_visible = !is_within(time, 1.2, 1.4);
    now.intermission = time >= 8.05;
    return now;
}

/// The reference's controller, in double precision.
class Reference {
  public:
    struct Values {
        double warp, chroma, echo;
    };
    Values step(const Moment& game, double time) {
        Values out{base.warp, base.chroma, game.is_hud_visible ? base.echo : 0};
        if (game.intermission || game.health <= 0) {
            hit = shot = never;
            return out;
        }
        if (game.face_pain && !before.face_pain) hit = time;
        if (game.fire_flash && !before.fire_flash) shot = time;
        if (before.has_quad && !game.has_quad) quad_end = time;
        before = game;
        const auto decay = [&](double start, double duration) {
            return std::clamp(1 - (time - start) / duration, 0.0, 1.0);
        };
        out.warp += -0.15 * decay(hit, 0.4) + (game.health < 25 ? -0.1 * (1 - game.health / 25) : 0);
        out.chroma += 0.012 * decay(hit, 0.4) + 0.003 * decay(shot, 0.15);
        out.chroma += game.has_quad ? 0.004 * (std::sin(6 * time) + 1) / 2 : 0.004 * decay(quad_end, 0.4);
        return out;
    }
    static constexpr Values base{-0.15, 0.005, 0.1};

  private:
    static constexpr double never = -1e9;
    double hit = never, shot = never, quad_end = never;
    Moment before;
};

void tell(GameTable& game, const Moment& now) {
    game = {{"health", now.health},
            {"face_pain", now.face_pain},
            {"fire_flash", now.fire_flash},
            {"has_quad", now.has_quad},
            {"intermission", now.intermission}};
}

struct Combat : ControllersBed {
    Combat() {
        const auto loaded = controllers->load(folder + "combat.lua");
        EXPECT_TRUE(loaded) << loaded.error().text;
    }
    void step(double time) {
        const Moment moment = fight(time);
        tell(game, moment);
        frame(time, moment.is_hud_visible);
    }
};

// What is written has six decimals.
TEST(ControllersCombat, CurvesAreTheReferencesAtEveryFrameRate) {
    for (const int rate : {30, 60, 144}) {
        SCOPED_TRACE(rate);
        Combat bed;
        Reference reference;
        Reference::Values lowest{1, 1, 1}, highest{-1, -1, -1};
        for (int i = 0; i < 9 * rate; ++i) {
            const double time = i / static_cast<double>(rate);
            bed.step(time);
            const Reference::Values expected = reference.step(fight(time), time);
            ASSERT_NEAR(bed.now("warp"), expected.warp, 6e-7) << time;
            ASSERT_NEAR(bed.now("chroma"), expected.chroma, 6e-7) << time;
            ASSERT_NEAR(bed.now("echo"), expected.echo, 6e-7) << time;
            lowest = {std::min(lowest.warp, expected.warp), std::min(lowest.chroma, expected.chroma),
                      std::min(lowest.echo, expected.echo)};
            highest = {std::max(highest.warp, expected.warp), std::max(highest.chroma, expected.chroma),
                       std::max(highest.echo, expected.echo)};
        }
        EXPECT_LT(lowest.warp, -0.29) << "the fight bends it";
        EXPECT_GT(highest.chroma, 0.015);
        EXPECT_EQ(lowest.echo, 0);
        EXPECT_TRUE(bed.said.empty()) << bed.said.front();
    }
}

TEST(ControllersCombat, WithoutNewsNothingIsWritten) {
    Combat bed;
    for (int i = 0; i < 20; ++i) bed.frame(i / 60.0);
    EXPECT_EQ(bed.controllers->writes(), 0u) << "a game at rest, even an empty one";
    EXPECT_TRUE(bed.said.empty()) << bed.said.front();
    bed.step(0.5);
    EXPECT_EQ(bed.controllers->writes(), 2u) << "a hit";
    tell(bed.game, {});
    for (int i = 0; i < 60; ++i) bed.frame(1 + i / 60.0);
    const std::uint64_t after = bed.controllers->writes();
    for (int i = 0; i < 200; ++i) bed.frame(2 + i / 60.0);
    EXPECT_EQ(bed.controllers->writes(), after);
    EXPECT_EQ(bed.now("warp"), -0.15f);
}

TEST(ControllersCombat, TheConsoleIsHeardAtOnce) {
    Combat bed;
    bed.step(0.5);
    bed.run("r_ui_warp 0.2; r_ui_chromatic 0.01; r_ui_echo 0.3");
    bed.frame(0.6);
    EXPECT_NEAR(bed.now("warp"), 0.2 - 0.15 * 0.75, 6e-7) << "over the new value";
    tell(bed.game, {});
    bed.frame(2);
    EXPECT_NEAR(bed.now("warp"), 0.2, 6e-7);
    EXPECT_NEAR(bed.now("chroma"), 0.01, 6e-7);
    EXPECT_NEAR(bed.now("echo"), 0.3, 6e-7);
}

TEST(ControllersCombat, ReloadInTheMiddleOfAHitDisturbsNothing) {
    Combat bed;
    bed.step(0.5);
    bed.step(0.55);
    ASSERT_LT(bed.now("warp"), -0.2f);
    bed.controllers->restart();
    tell(bed.game, {});
    bed.frame(0.6);
    EXPECT_EQ(bed.now("warp"), -0.15f);
    EXPECT_EQ(bed.console->get("r_ui_warp"), "-0.15");
}

TEST(ControllersCombat, AClockThatJumpsAndAStackWithoutTheEffectsAreNoTrouble) {
    Combat bed;
    bed.step(8.0);
    bed.frame(-5);
    tell(bed.game, {});
    bed.frame(1);
    EXPECT_EQ(bed.now("warp"), -0.15f) << "before the hit";
    bed.composer.clear();
    for (int i = 0; i < 60; ++i) {
        tell(bed.game, fight(0.5 + i / 60.0));
        bed.frame(20 + i / 60.0);
    }
    EXPECT_TRUE(bed.said.empty()) << bed.said.front();
}

TEST(ControllersVisor, EchoesByContextAndWritesChangesAlone) {
    ControllersBed bed;
    bed.run("r_ui_echo 0; r_ui_echo_scale 1");
    ASSERT_TRUE(bed.controllers->load(folder + "visor.lua"));
    bed.frame(0, true);
    EXPECT_EQ(bed.controllers->writes(), 2u);
    EXPECT_EQ(bed.now("echo"), 0.1f);
    EXPECT_EQ(bed.now("echo", 1), 1.01f);
    for (int i = 1; i < 100; ++i) bed.frame(i / 60.0, true);
    EXPECT_EQ(bed.controllers->writes(), 2u);
    for (int i = 0; i < 100; ++i) bed.frame(2 + i / 60.0, false);
    EXPECT_EQ(bed.now("echo"), 0.2f) << "behind a menu";
    EXPECT_EQ(bed.controllers->writes(), 3u);
    bed.frame(4, true);
    EXPECT_EQ(bed.now("echo"), 0.1f);
    EXPECT_EQ(bed.controllers->writes(), 4u);
    EXPECT_EQ(bed.console->get("r_ui_echo"), "0") << "the base stays";
    bed.controllers.reset();
    EXPECT_EQ(bed.now("echo"), 0.0f) << "nothing is left of it";
}

}  // namespace
}  // namespace darkroom
