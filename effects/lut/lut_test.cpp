// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/encode.hpp>
#include <darkroom/effects/lut.hpp>
#include <darkroom/effects/tonemap.hpp>

#include <array>
#include <limits>
#include <random>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "lut/lut_reference.hpp"

namespace darkroom {
namespace {

constexpr std::array all_spaces{
    LutSpace::Display, LutSpace::SceneLinear, LutSpace::Acescct, LutSpace::Logc3,
    LutSpace::Slog3,   LutSpace::Logc4,       LutSpace::Vlog,    LutSpace::DavinciIntermediate,
    LutSpace::Linear};
constexpr std::array both{LutInterpolation::Tetrahedral, LutInterpolation::Trilinear};

/// A cube whose entries are `make` of their places in [0, 1].
template <class Make>
ColorTable cube_of(std::uint32_t size, Make make) {
    ColorTable table{.size = size};
    for (std::uint32_t b = 0; b < size; ++b)
        for (std::uint32_t g = 0; g < size; ++g)
            for (std::uint32_t r = 0; r < size; ++r)
                for (const double value : make(r / (size - 1.0), g / (size - 1.0), b / (size - 1.0)))
                    table.cube.push_back(static_cast<float>(value));
    return table;
}
ColorTable identity(std::uint32_t size) {
    return cube_of(size, [](double r, double g, double b) { return TableColor{r, g, b}; });
}
/// Nothing is where it was, and no channel by itself.
ColorTable mixed(std::uint32_t size) {
    return cube_of(size, [](double r, double g, double b) {
        return TableColor{0.1 + 0.8 * g * g, 0.5 * b + 0.4 * r * g, 1 - 0.6 * r - 0.3 * b * b};
    });
}
/// The same with a shaper of another curve for each channel, and inputs of their own on both sides of it.
ColorTable shaped(std::uint32_t size, std::uint32_t entries) {
    ColorTable table = mixed(size);
    table.min = {-0.5, 0, 0.25};
    table.max = {1.5, 2, 1};
    table.shaper_size = entries;
    table.shaper_min = {0, 0.1f, -0.1f};
    table.shaper_max = {1, 0.9f, 1.1f};
    for (std::uint32_t i = 0; i < entries; ++i) {
        const double t = i / (entries - 1.0);
        for (const double value : {2 * t * t - 0.5, 2 * std::sqrt(t), 0.25 + 0.75 * t})
            table.shaper.push_back(static_cast<float>(value));
    }
    return table;
}
/// A curve alone.
ColorTable curve_of(std::uint32_t entries) {
    ColorTable table = shaped(2, entries);
    table.size = 0;
    table.cube.clear();
    for (float& value : table.shaper) value = (value + 0.5f) / 2.5f;
    return table;
}

ReferenceImage on_gpu(Lut values, const ColorTable& table, const ReferenceImage& picture,
                      const ColorTable* other = nullptr, const test::RunOptions& options = {}) {
    return test::develop(
        [&](Composer& composer) {
            values.lut = gpu::test::must(composer.define(table));
            if (other != nullptr) values.fade_to = gpu::test::must(composer.define(*other));
            composer.add(values);
        },
        picture, options);
}
ReferenceImage by_reference(Lut values, const ColorTable& table, const ReferenceImage& picture,
                            const ColorTable* other = nullptr) {
    Resources resources{{1, std::make_shared<ResourceData>(table)}};
    if (other != nullptr) resources[2] = std::make_shared<ResourceData>(*other);
    values.lut = {1};
    values.fade_to = {2};
    return effect_info(values).reference(&values, {.picture = &picture, .resources = &resources});
}

/// Largest difference as code values of the space that the tables gave: what 10 bits of it would show.
double worst_code(const ReferenceImage& a, const ReferenceImage& b, LutSpace space) {
    if (a.pixels.size() != b.pixels.size()) return 1e9;
    double worst = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgba &p = a.pixels[i], &q = b.pixels[i];
        const TableColor x = lut_encode_reference({p.r, p.g, p.b}, space),
                         y = lut_encode_reference({q.r, q.g, q.b}, space);
        if (!std::isfinite(p.r + p.g + p.b) || p.a != q.a) return 1e9;
        for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(x[c] - y[c]) * 1023);
    }
    return worst;
}

