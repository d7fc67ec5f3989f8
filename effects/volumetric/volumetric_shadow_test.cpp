// SPDX-License-Identifier: MIT
// Volumetric light where something casts a shadow: small worlds of boxes.
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects/volumetric.hpp>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/shadow_map.hpp"
#include "volumetric/volumetric_reference.hpp"
#include "volumetric/volumetric_test_world.hpp"

namespace darkroom {
namespace {

using test::Box;
using test::traced_light;

constexpr std::uint32_t shadow_width = 96, shadow_height = 54;
constexpr double aspect = 16.0 / 9;

struct World {
    std::vector<Box> boxes;
    Camera camera;
    std::vector<ReferenceLight> lights{};
    ReferenceImage picture{shadow_width, shadow_height, {0, 0, 0, 1}};
    ReferenceImage depth = test::traced_depth(boxes, camera, shadow_width, shadow_height);

    [[nodiscard]] test::RunOptions options() const { return {.depth = &depth, .camera = camera, .lights = lights}; }
    [[nodiscard]] ReferenceImage developed(const Volumetric& volumetric, KernelStage stage = KernelStage::Auto) const {
        test::RunOptions run = options();
        run.kernels = stage;
        return test::develop([&](Composer& composer) { composer.add(volumetric); }, picture, run);
    }
    [[nodiscard]] ReferenceImage reference(const Volumetric& volumetric) const {
        return test::scene_reference_of(volumetric, picture, options());
    }
};

/// A roof with a gap from x = -1 to 1 that begins 4 m before the camera, a floor, and a wall far behind; the camera
/// looks along -z.
const std::vector<Box> lane{{{-40, 4, -40}, {-1, 5, 40}},
                            {{1, 4, -40}, {40, 5, 40}},
                            {{-2, 4, 6}, {2, 5, 40}},
                            {{-40, -4, -40}, {40, -3, 40}},
                            {{-40, -4, -32}, {40, 5, -30}}};
World lane_world() { return {.boxes = lane, .camera = test::look_at({0, 0, 10}, {0, 0, 0}, 0.6, aspect)}; }
const Double3 above{0, 1, 0};
const std::vector<test::CascadeRange> two_cascades{{{0, 0, 2}, 12, 16}, {{0, 0, -10}, 40, 1000}};

TEST(EffectVolumetricShadow, GpuLitLaneIsBrightAndShadowIsDark) {
    World world = lane_world();
    world.lights = {traced_light(lane, above, two_cascades, 256)};
    const ReferenceImage out = world.developed({.density = 100});
    ASSERT_EQ(out.pixels.size(), world.picture.pixels.size());
    // Far to the side the march meets the lane nowhere; in the middle it never leaves it.
    const double lit = out.at(shadow_width / 2, shadow_height / 2).r, dark = out.at(2, shadow_height / 2).r;
    EXPECT_GT(lit, 0.1);
    EXPECT_LT(dark, lit * 0.02);
}

TEST(EffectVolumetricShadow, GpuMatchesReference) {
    World world = lane_world();
    world.picture = test::round_to_float(test::random_display(shadow_width, shadow_height, 7));
    world.lights = {traced_light(lane, {0.2, 1, 0.1}, two_cascades, 128),
                    traced_light(lane, {-0.3, 1, 0.3}, {{{0, 0, -10}, 40, 50}}, 64)};
    world.lights[1].light.volumetric_color = {0.2f, 0.5f, 1};
    for (const Volumetric& volumetric :
         {Volumetric{.density = 50}, Volumetric{.density = 50, .samples = 13},
          Volumetric{.density = 80, .max_distance = 25, .decay = 0.9f},
          Volumetric{.density = 50, .decay = 0.9f, .decay_form = VolumetricDecay::PerStep}}) {
        const ReferenceImage expected = world.reference(volumetric);
        double most = 0;
        for (std::size_t i = 0; i < expected.pixels.size(); ++i)
            most = std::max(most, expected.pixels[i].r - world.picture.pixels[i].r);
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const ReferenceImage out = world.developed(volumetric, stage);
            ASSERT_EQ(out.pixels.size(), expected.pixels.size());
            double sum = 0, worst = 0;
            for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                const double error = std::abs(out.pixels[i].r - expected.pixels[i].r);
                sum += error;
                worst = std::max(worst, error);
            }
            // Three writes in half precision are cut off by up to 2^-11 each; a sample within rounding of a texel's
            // edge may fall on its other side, which is one step of one pixel before the blur.
            EXPECT_LT(sum / static_cast<double>(out.pixels.size()), most * 0.001) << volumetric.samples;
            EXPECT_LT(worst, most * 0.01) << volumetric.samples;
        }
    }
}

