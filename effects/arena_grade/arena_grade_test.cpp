// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/arena_grade.hpp>

#include <limits>
#include <random>

#include "arena_grade/arena_grade_reference.hpp"
#include "compose/test_stacks/support.hpp"
#include "develop/developer.hpp"
#include "gpu/test_support.hpp"

namespace darkroom {
namespace {

double graded(double light, ArenaTable preset) {
    return test::reference_of(ArenaGrade{.preset = preset}, test::uniform(1, 1, {light, light, light, 1})).at(0, 0).g;
}

ColorTable random_table() {
    std::mt19937 random(8);
    ColorTable table{.size = arena_edge};
    for (std::uint32_t i = 0; i < arena_edge * arena_edge * arena_edge * 3; ++i)
        table.cube.push_back(static_cast<float>(random() % 256) / 255.0f);
    return table;
}

TEST(EffectArenaGrade, IdentityIsTheGain) {
    for (const double light : {0.01, 0.18, 0.5, 1.0})
        EXPECT_NEAR(graded(light, ArenaTable::Identity), 1.99984 * light, 2e-5) << light;
    EXPECT_NEAR(graded(60000, ArenaTable::Identity), std::pow(1.3703 * (0.99961 + 0.00039 * arena_power(60000)), 2.2),
                1e-9);
    EXPECT_NEAR(graded(1.5, ArenaTable::Identity), 2, 0.01) << "highlights end near 2";
    EXPECT_EQ(graded(-5, ArenaTable::Identity), 0);
}

TEST(EffectArenaGrade, TheDefaultTableIsTheGames) {
    EXPECT_EQ(effect_info(ArenaGrade{}).parameters.defaults[1], static_cast<std::uint32_t>(ArenaTable::Arena));
    for (const auto& [light, expected] : {std::pair{0.01, 0.0152}, {0.18, 0.3712}, {0.5, 1.0722}, {1.0, 1.9998}})
        EXPECT_NEAR(graded(light, ArenaTable::Arena), expected, 5e-5) << light;
    const auto codes = arena_codes(ArenaTable::Arena, nullptr), identity = arena_codes(ArenaTable::Identity, nullptr);
    EXPECT_EQ(codes[3 * 4], 64) << "red of the fifth entry";
    EXPECT_EQ(codes[3 * 4 + 1], 0);
    EXPECT_EQ(codes[3 * 16 * 7 + 1], 121) << "green of the eighth row";
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(identity[i * 3], 17 * i);
}

TEST(EffectArenaGrade, SepiaIsOneTone) {
    const auto codes = arena_codes(ArenaTable::Sepia, nullptr);
    ASSERT_EQ(codes.size(), 3u * 16 * 16 * 16);
    EXPECT_EQ(codes[0], 0);
    for (std::size_t i = 1; i < codes.size() / 3; ++i) {
        EXPECT_GE(codes[i * 3], codes[i * 3 + 1]) << i;
        EXPECT_GE(codes[i * 3 + 1], codes[i * 3 + 2]) << i;
    }
    // Colours of one luma are one colour.
    EXPECT_NEAR(codes[3 * 15 + 2], codes[3 * (16 * 4) + 2], 8);
}

TEST(EffectArenaGrade, GpuTexelCentresAreTheirEntries) {
    const ColorTable table = random_table();
    ReferenceImage picture(256, 16), expected = picture;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const auto light = [&](std::uint32_t step) { return std::pow(step / 15.0, 1 / 0.4545449912548065); };
        picture.pixels[i] = {light(i % 16), light(i / 16 % 16), light(i / 256), 1};
        const auto entry = [&](std::size_t c) {
            const double s = (c == 0 ? i % 16 : c == 1 ? i / 16 % 16 : i / 256) / 15.0;
            return std::pow(((double{table.cube[i * 3 + c]} - s) * 0.99961 + s) * 1.3703, 2.2);
        };
        expected.pixels[i] = {entry(0), entry(1), entry(2), 1};
    }
    const ReferenceImage out = test::develop(
        [&](Composer& composer) { composer.add(ArenaGrade{.table = gpu::test::must(composer.define(table))}); },
        test::round_to_float(picture));
    // Of a code, 1 / 255: single precision and the driver's pow move a coordinate by 1e-5 of a step.
    EXPECT_LE(test::worst_difference(out, expected), 0.1 / 255);
}

TEST(EffectArenaGrade, GpuMatchesReference) {
    for (const ArenaTable preset : {ArenaTable::Arena, ArenaTable::Identity, ArenaTable::Sepia}) {
        ReferenceImage picture = test::random_hdr(43, 29, 3);
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i].a = static_cast<double>(i % 5) / 4;
        picture = test::round_to_float(picture);
        const ArenaGrade values{.preset = preset};
        // Near black the power's slope is steep: 4 units of half precision at 2^-10 are 4e-6.
        test::expect_gpu_matches_reference(values, picture, 4);
    }
}