TEST(EffectLut, CurvesHaveTheirPublishedValues) {
    using lut_detail::encode;
    EXPECT_NEAR(encode(0.18, LutSpace::Acescct), 0.4135884, 1e-7);
    EXPECT_NEAR(encode(0, LutSpace::Acescct), 0.0729055, 1e-7);
    EXPECT_NEAR(encode(0.18, LutSpace::Logc3), 400.0 / 1023, 1e-4) << "code 400 of 10 bits";
    EXPECT_NEAR(encode(0, LutSpace::Logc3), 95.0 / 1023, 1e-4) << "code 95";
    EXPECT_NEAR(encode(0.18, LutSpace::Slog3), 420.0 / 1023, 1e-12);
    EXPECT_NEAR(encode(0, LutSpace::Slog3), 95.0 / 1023, 1e-12);
    EXPECT_NEAR(encode(0.9, LutSpace::Slog3), 598.0 / 1023, 5e-4) << "code 598: 90 % reflection";
    EXPECT_NEAR(encode(0.18, LutSpace::Logc4), 0.2783958, 1e-7);
    EXPECT_NEAR(encode(469.8, LutSpace::Logc4), 1, 1e-12) << "the brightest of a camera";
    EXPECT_NEAR(encode(0.18, LutSpace::Vlog), 433.0 / 1023, 5e-4) << "code 433 of 10 bits";
    EXPECT_NEAR(encode(0, LutSpace::Vlog), 128.0 / 1023, 5e-4) << "code 128";
    EXPECT_NEAR(encode(0.18, LutSpace::DavinciIntermediate), 0.336043, 1e-6);
    EXPECT_NEAR(encode(100, LutSpace::DavinciIntermediate), 1, 1e-7);
    EXPECT_NEAR(encode(0.18, LutSpace::SceneLinear), 10 / 16.5, 1e-12);
    EXPECT_EQ(encode(0, LutSpace::SceneLinear), 0);
    for (const LutSpace space : all_spaces)
        for (double light = 0.0002; light < 1; light *= 1.3)
            EXPECT_NEAR(lut_detail::decode(encode(light, space), space), light, 1e-6 * light) << light;
    // Dark light has no place among the stops, but in the curves with a toe it may be below black.
    for (const LutSpace space : {LutSpace::Acescct, LutSpace::Logc3, LutSpace::Slog3, LutSpace::Logc4, LutSpace::Vlog,
                                 LutSpace::DavinciIntermediate})
        EXPECT_NEAR(lut_detail::decode(encode(-0.01, space), space), -0.01, 1e-9);
}

TEST(EffectLut, PrimariesAreThePublishedMatrices) {
    // OpenColorIO's configurations for ACES: linear Rec. 709 to ACEScg, with the adaptation of Bradford.
    const ColorMatrix found = conversion({}, lut_detail::ap1).value();
    const ColorMatrix expected{0.6130974024, 0.3395231462, 0.0473794514,  //
                               0.0701937225, 0.9163538791, 0.0134523985,  //
                               0.0206155929, 0.1095697729, 0.8698146342};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-7) << i;
    // White stays white, whatever the primaries.
    for (const LutSpace space : all_spaces) {
        const TableColor white = lut_encode_reference({0.5, 0.5, 0.5}, space);
        EXPECT_NEAR(white[0], white[1], 1e-12);
        EXPECT_NEAR(white[0], white[2], 1e-12);
    }
}

TEST(EffectLut, WithoutATableOrStrengthItIsOff) {
    const Lut none, with{.lut = {1}}, weak{.lut = {1}, .strength = 0};
    EXPECT_TRUE(effect_info(none).is_identity(&none));
    EXPECT_TRUE(effect_info(weak).is_identity(&weak));
    EXPECT_FALSE(effect_info(with).is_identity(&with));
    const ReferenceImage picture = test::round_to_float(test::random_hdr(16, 16, 5));
    EXPECT_EQ(test::worst_difference(test::develop([](Composer& composer) { composer.add(Lut{}); }, picture), picture),
              0);
}

TEST(EffectLut, StandsBetweenTonemapAndEncodeInBothOrders) {
    const FlatPlace lut = effect_info(Lut{}).flat, before = effect_info(Tonemap{}).flat,
                    behind = effect_info(Encode{}).flat;
    EXPECT_TRUE(before.documented < lut.documented && lut.documented < behind.documented);
    EXPECT_TRUE(before.scene_linear < lut.scene_linear && lut.scene_linear < behind.scene_linear);
    EXPECT_FALSE(lut.starts_on);
}

TEST(EffectLut, DomainsFollowWhatTheTableGives) {
    const auto made = [](Lut values, Domain before) {
        return effect_info(values).makes({.domain = before}, &values).domain;
    };
    EXPECT_EQ(made({}, Domain::DisplayLinear), Domain::DisplayLinear);
    EXPECT_EQ(made({}, Domain::SceneLinear), Domain::DisplayLinear);
    EXPECT_EQ(made({.space = LutSpace::Acescct}, Domain::SceneLinear), Domain::SceneLinear);
    EXPECT_EQ(made({.space = LutSpace::Logc3, .result = LutResult::Display}, Domain::SceneLinear),
              Domain::DisplayLinear);
}