TEST(EffectVolumetricShadow, GpuKnowsParallelRaysToo) {
    World world = lane_world();
    Matrix& p = world.camera.projection;
    p = {};
    p[0] = 0.1f;
    p[5] = -0.2f;
    p[10] = -0.01f;
    p[15] = 1;
    for (Rgba& pixel : world.depth.pixels) pixel.r = 40;
    world.lights = {traced_light(lane, {0.2, 1, 0.1}, two_cascades, 128)};
    const Volumetric volumetric{.density = 100};
    const ReferenceImage expected = world.reference(volumetric), out = world.developed(volumetric);
    EXPECT_GT(expected.at(shadow_width / 2, shadow_height / 2).r, 0.1);
    EXPECT_LT(expected.at(2, shadow_height / 2).r, 0.01);
    EXPECT_LT(test::worst_difference(out, expected), 0.01 * expected.at(shadow_width / 2, shadow_height / 2).r);
}

TEST(EffectVolumetricShadow, GpuEachLightHasItsOwnShadows) {
    World world = lane_world();
    world.lights = {test::open_light(above), traced_light({{{-90, 8, -90}, {90, 9, 90}}}, above, two_cascades, 64)};
    world.lights[0].light.volumetric_color = {1, 0, 0};
    world.lights[1].light.volumetric_color = {0, 1, 0};
    const ReferenceImage blocked = world.developed({.density = 100});
    const Rgba middle = blocked.at(shadow_width / 2, shadow_height / 2);
    EXPECT_GT(middle.r, 0.1);
    EXPECT_EQ(middle.g, 0) << "the second light is behind a roof of its own";
    std::swap(world.lights[0].cascades, world.lights[1].cascades);
    std::swap(world.lights[0].resolution, world.lights[1].resolution);
    std::swap(world.lights[0].light.splits, world.lights[1].light.splits);
    std::swap(world.lights[0].light.world_to_cascade, world.lights[1].light.world_to_cascade);
    const Rgba swapped = world.developed({.density = 100}).at(shadow_width / 2, shadow_height / 2);
    EXPECT_EQ(swapped.r, 0);
    EXPECT_NEAR(swapped.g / middle.r, 1, 1e-3);
}

