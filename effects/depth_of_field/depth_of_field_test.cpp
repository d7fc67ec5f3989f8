// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/depth_of_field.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "depth_of_field/depth_of_field_reference.hpp"
#include "depth_of_field/depth_of_field_test_shots.hpp"

namespace darkroom {
namespace {

using test::Shot;
using test::depth_of_field::camera_of;
using test::depth_of_field::height;
using test::depth_of_field::is_thing;
using test::depth_of_field::scene;
using test::depth_of_field::width;

constexpr double sharp_m = 4, behind_m = 20, before_m = 2;  // distances, m
// A large camera, so that circles are some pixels of a small picture wide.
constexpr DepthOfField half{.focus_distance = 4, .f_stop = 2, .sensor_height = 480, .max_radius = 4};
DepthOfField at_full(DepthOfField field) {
    field.resolution = DepthOfFieldResolution::Full;
    return field;
}
const DepthOfField full = at_full(half);

ReferenceImage on_gpu(const DepthOfField& field, const Shot& shot, KernelStage kernels = KernelStage::Auto) {
    return test::developed_sequence([&](Composer& composer) { composer.add(field); }, {&shot, 1}, kernels)[0];
}
ReferenceImage on_cpu(const DepthOfField& field, const Shot& shot) {
    return test::reference_sequence([&](Composer& composer) { composer.add(field); }, {&shot, 1})[0];
}
double radius_of(const DepthOfField& field, double distance, std::uint32_t rows = height) {
    return depth_of_field_reference_circle(field, camera_of(rows, rows), distance, rows, 1);
}

/// A dark wall with one bright pixel, or two by two of them.
Shot point(double distance, std::uint32_t x, std::uint32_t y, std::uint32_t columns = width,
           std::uint32_t rows = height) {
    Shot shot{.color = test::uniform(columns, rows, {0, 0, 0, 1}),
              .depth = test::uniform(columns, rows, {distance, 0, 0, 1}),
              .camera = camera_of(columns, rows)};
    shot.color.at(x, y) = {1024, 512, 256, 1};
    return shot;
}

TEST(EffectDepthOfField, TheLensIsThin) {
    // 50 mm at f/2, focused at 2 m, of a point at 4 m on 24 mm: 25 mm * 1/2 * 50 / 1950 = 0.3205 mm across.
    Camera camera = camera_of(1920, 1080);
    camera.projection[5] = static_cast<float>(std::copysign(50.0 / 12, double{camera.projection[5]}));
    DepthOfField field{.focus_distance = 2, .f_stop = 2, .max_radius = 4};
    EXPECT_NEAR(depth_of_field_reference_circle(field, camera, 4, 1080, 1), 0.32051 / 2 / 24 * 1080, 1e-3);
    EXPECT_NEAR(depth_of_field_reference_circle(field, camera, 1, 1080, 1), -2 * 0.32051 / 2 / 24 * 1080, 2e-3);
    EXPECT_NEAR(depth_of_field_reference_circle(field, camera, 2, 1080, 2), 0, 1e-9);
    field.f_stop = 4;
    EXPECT_NEAR(depth_of_field_reference_circle(field, camera, 4, 1080, 2), 0.32051 / 8 / 24 * 1080, 1e-3);
    EXPECT_NEAR(depth_of_field_reference_circle(field, camera, 0.01, 1080, 1), -0.04 * 1080, 1e-9) << "the largest";
}

TEST(EffectDepthOfField, GpuMatchesReference) {
    EXPECT_GT(radius_of(half, behind_m), 3);
    EXPECT_LT(radius_of(half, before_m), -3);
    DepthOfField shaped = half;
    shaped.blades = 5;
    shaped.roundness = 0.3f;
    shaped.rotation = 20;
    shaped.anamorphic_ratio = 1.5f;
    shaped.cats_eye = 1;
    shaped.rings = 2;
    struct Case {
        Shot shot;
        std::vector<DepthOfField> fields;
    };
    for (const Case& tried : {Case{scene(sharp_m, behind_m), {half}}, Case{scene(before_m, sharp_m), {full}},
                              Case{scene(before_m, behind_m), {half, shaped, at_full(shaped)}}})
        for (const DepthOfField& field : tried.fields) {
            const Shot& shot = tried.shot;
            const ReferenceImage expected = on_cpu(field, shot);
            for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
                // Circles and sums in half precision, each cut off by up to 2^-10; a circle of 2^-10 more takes as much
                // more of the samples on its edge.
                EXPECT_LE(test::worst_difference(on_gpu(field, shot, kernels), expected), 0x1p-7)
                    << field.rings << " rings, "
                    << (field.resolution == DepthOfFieldResolution::Full ? "full" : "half");
        }
}

// From half a pixel on, where little of a circle is left to blur.
TEST(EffectDepthOfField, GpuMatchesReferenceWhereANearThingIsHardlyBlurred) {
    const Shot shot = scene(3, 9);
    for (DepthOfField field : {half, full})
        for (const float focus : {3.1f, 3.2f, 3.33f, 3.5f, 3.7f}) {
            field.focus_distance = focus;
            EXPECT_LE(test::worst_difference(on_gpu(field, shot), on_cpu(field, shot)), 0x1p-7)
                << "a radius of " << radius_of(field, 3) << " pixels";
        }
}

// From sharp columns on to circles that are gathered, with some columns at other distances and what is no number. In
// steps: where a sample is about to fall into the next texel, half precision may take either.
TEST(EffectDepthOfField, GpuMatchesReferenceWhereCirclesAreSmall) {
    Shot shot = scene(sharp_m, behind_m);
    shot.color = test::round_to_float(test::random_display(width, height, 7));
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            shot.depth.at(x, y).r = x % 31 == 30
                                        ? (y % 8 < 4 ? sharp_m : std::numeric_limits<double>::infinity())
                                        : 1 / std::lerp(1 / sharp_m, 1 / behind_m, (x / 12 * 12) / double{width});
    shot.color.at(40, 40).g = shot.color.at(50, 90).r = std::numeric_limits<double>::quiet_NaN();
    for (const DepthOfField& field : {half, full})
        EXPECT_LE(test::worst_difference(on_gpu(field, shot), on_cpu(field, shot)), 0x1p-7);
}

TEST(EffectDepthOfField, GpuKeepsTheBitsOfWhatIsSharp) {
    Shot shot = scene(before_m, sharp_m);
    const ReferenceImage noise = test::round_to_float(test::random_hdr(width, height, 5));
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            if (!is_thing(x, y)) shot.color.at(x, y) = noise.at(x, y);
    // Beyond the sharp wall a stripe that is blurred.
    for (std::uint32_t y = 112; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) shot.depth.at(x, y).r = behind_m;
    const auto reach = static_cast<std::uint32_t>(std::ceil(-radius_of(half, before_m))) + 4;
    for (const DepthOfField& field : {half, full}) {
        const ReferenceImage out = on_gpu(field, shot);
        int same = 0, others = 0;
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const Rgba &is = out.at(x, y), &was = shot.color.at(x, y);
                EXPECT_EQ(is.a, was.a);
                const bool is_kept = is.r == was.r && is.g == was.g && is.b == was.b;
                const bool is_far_off = x + reach < 30 || x >= 61 + reach || y + reach < 41 || y >= 88 + reach;
                if (y < 112 && is_far_off) {
                    EXPECT_TRUE(is_kept) << x << "," << y;
                    ++same;
                }
                if (y >= 114 && !is_kept) ++others;
            }
        EXPECT_GT(same, 4000);
        EXPECT_GT(others, 1000) << "the stripe is blurred";
    }
}

TEST(EffectDepthOfField, GpuASmallApertureIsTheIdentity) {
    Shot shot = scene(before_m, behind_m);
    shot.color = test::round_to_float(test::random_hdr(width, height, 6));
    DepthOfField field = half;
    field.f_stop = 64;
    ASSERT_LT(std::abs(radius_of(field, before_m)), 0.5);
    for (const DepthOfField& small : {field, at_full(field)}) {
        EXPECT_EQ(test::worst_difference(on_gpu(small, shot), shot.color), 0);
        EXPECT_EQ(test::worst_difference(on_cpu(small, shot), shot.color), 0);
    }
}

Rgba sum_of(const ReferenceImage& image) {
    Rgba sum{0, 0, 0, 0};
    for (const Rgba& pixel : image.pixels) sum = {sum.r + pixel.r, sum.g + pixel.g, sum.b + pixel.b, sum.a};
    return sum;
}

TEST(EffectDepthOfField, GpuAPointKeepsItsLight) {
    DepthOfField few = half;
    few.rings = 2;
    for (const double distance : {behind_m, before_m, 5.0, 3.3, 1e10})
        for (const DepthOfField& field : {half, full, few})
            for (const std::uint32_t x : {48U, 51U}) {
                const Shot shot = point(distance, x, 64);
                for (const ReferenceImage& out : {on_gpu(field, shot), on_cpu(field, shot)}) {
                    const Rgba sum = sum_of(out);
                    EXPECT_NEAR(sum.r, 1024, 10.24) << distance << " m, at " << x;
                    EXPECT_NEAR(sum.b, 256, 2.56) << distance << " m, at " << x;
                    if (std::abs(radius_of(field, distance)) > 2) {
                        EXPECT_LT(out.at(x, 64).r, 200) << "it is spread: " << distance;
                    }
                }
            }
}

/// Mean squares of the distances from the middle of the light.
struct Spread {
    double across = 0, down = 0;
};
Spread spread_of(const ReferenceImage& image) {
    double sum = 0, x_mean = 0, y_mean = 0;
    const auto each = [&](auto&& take) {
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x) take(x + 0.5, y + 0.5, image.at(x, y).r);
    };
    each([&](double x, double y, double light) {
        sum += light;
        x_mean += x * light;
        y_mean += y * light;
    });
    Spread spread;
    each([&](double x, double y, double light) {
        spread.across += std::pow(x - x_mean / sum, 2) * light / sum;
        spread.down += std::pow(y - y_mean / sum, 2) * light / sum;
    });
    return spread;
}