// A logarithm of what a tone curve has brought into [0, 1] uses a corner of its table.
TEST(EffectLut, LogarithmsAreOfTheScenesLight) {
    const auto is_remarked = [](LutSpace space, bool has_curve) {
        Composer composer(Device::assumed());
        if (has_curve) composer.add(Tonemap{});
        composer.add(Lut{.space = space});
        const auto plan = composer.plan({.max_extent = {64, 64}});
        EXPECT_TRUE(plan) << plan.error().text;
        return plan && std::ranges::find(plan->misplaced,
                                         "lut expects a picture that is scene_linear; this one is "
                                         "display_linear.") != plan->misplaced.end();
    };
    for (const LutSpace space : std::span(all_spaces).subspan(1)) {
        EXPECT_TRUE(is_remarked(space, true)) << static_cast<int>(space);
        EXPECT_FALSE(is_remarked(space, false)) << static_cast<int>(space);
    }
    EXPECT_FALSE(is_remarked(LutSpace::Display, true));
}

TEST(EffectLut, GpuIdentityIsThePictureWithinACode) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 1));
    for (const std::uint32_t size : {2u, 17u, 33u}) {
        for (const auto how : both) {
            const ReferenceImage out = on_gpu({.interpolation = how}, identity(size), picture);
            EXPECT_LE(worst_code(out, picture, LutSpace::Display), 0.08) << size << ": a fiftieth of a code of 8 bits";
        }
    }
    // Above the least light that each space can say.
    ReferenceImage light(64, 4);
    for (std::uint32_t x = 0; x < 64; ++x)
        for (std::uint32_t y = 0; y < 4; ++y)
            light.at(x, y) = {0.001 * std::exp2(x / 8.0), 0.4 * y + 0.001, 0.0005 * x + 0.001, 0.5};
    light = test::round_to_float(light);
    for (const LutSpace space : std::span(all_spaces).subspan(1)) {
        ColorTable table = identity(33);
        // Light itself has no curve that brings more than 1 into the table's inputs.
        if (space == LutSpace::Linear)
            for (std::size_t i = 0; i < 3; ++i) table.max[i] = 2;
        for (float& value : table.cube) value *= table.max[0];
        EXPECT_LE(worst_code(on_gpu({.space = space}, table, light), light, space), 0.1);
    }
}

// A table that is read half an entry aside would be off by hundreds of codes here.
TEST(EffectLut, GpuTexelCentresAreTheirEntries) {
    for (const std::uint32_t size : {4u, 18u}) {
        std::mt19937 random(size);
        std::uniform_real_distribution<double> unit(0, 1);
        ColorTable table = identity(size);
        for (float& value : table.cube) value = static_cast<float>(unit(random));
        ReferenceImage picture(size * size, size), expected = picture;
        for (std::uint32_t i = 0; i < size * size * size; ++i) {
            const std::array<std::uint32_t, 3> place{i % size, i / size % size, i / size / size};
            const auto light = [&](std::size_t c) { return srgb_decoded(place[c] / (size - 1.0)); };
            picture.pixels[i] = {light(0), light(1), light(2), 1};
            const auto entry = [&](std::size_t c) { return srgb_decoded(double{table.cube[std::size_t{i} * 3 + c]}); };
            expected.pixels[i] = {entry(0), entry(1), entry(2), 1};
        }
        for (const auto how : both)
            // Each coordinate comes from a fraction, within 2e-5 of the range: of a step, size times as much. What is
            // found comes from a polynomial, within 5.3e-5.
            EXPECT_LE(worst_code(on_gpu({.interpolation = how}, table, test::round_to_float(picture)), expected,
                                 LutSpace::Display),
                      (3 * 2e-5 * size + 5.3e-5) * 1023)
                << size;
    }
}

// Between the reference and single precision lie the encoding's polynomial and the driver's log2 and exp2; of the
// tables here none is steeper than 3, so half a code of 10 bits is room enough.
TEST(EffectLut, GpuMatchesReference) {
    const ReferenceImage display = test::round_to_float(test::random_display(43, 29, 1)),
                         light = test::round_to_float(test::random_hdr(43, 29, 2));
    const auto expect_same = [](const Lut& values, const ColorTable& table, const ReferenceImage& picture) {
        SCOPED_TRACE(fmt::format("space {}, result {}, {}, cube {}, shaper {}", int(values.space), int(values.result),
                                 int(values.interpolation), table.size, table.shaper_size));
        const LutSpace back = values.result == LutResult::Display ? LutSpace::Display : values.space;
        EXPECT_LE(worst_code(on_gpu(values, table, picture), by_reference(values, table, picture), back), 0.5);
    };
    for (const LutSpace space : all_spaces) {
        for (const ColorTable& table : {mixed(2), mixed(17), mixed(33), shaped(5, 9), shaped(17, 100), curve_of(300)}) {
            expect_same({.space = space}, table, light);
            if (space == LutSpace::Display) expect_same({}, table, display);
        }
        expect_same({.space = space, .interpolation = LutInterpolation::Trilinear}, mixed(18), light);
        expect_same({.space = space, .interpolation = LutInterpolation::Trilinear}, shaped(5, 9), light);
        expect_same({.space = space, .result = LutResult::Display}, mixed(17), light);
    }
}