// Shadows switched off and on under a plan that runs: no frame shows the light of another one.
TEST(EffectVolumetricShadow, GpuShadowsThatAreSwitchedOffTakeTheirLightWithThem) {
    World world = lane_world();
    world.picture = test::round_to_float(test::random_display(shadow_width, shadow_height, 3));
    const ReferenceLight traced = traced_light(lane, above, two_cascades, 128);
    const test::Host host(world.picture);
    gpu::Context& context = host.device.context();
    const gpu::test::Picture depth =
        gpu::test::upload(context, test::pixels_of(world.depth), VK_FORMAT_R32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    const gpu::Image shadow_map = test::upload_shadow_map(context, traced);
    std::vector<Light> lights{traced.light};
    lights[0].cascades = test::shadow_map_ref(shadow_map);
    lights[0].cascade_count = 2;
    const std::vector<Light> shadowless{traced.light};

    Composer composer(host.device, {.frames_in_flight = 1});
    composer.add(Volumetric{.density = 100});
    CompileDesc desc = host.compile_desc();
    desc.depth = {VK_FORMAT_R32_SFLOAT};
    desc.is_depth_planar = true;
    desc.has_shadows = true;
    test::must(composer.compile(desc));
    const auto shown = [&](std::span<const Light> given) {
        Frame frame = host.frame();
        frame.depth = test::image_ref(depth);
        frame.camera = world.camera;
        frame.lights = given;
        test::must(host.record(composer, frame));
        return host.read_target();
    };
    // Before and after the lean kernels have come.
    for (const bool has_lean_kernels : {false, true}) {
        if (has_lean_kernels) composer.wait_for_kernels();
        const ReferenceImage lit = shown(lights);
        EXPECT_GT(test::worst_difference(lit, world.picture), 0.1);
        EXPECT_EQ(test::worst_difference(shown(shadowless), world.picture), 0);
        EXPECT_EQ(test::worst_difference(shown({}), world.picture), 0);
        EXPECT_EQ(test::worst_difference(shown(lights), lit), 0) << "and they come back";
    }
}

// In front of the wall all is dark, behind it all is lit: none of that may come through.
TEST(EffectVolumetricShadow, GpuNoLightLeaksThroughAWall) {
    const std::vector<Box> wall{{{-30, -30, -1}, {30, 30, 0}}, {{-60, 20, -1}, {60, 21, 60}}};
    World world{.boxes = wall, .camera = test::look_at({0, 0, 10}, {0.7, 0.3, 0}, 0.6, aspect)};
    world.lights = {traced_light(wall, above, {{{0, 0, 0}, 60, 1000}}, 256)};
    for (const std::int32_t samples : {1, 32, 256})
        EXPECT_EQ(test::worst_difference(world.developed({.density = 1000, .samples = samples}), world.picture), 0);
    // The same without the wall in the depth: the light behind it is there.
    for (Rgba& pixel : world.depth.pixels) pixel.r = 1e10;
    EXPECT_GT(world.developed({.density = 1000}).at(40, 30).r, 0.1);
}

/// A post before a far wall in even light: pixels must be either as bright as the post's or as the wall's.
TEST(EffectVolumetricShadow, GpuNoHaloAtAPost) {
    const Volumetric volumetric{.density = 100, .decay = 1};
    for (const std::uint32_t first : {40u, 41u})
        for (const std::uint32_t thickness : {2u, 3u, 6u}) {
            World world{.boxes = {}, .camera = test::look_at({0, 0, 0}, {0, 0, -1}, 0.1, aspect)};
            world.lights = {test::open_light(above)};
            for (std::uint32_t y = 0; y < shadow_height; ++y)
                for (std::uint32_t x = 0; x < shadow_width; ++x)
                    world.depth.at(x, y).r = x >= first && x < first + thickness ? 5 : 80;
            const ReferenceImage out = world.developed(volumetric);
            ASSERT_EQ(out.pixels.size(), world.picture.pixels.size());
            const double far = out.at(4, 30).r;
            for (std::uint32_t x = 0; x < shadow_width; ++x) {
                const double expected = x >= first && x < first + thickness ? far * 5 / 80 : far;
                // The far pixels' weight at the post is 0.01 / 16 of the near ones', and their light 16 times as much;
                // the phase changes by a hundredth across the picture.
                EXPECT_NEAR(out.at(x, 30).r, expected, expected * 0.03) << first << "+" << thickness << " at " << x;
            }
        }
}

// Thinner than a half-size pixel: nobody like it was marched, so the light before it is estimated, not the wall's.
TEST(EffectVolumetricShadow, GpuAThinWireIsNotAsBrightAsTheWallBehind) {
    World world{.boxes = {}, .camera = test::look_at({0, 0, 0}, {0, 0, -1}, 0.1, aspect)};
    world.lights = {test::open_light(above)};
    for (std::uint32_t y = 0; y < shadow_height; ++y)
        for (std::uint32_t x = 0; x < shadow_width; ++x) world.depth.at(x, y).r = x == 41 ? 5 : 80;
    const ReferenceImage out = world.developed({.density = 100, .decay = 1});
    ASSERT_EQ(out.pixels.size(), world.picture.pixels.size());
    EXPECT_NEAR(out.at(41, 20).r / out.at(30, 20).r, 5.0 / 80, 0.005);
}

}  // namespace
}  // namespace darkroom