TEST(EffectDepthOfField, GpuACircleIsAsLargeAsTheLensSays) {
    // Of a disc the mean square along an axis is a quarter of that of its radius: 3.6, 4.6, 1, 1.5, 2 and 2.6 pixels.
    for (const double distance : {behind_m, before_m, 5.1, 6.0, 7.3, 9.6})
        for (DepthOfField field : {half, full}) {
            field.rings = 8;
            const double expected = std::pow(radius_of(field, distance), 2) / 4;
            const Spread spread = spread_of(on_gpu(field, point(distance, 48, 64)));
            EXPECT_NEAR(spread.across, expected, 0.2 * expected) << distance;
            EXPECT_NEAR(spread.down, expected, 0.2 * expected) << distance;
            // Narrower by whole pixels are large ones alone.
            if (field.resolution == DepthOfFieldResolution::Half || expected < 3) continue;
            field.anamorphic_ratio = 2;
            const Spread narrow = spread_of(on_gpu(field, point(distance, 48, 64)));
            EXPECT_NEAR(narrow.across / narrow.down, 0.25, 0.1) << distance;
        }
}

TEST(EffectDepthOfField, GpuBladesHaveSoManySides) {
    constexpr std::uint32_t side = 400;  // where circles may be 16 pixels large
    for (const std::int32_t blades : {3, 5, 6, 8}) {
        DepthOfField field = full;
        field.f_stop = 0.5f;
        field.rings = 8;
        field.blades = blades;
        const ReferenceImage out = on_gpu(field, point(behind_m, 64, 200, 128, side));
        // How far the light reaches, by direction: of a polygon with n sides the nth wave is the strongest.
        std::vector<double> reach(360);
        for (int degrees = 0; degrees < 360; ++degrees) {
            const double angle = degrees * std::numbers::pi / 180;
            double sum = 0;
            for (double away = 0; away < 20; away += 0.125)
                sum += sample_reference(out, (64.5 + std::cos(angle) * away) / 128,
                                        (200.5 - std::sin(angle) * away) / side)
                           .r *
                       away;
            reach[static_cast<std::size_t>(degrees)] = sum;
        }
        const auto wave = [&](int order) {
            double real = 0, imaginary = 0;
            for (int degrees = 0; degrees < 360; ++degrees) {
                const double angle = degrees * std::numbers::pi / 180 * order;
                real += reach[static_cast<std::size_t>(degrees)] * std::cos(angle);
                imaginary += reach[static_cast<std::size_t>(degrees)] * std::sin(angle);
            }
            return std::array{std::hypot(real, imaginary), std::atan2(imaginary, real)};
        };
        for (int order = 3; order <= 11; ++order) {
            if (order == blades || order == 2 * blades) continue;
            EXPECT_GT(wave(blades)[0], 1.5 * wave(order)[0]) << blades << ' ' << order;
        }
        // Its first corner points to the right.
        if (blades < 8) {
            EXPECT_NEAR(wave(blades)[1], 0, 0.5) << blades;
        }
        field.roundness = 1;
        const ReferenceImage round = on_gpu(field, point(behind_m, 64, 200, 128, side));
        field.blades = 0;
        EXPECT_LE(test::worst_difference(round, on_gpu(field, point(behind_m, 64, 200, 128, side))), 1024 * 0x1p-8);
    }
}

