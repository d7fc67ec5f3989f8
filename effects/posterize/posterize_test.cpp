// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <darkroom/effects/posterize.hpp>
#include <limits>
#include <set>

#include "compose/test_stacks/support.hpp"
#include "posterize/posterize_reference.hpp"

namespace darkroom {
namespace {

double luma(const Rgba& color) { return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b; }

TEST(EffectPosterize, HasAsManyLevelsAsItSays) {
    for (const std::int32_t levels : {2, 5, 256}) {
        std::set<double> seen;
        double worst = 0;
        for (int i = 0; i <= 10000; ++i) {
            const double value = i / 10000.0;
            const Rgba out = posterize_reference({value, 0, 0, 1}, {}, {.levels = levels});
            seen.insert(out.r);
            worst = std::max(worst, std::abs(out.r - value));
        }
        EXPECT_EQ(seen.size(), static_cast<std::size_t>(levels));
        EXPECT_EQ(*seen.begin(), 0.0);
        EXPECT_EQ(*seen.rbegin(), 1.0);
        // Nothing moves by more than half a step, and a second time by nothing.
        EXPECT_NEAR(worst, 0.5 / (levels - 1), 2e-4);
        for (const double level : seen)
            EXPECT_NEAR(posterize_reference({level, 0, 0, 1}, {}, {.levels = levels}).r, level, 1e-12);
    }
}

TEST(EffectPosterize, LumaKeepsTheHue) {
    const Posterize parameters{.levels = 4, .mode = PosterizeMode::Luma};
    std::set<long> seen;
    for (const Rgba& color : test::random_display(40, 40, 3).pixels) {
        const Rgba out = posterize_reference(color, {}, parameters);
        seen.insert(std::lround(luma(out) * 1e6));
        EXPECT_NEAR(out.r * color.g, out.g * color.r, 1e-12);
        EXPECT_NEAR(out.b * color.g, out.g * color.b, 1e-12);
    }
    EXPECT_EQ(seen, (std::set<long>{0, 333333, 666667, 1000000}));
}

// As many levels as codes leave every code.
TEST(EffectPosterize, GpuLeavesTheCodesOfEightBits) {
    ReferenceImage picture(256, 1);
    for (std::uint32_t x = 0; x < 256; ++x) picture.at(x, 0) = {x / 255.0, 1 - x / 255.0, x / 255.0, 0.5};
    const ReferenceImage out =
        test::develop([](Composer& composer) { composer.add(Posterize{.levels = 256}); }, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::uint32_t x = 0; x < 256; ++x) {
        EXPECT_NEAR(out.at(x, 0).r, x / 255.0, 1e-6);
        EXPECT_NEAR(out.at(x, 0).g, 1 - x / 255.0, 1e-6);
    }
}

TEST(EffectPosterize, GpuMatchesReference) {
    // Beyond 1, too: to the left some negative values, to the right up to 3.
    for (const auto& [width, height] : {std::pair{67u, 41u}, {1u, 1u}, {1u, 7u}}) {
        ReferenceImage picture = test::random_display(width, height, 1);
        for (Rgba& color : picture.pixels) color = {color.r * 3.2 - 0.2, color.g * 3.2 - 0.2, color.b * 3.2 - 0.2, 1};
        picture = test::round_to_float(picture);
        for (const PosterizeMode mode : {PosterizeMode::Channel, PosterizeMode::Luma})
            for (const std::int32_t levels : {2, 7, 40}) {
                SCOPED_TRACE(levels);
                test::expect_gpu_matches_reference(Posterize{.levels = levels, .mode = mode}, picture);
            }
    }
}

TEST(EffectPosterize, GpuNanIsBlackAndInfinityFinite) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture(2, 1, {nan, nan, nan, 1});
    picture.at(1, 0) = {infinity, 1, -infinity, 1};
    for (const PosterizeMode mode : {PosterizeMode::Channel, PosterizeMode::Luma}) {
        const ReferenceImage out =
            test::develop([&](Composer& composer) { composer.add(Posterize{.mode = mode}); }, picture);
        EXPECT_EQ(out.at(0, 0).r + out.at(0, 0).g + out.at(0, 0).b, 0.0);
        EXPECT_TRUE(std::isfinite(out.at(1, 0).r) && std::isfinite(out.at(1, 0).b));
    }
}

}  // namespace
}  // namespace darkroom
