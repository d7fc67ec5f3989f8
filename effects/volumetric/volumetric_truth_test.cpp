// SPDX-License-Identifier: MIT
// Volumetric light against the integral that it stands for: a million samples along the rays of a picture, each with an
// exact ray to the light through a world of boxes; no shadow map, no blur, no jitter.
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects/volumetric.hpp>

#include "compose/test_stacks/support.hpp"
#include "volumetric/volumetric_reference.hpp"
#include "volumetric/volumetric_test_world.hpp"

namespace darkroom {
namespace {

using test::Box;

constexpr std::uint32_t map_width = 128, map_height = 72;
constexpr double map_aspect = 16.0 / 9;

/// A room of 12 x 6 x 16 m, its left wall with four tall windows, and pillars.
std::vector<Box> room() {
    std::vector<Box> boxes{{{-7, -1, -9}, {7, 0, 9}}, {{-7, 6, -9}, {7, 7, 9}}, {{6, 0, -9}, {7, 6, 9}},
                           {{-7, 0, -9}, {7, 6, -8}}, {{-7, 0, 8}, {7, 6, 9}},  {{-7, 0, -9}, {-6, 2, 9}},
                           {{-7, 5, -9}, {-6, 6, 9}}};
    for (int i = 0; i <= 4; ++i) {
        const double z = -8 + i * 4;
        boxes.push_back({{-7, 2, z - 1.2}, {-6, 5, z + 1.2}});
    }
    for (const double z : {-4.0, 1.0}) boxes.push_back({{1.6, 0, z}, {2.4, 6, z + 0.8}});
    return boxes;
}

struct View {
    const char* name;
    Double3 eye, target;
};
constexpr View views[] = {{"across the shafts", {4.8, 1.7, 6.8}, {-3, 2, -5}},
                          {"toward the windows", {5, 1.5, 0.3}, {-6, 3, -1}},
                          {"along the light", {-4.5, 4.6, 4.4}, {4, 0.5, -3}}};
const Double3 toward_light{-0.8, 0.55, 0.15};

/// The integral along one ray: samples in the middle of equal steps, transmittance falling evenly to decay^32.
double integral(const std::vector<Box>& world, const Volumetric& volumetric, const test::CameraRay& ray, int samples) {
    const Double3 direction = test::normalized(ray.direction), light = test::normalized(toward_light);
    const double length = std::min(test::trace(world, ray.from, direction), double{volumetric.max_distance});
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        const double part = (i + 0.5) / samples;
        const Double3 point = test::along(ray.from, direction, part * length);
        if (std::isinf(test::trace(world, point, light))) sum += std::pow(double{volumetric.decay}, 32 * part);
    }
    return sum / samples * length * double{volumetric.density} * 0.01 * volumetric_phase(test::dot(direction, light));
}

/// Blocks of 8 x 8 pixels.
ReferenceImage blocks(const ReferenceImage& image) {
    ReferenceImage out(image.width / 8, image.height / 8, {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < out.height * 8; ++y)
        for (std::uint32_t x = 0; x < out.width * 8; ++x) out.at(x / 8, y / 8).r += image.at(x, y).r / 64;
    return out;
}

struct Error {
    double bias = 0, mean = 0, worst_block = 0;  ///< of the mean and of the brightest block
};
Error error_of(const ReferenceImage& picture, const ReferenceImage& truth) {
    Error out;
    double total = 0, brightest = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        total += truth.pixels[i].r;
        out.bias += picture.pixels[i].r - truth.pixels[i].r;
        out.mean += std::abs(picture.pixels[i].r - truth.pixels[i].r);
    }
    const ReferenceImage a = blocks(picture), b = blocks(truth);
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        brightest = std::max(brightest, b.pixels[i].r);
        out.worst_block = std::max(out.worst_block, std::abs(a.pixels[i].r - b.pixels[i].r));
    }
    return {out.bias / total, out.mean / total, out.worst_block / brightest};
}

TEST(TruthGpuVolumetric, IsTheIntegralInThreeViews) {
    const std::vector<Box> world = room();
    constexpr int samples = 110;  // 128 x 72 rays of 110 are a million
    const Volumetric volumetric{.density = 100};
    for (const View& view : views) {
        SCOPED_TRACE(view.name);
        const Camera camera = test::look_at(view.eye, view.target, 1.0, map_aspect);
        const ReferenceImage depth = test::traced_depth(world, camera, map_width, map_height);
        const std::vector<ReferenceLight> lights{test::traced_light(world, toward_light, {{{0, 3, 0}, 12, 1000}}, 512)};
        ReferenceImage truth(map_width, map_height);
        const ReferenceCamera eye(camera);
        for (std::uint32_t y = 0; y < map_height; ++y)
            for (std::uint32_t x = 0; x < map_width; ++x) {
                const test::CameraRay ray(eye, (x + 0.5) / map_width, (y + 0.5) / map_height);
                truth.at(x, y).r = integral(world, volumetric, ray, samples);
            }
        const ReferenceImage out =
            test::develop([&](Composer& composer) { composer.add(volumetric); }, {map_width, map_height, {0, 0, 0, 1}},
                          {.depth = &depth, .camera = camera, .lights = lights});
        ASSERT_EQ(out.pixels.size(), truth.pixels.size());
        const Error error = error_of(out, truth);
        // 32 left sums of a falling transmittance are 1 % too bright, and a bias of 0.05 m along the light lets a
        // little through; a blur of 5 x 5 half-size pixels, which is 10 here, rounds the edges of shafts: that is what
        // single pixels differ by, and blocks much less.
        EXPECT_LT(std::abs(error.bias), 0.03);
        EXPECT_LT(error.mean, 0.1);
        EXPECT_LT(error.worst_block, 0.08);
    }
}

}  // namespace
}  // namespace darkroom