TEST(EffectDepthOfField, GpuTheBarrelCutsCirclesInTheCorners) {
    DepthOfField field = full;
    field.cats_eye = 1;
    const double uncut = std::pow(radius_of(field, behind_m), 2) / 4;
    const Spread middle = spread_of(on_gpu(field, point(behind_m, 48, 64)));
    EXPECT_NEAR(middle.across, uncut, 0.2 * uncut);
    // At the right edge across, at the bottom downward.
    const Spread right = spread_of(on_gpu(field, point(behind_m, 84, 64)));
    EXPECT_LT(right.across, 0.8 * right.down);
    const Spread bottom = spread_of(on_gpu(field, point(behind_m, 48, 116)));
    EXPECT_LT(bottom.down, 0.8 * bottom.across);
}

TEST(EffectDepthOfField, GpuASharpThingDoesNotLeakIntoTheWall) {
    const Shot shot = scene(sharp_m, behind_m);
    for (const DepthOfField& field : {half, full})
        for (const ReferenceImage& out : {on_gpu(field, shot), on_cpu(field, shot)}) {
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < width; ++x) {
                    const Rgba& pixel = out.at(x, y);
                    ASSERT_EQ(pixel.r, is_thing(x, y) ? 1 : 0) << x << "," << y;
                    ASSERT_EQ(pixel.g == 0, is_thing(x, y)) << x << "," << y;
                }
            // The wall has lost its stripes, beside the thing as well.
            for (const std::uint32_t x : {12U, 27U, 63U, 80U}) EXPECT_NEAR(out.at(x, 60).g, 0.5, 0.1) << x;
        }
}