TEST(EffectLut, GpuStagesAgree) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(43, 29, 3));
    const ColorTable table = shaped(17, 100);
    const Lut values{.strength = 0.75f, .space = LutSpace::Logc3};
    const ReferenceImage compute = on_gpu(values, table, picture, nullptr, {.kernels = KernelStage::Compute}),
                         raster = on_gpu(values, table, picture, nullptr, {.kernels = KernelStage::Raster});
    EXPECT_LE(test::worst_difference(compute, raster), gpu::test::code_between_kernels());
}

TEST(EffectLut, GpuFadesAndBlends) {
    const ReferenceImage picture = test::round_to_float(test::random_display(19, 23, 4));
    const ColorTable first = mixed(17), second = shaped(5, 9);
    for (const float fade : {0.0f, 0.3f, 1.0f}) {
        for (const float strength : {0.25f, 1.0f}) {
            const Lut values{.fade = fade, .strength = strength};
            EXPECT_LE(worst_code(on_gpu(values, first, picture, &second), by_reference(values, first, picture, &second),
                                 LutSpace::Display),
                      0.5)
                << fade;
        }
    }
    // Wholly faded it is the second table's picture; without one there is nothing to fade to.
    EXPECT_LE(worst_code(on_gpu({.fade = 1}, first, picture, &second), on_gpu({}, second, picture), LutSpace::Display),
              0.01);
    EXPECT_EQ(test::worst_difference(on_gpu({.fade = 0.5f}, first, picture), on_gpu({}, first, picture)), 0);
    EXPECT_GT(
        worst_code(on_gpu({.fade = 0.5f}, first, picture, &second), on_gpu({}, first, picture), LutSpace::Display), 20);
}

TEST(EffectLut, GpuNumbersThatAreNoneStayWhereTheyAre) {
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    ReferenceImage picture = test::uniform(5, 3, {0.18, 0.18, 0.18, 1}), clean = picture;
    picture.at(1, 1) = {nan, infinity, -infinity, 0.5};
    for (const LutSpace space : all_spaces) {
        for (const ColorTable& table : {mixed(5), shaped(5, 9)}) {
            const ReferenceImage out = on_gpu({.space = space}, table, picture),
                                 without = on_gpu({.space = space}, table, clean);
            for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                const Rgba& p = out.pixels[i];
                EXPECT_TRUE(std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b));
                EXPECT_TRUE(i == 6 || p.r == without.pixels[i].r);
            }
            EXPECT_EQ(out.at(1, 1).a, 0.5);
        }
    }
}

TEST(EffectLut, GpuOnTinyPictures) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 7u}, {9u, 1u}}) {
        const ReferenceImage picture = test::uniform(width, height, {0.5, 0.25, 0.125, 0.75});
        EXPECT_LE(worst_code(on_gpu({}, mixed(17), picture), by_reference({}, mixed(17), picture), LutSpace::Display),
                  0.25);
    }
}

// No file holds one, but a host may bring it.
TEST(EffectLut, GpuACubeOfOneEntryIsItsColor) {
    const ReferenceImage picture = test::round_to_float(test::random_display(9, 5, 4));
    const ColorTable one{.size = 1, .cube = {0.25f, 0.5f, 0.75f}};
    ReferenceImage expected = picture;
    for (Rgba& p : expected.pixels) p = {srgb_decoded(0.25), srgb_decoded(0.5), srgb_decoded(0.75), p.a};
    for (const LutInterpolation interpolation : both) {
        const Lut values{.interpolation = interpolation};
        EXPECT_LE(worst_code(by_reference(values, one, picture), expected, LutSpace::Display), 1e-9);
        EXPECT_LE(worst_code(on_gpu(values, one, picture), expected, LutSpace::Display), 0.25);
    }
}

TEST(EffectLut, GpuALargeTableAndOneThatIsAPicture) {
    const ReferenceImage picture = test::round_to_float(test::random_display(9, 5, 4));
    const ColorTable large = mixed(128);
    EXPECT_LE(worst_code(on_gpu({}, large, picture), by_reference({}, large, picture), LutSpace::Display), 0.25);
    const ReferenceImage out = test::develop(
        [](Composer& composer) {
            composer.add(Lut{.lut = gpu::test::must(composer.define(ResourceImage{1, 1, {5, 5, 5, 5}}))});
        },
        picture);
    EXPECT_LE(worst_code(out, picture, LutSpace::Display), 0.25) << "looked up in the identity";
}

}  // namespace
}  // namespace darkroom