TEST(EffectArenaGrade, GpuAlphaIsTheMask) {
    ReferenceImage picture = test::uniform(3, 1, {0.3, 0.6, 0.1, 0});
    picture.at(1, 0).a = 0.5;
    picture.at(2, 0).a = 7;
    picture = test::round_to_float(picture);
    const ReferenceImage out = test::develop([](Composer& composer) { composer.add(ArenaGrade{}); }, picture);
    ASSERT_EQ(out.pixels.size(), 3u);
    EXPECT_EQ(out.at(0, 0).g, picture.at(0, 0).g) << "a background is untouched";
    EXPECT_EQ(out.at(0, 0).a, 0) << "and stays transparent";
    EXPECT_NEAR(out.at(1, 0).g, (picture.at(1, 0).g + out.at(2, 0).g) / 2, 1e-6);
    EXPECT_EQ(out.at(1, 0).a, 0.5);
    EXPECT_EQ(out.at(2, 0).a, 1);
}

// The same Composer, at three sizes; then without its table.
TEST(EffectArenaGrade, GpuTheTableSurvivesAResizeAndIsReset) {
    Device& device = gpu::test::device();
    Composer composer(device, {.frames_in_flight = 1});
    const ColorTable sepia = [] {
        ColorTable table{.size = arena_edge};
        for (const std::uint8_t code : arena_codes(ArenaTable::Sepia, nullptr))
            table.cube.push_back(static_cast<float>(code) / 255.0f);
        return table;
    }();
    const Handle entry = composer.add(ArenaGrade{.table = gpu::test::must(composer.define(sepia))});
    Developer developer(device, {.target = DevelopTarget::SceneLinear});
    const auto developed = [&](std::uint32_t width, std::uint32_t height, ArenaTable expected) {
        std::vector<float> color;
        for (std::uint32_t i = 0; i < width * height; ++i) color.insert(color.end(), {0.2f, 0.5f, 0.7f, 1.0f});
        auto out = developer.develop(composer, {.extent = {width, height}, .color = color});
        ASSERT_TRUE(out) << out.error().text;
        const Rgba reference =
            test::reference_of(ArenaGrade{.preset = expected}, test::uniform(1, 1, {0.2, 0.5, 0.7, 1})).at(0, 0);
        const float* const last = out->pixels.data() + (std::size_t{width} * height - 1) * 4;
        EXPECT_NEAR(last[0], reference.r, 2e-3) << width;
        EXPECT_NEAR(last[2], reference.b, 2e-3) << width;
    };
    developed(32, 32, ArenaTable::Sepia);
    developed(101, 37, ArenaTable::Sepia);
    developed(7, 5, ArenaTable::Sepia);
    ASSERT_TRUE(composer.set(entry, "table", 0));
    ASSERT_TRUE(composer.compile({.max_extent = {8, 8}, .color = {VK_FORMAT_R32G32B32A32_SFLOAT}}));
    developed(33, 9, ArenaTable::Arena);
}

TEST(EffectArenaGrade, GpuNumbersThatAreNoneStayWhereTheyAre) {
    const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    ReferenceImage picture = test::uniform(3, 3, {0.18, 0.18, 0.18, 1}), clean = picture;
    picture.at(1, 1) = {nan, infinity, -infinity, nan};
    const auto run = [](const ReferenceImage& image) {
        return test::develop([](Composer& composer) { composer.add(ArenaGrade{}); }, image);
    };
    const ReferenceImage out = run(picture), without = run(clean);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_TRUE(std::isfinite(out.pixels[i].r + out.pixels[i].g + out.pixels[i].b + out.pixels[i].a));
        EXPECT_TRUE(i == 4 || out.pixels[i].g == without.pixels[i].g);
    }
}

}  // namespace
}  // namespace darkroom