TEST(EffectDepthOfField, GpuANearThingFadesOverASharpWall) {
    const Shot shot = scene(before_m, sharp_m);
    const double radius = -radius_of(half, before_m);
    // What a disc covers beyond a straight edge at a distance of t radii.
    const auto covered = [](double t) {
        return t >= 1 ? 0.0 : t <= -1 ? 1.0 : (std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi;
    };
    for (const DepthOfField& field : {half, full}) {
        const ReferenceImage out = on_gpu(field, shot);
        for (int way = -8; way < 8; ++way) {
            const double expected = covered((way + 0.5) / radius);
            const auto red = [&](int x) { return out.at(static_cast<std::uint32_t>(x), 64).r; };
            // Samples lie on rings, and a texel of half size is two pixels wide.
            EXPECT_NEAR(red(61 + way), expected, 0.13) << way;
            EXPECT_NEAR(red(29 - way), expected, 0.13) << way;
        }
        EXPECT_NEAR(out.at(45, 64).r, 1, 0x1p-9) << "it is opaque";
    }
}

TEST(EffectDepthOfField, GpuFlatFieldsStayFlat) {
    Shot shot = scene(before_m, behind_m);
    shot.color = test::uniform(width, height, {2, 0.5, 0.25, 1});
    for (const DepthOfField& field : {half, full}) {
        EXPECT_LE(test::worst_difference(on_cpu(field, shot), shot.color), 1e-12);
        EXPECT_LE(test::worst_difference(on_gpu(field, shot), shot.color), 0x1p-7);
    }
}

TEST(EffectDepthOfField, GpuNanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const DepthOfField& field : {half, full}) {
        const Shot clean = scene(before_m, behind_m);
        Shot shot = clean;
        shot.color.at(10, 20) = {nan, infinity, -infinity, 0.25};
        shot.color.at(45, 64) = {65504, nan, 0, 0.25};
        shot.depth.at(80, 110) = {nan, 0, 0, 1};
        shot.depth.at(81, 20) = {infinity, 0, 0, 1};
        const ReferenceImage out = on_gpu(field, shot), expected = on_gpu(field, clean);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const Rgba& pixel = out.at(x, y);
                ASSERT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b))
                    << x << "," << y;
                const auto is_far = [&](int from_x, int from_y) {
                    return std::max(std::abs(static_cast<int>(x) - from_x), std::abs(static_cast<int>(y) - from_y)) >
                           12;
                };
                if (is_far(10, 20) && is_far(45, 64) && is_far(80, 110) && is_far(81, 20)) {
                    ASSERT_EQ(pixel.g, expected.at(x, y).g) << x << "," << y;
                }
            }
    }
}

