// SPDX-License-Identifier: MIT
// Depth of field against the renderer's own lens: many places of the aperture, each a draw.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/depth_of_field.hpp>

#include "depth_of_field/depth_of_field_reference.hpp"
#include "depth_of_field/depth_of_field_test_scenes.hpp"
#include "develop/test_sequence.hpp"
#include "image/compare/flip.hpp"

namespace darkroom {
namespace {

constexpr VkExtent2D truth_extent{640, 360};
constexpr float truth_f_stop = 2, truth_sensor_mm = 24;

struct LensTruth {
    test::Shot sharp;
    ReferenceImage seen;
    std::vector<bool> is_silhouette;  ///< within 3 pixels of where the depth jumps
};

ReferenceImage image_of(const render::test::Pixels& pixels) {
    ReferenceImage out(truth_extent.width, truth_extent.height);
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] = {double{pixels.rgba[4 * i]}, double{pixels.rgba[4 * i + 1]}, double{pixels.rgba[4 * i + 2]}, 1};
    return out;
}

/// Where the depth jumps by more than a slope explains, and 3 pixels around.
std::vector<bool> silhouettes(const ReferenceImage& depth) {
    std::vector<bool> out(depth.pixels.size());
    const auto nearness = [&](std::int64_t x, std::int64_t y) { return 1 / depth.clamped(x, y).r; };
    for (std::int64_t y = 0; y < depth.height; ++y)
        for (std::int64_t x = 0; x < depth.width; ++x) {
            const double here = nearness(x, y);
            if (std::abs(nearness(x - 1, y) + nearness(x + 1, y) - 2 * here) <= 0.03 * here &&
                std::abs(nearness(x, y - 1) + nearness(x, y + 1) - 2 * here) <= 0.03 * here)
                continue;
            for (std::int64_t v = std::max<std::int64_t>(y - 3, 0);
                 v <= std::min<std::int64_t>(y + 3, depth.height - 1); ++v)
                for (std::int64_t u = std::max<std::int64_t>(x - 3, 0);
                     u <= std::min<std::int64_t>(x + 3, depth.width - 1); ++u)
                    out[static_cast<std::size_t>(v * depth.width + u)] = true;
        }
    return out;
}

LensTruth truth_of(const test::LensScene& scene, std::uint32_t places) {
    const scene::Assets assets = test::lens_scene_assets();
    render::RenderDesc desc{.extent = truth_extent, .positions = 8, .draw = {.has_shadows = false}};
    scene::Scene surroundings;
    surroundings.environment.background = {0.35F, 0.5F, 0.8F};
    LensTruth out;
    render::Renderer pinhole = render::test::renderer_for(desc, assets, surroundings);
    const render::test::Shot shot = render::test::shoot(pinhole, scene.snapshot);
    out.sharp = {.color = image_of(shot.color), .depth = image_of(shot.depth), .camera = pinhole.frame().camera};
    desc.positions = places;
    desc.is_mean_weighed = false;
    desc.lens = {.f_stop = truth_f_stop, .focus_distance = scene.focus_distance, .sensor_height = truth_sensor_mm};
    render::Renderer lens = render::test::renderer_for(desc, assets, surroundings);
    out.seen = image_of(render::test::shoot(lens, scene.snapshot).color);
    out.is_silhouette = silhouettes(out.sharp.depth);
    return out;
}

Picture encoded(const ReferenceImage& image) {
    Picture out(image.width, image.height);
    const auto srgb = [](double value) {
        value = std::clamp(value, 0.0, 1.0);
        return static_cast<float>(value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055);
    };
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        out.pixels[4 * i] = srgb(image.pixels[i].r);
        out.pixels[4 * i + 1] = srgb(image.pixels[i].g);
        out.pixels[4 * i + 2] = srgb(image.pixels[i].b);
        out.pixels[4 * i + 3] = 1;
    }
    return out;
}

struct LensErrors {
    double mean = 0, at_silhouettes = 0;  ///< FLIP
};
LensErrors errors_of(const ReferenceImage& made, const LensTruth& truth) {
    const FlipErrors found = gpu::test::must(flip(encoded(truth.seen), encoded(made)));
    LensErrors out{.mean = found.mean};
    double count = 0;
    for (std::size_t i = 0; i < found.errors.size(); ++i) {
        if (!truth.is_silhouette[i]) continue;
        out.at_silhouettes += double{found.errors[i]};
        ++count;
    }
    out.at_silhouettes /= std::max(count, 1.0);
    return out;
}

struct LensCase {
    test::LensScene (*scene)(float aspect);
    double half = 0, full = 0;  ///< mean FLIP, at most, by the size of the effect
    double silhouettes = 0;     ///< times the mean, at most
};
constexpr LensCase street{test::street_of_columns, 0.019, 0.0155, 2.8};
constexpr LensCase post{test::post_before_a_wall, 0.019, 0.018, 2.6};
// What its bars hide is not in the picture.
constexpr LensCase fence{test::near_fence, 0.03, 0.0275, 1.8};
constexpr LensCase balls{test::balls_with_highlights, 0.017, 0.016, 3.3};
constexpr LensCase figure{test::figure_in_a_room, 0.018, 0.017, 3.2};

void expect_the_lens(const LensCase& bound, std::uint32_t places = 128) {
    const test::LensScene scene = bound.scene(16.0F / 9);
    const LensTruth truth = truth_of(scene, places);
    const LensErrors untouched = errors_of(truth.sharp.color, truth);
    for (const DepthOfFieldResolution resolution : {DepthOfFieldResolution::Half, DepthOfFieldResolution::Full}) {
        const bool is_full = resolution == DepthOfFieldResolution::Full;
        const DepthOfField field{.focus_distance = scene.focus_distance,
                                 .f_stop = truth_f_stop,
                                 .sensor_height = truth_sensor_mm,
                                 .max_radius = 4,
                                 .resolution = resolution};
        const LensErrors errors = errors_of(
            test::developed_sequence([&](Composer& composer) { composer.add(field); }, {&truth.sharp, 1})[0], truth);
        fmt::print("{}, {}: {:.4f}, silhouettes {:.4f}; sharp {:.4f}, {:.4f}\n", scene.name, is_full ? "full" : "half",
                   errors.mean, errors.at_silhouettes, untouched.mean, untouched.at_silhouettes);
        EXPECT_LE(errors.mean, is_full ? bound.full : bound.half) << scene.name;
        EXPECT_LE(errors.at_silhouettes, bound.silhouettes * errors.mean) << scene.name;
        EXPECT_LT(errors.mean, 0.9 * untouched.mean) << scene.name << ": it is nearer to the lens than no blur";
    }
}

TEST(TruthGpuDepthOfField, StreetOfColumns) { expect_the_lens(street); }
TEST(TruthGpuDepthOfField, PostBeforeAWall) { expect_the_lens(post); }
TEST(TruthGpuDepthOfField, NearFence) { expect_the_lens(fence); }
TEST(TruthGpuDepthOfField, BallsWithHighlights) { expect_the_lens(balls); }
TEST(TruthGpuDepthOfField, FigureInARoom) { expect_the_lens(figure); }

TEST(SoakGpuDepthOfField, AThousandPlacesOfTheAperture) {
    for (const LensCase& bound : {street, post, fence, balls, figure}) expect_the_lens(bound, 1024);
}

}  // namespace
}  // namespace darkroom