TEST(EffectDepthOfField, GpuOddSizesAndASinglePixel) {
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, VkExtent2D{1, 7}, VkExtent2D{9, 1}, VkExtent2D{31, 117}})
        for (const double distance : {before_m, behind_m})
            for (const DepthOfField& field : {half, full}) {
                const Shot shot{.color = test::round_to_float(test::random_display(extent.width, extent.height, 3)),
                                .depth = test::uniform(extent.width, extent.height, {distance, 0, 0, 1}),
                                .camera = camera_of(extent.width, extent.height)};
                EXPECT_LE(test::worst_difference(on_gpu(field, shot), on_cpu(field, shot)), 0x1p-7)
                    << extent.width << "x" << extent.height;
            }
}

TEST(EffectDepthOfField, GpuTakesTheDepthOfADevice) {
    Shot planar = scene(before_m, behind_m);
    Shot reversed = planar;
    Camera& camera = reversed.camera;
    camera.depth = DepthKind::Reversed;
    camera.far_distance = std::numeric_limits<float>::infinity();
    camera.projection[10] = 0;
    camera.projection[14] = camera.near_distance;
    for (Rgba& depth : reversed.depth.pixels) depth.r = double{camera.near_distance} / depth.r;
    const auto developed = [&](const Shot& shot, bool is_planar) {
        return test::develop([&](Composer& composer) { composer.add(half); }, shot.color,
                             {.depth = &shot.depth, .is_depth_planar = is_planar, .camera = shot.camera});
    };
    EXPECT_LE(test::worst_difference(developed(reversed, false), developed(planar, true)), 0x1p-8);
}

}  // namespace
}  // namespace darkroom
