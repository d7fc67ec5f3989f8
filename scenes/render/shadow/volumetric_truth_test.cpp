// SPDX-License-Identifier: MIT
// Volumetric light through the renderer's own cascades, against the integral that it stands for: a million samples
// along the rays of a picture, each with an exact ray to the light through a world of boxes; no shadow map, no blur, no
// jitter.
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects/volumetric.hpp>

#include "compose/test_stacks/support.hpp"
#include "render/shadow/shadow_test_support.hpp"
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

scene::vec3 vector_of(const Double3& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// What the renderer draws for a light and a view of 1 radian, as effects are given it.
ReferenceLight drawn_light(const std::vector<Box>& world, const View& view, const render::CascadeDesc& desc) {
    scene::CameraState camera =
        render::test::look(vector_of(view.eye), vector_of(view.target), glm::degrees(1.0F), 1000);
    camera.projection[0][0] *= 1.5F / static_cast<float>(map_aspect);
    scene::Snapshot snapshot = render::test::empty_scene(camera);
    for (const Box& box : world) render::test::add_box(snapshot, vector_of(box.low), vector_of(box.high));
    render::test::add_light(snapshot, vector_of(toward_light));
    render::test::ShadowRig rig(desc);
    rig.run(snapshot, {});

    const render::Cascades& cascades = rig.pass.cascades(0);
    ReferenceLight out{.light = {.volumetric_intensity = 1}, .resolution = desc.resolution};
    for (int axis = 0; axis < 3; ++axis)
        out.light.direction[static_cast<std::size_t>(axis)] = snapshot.lights[0].direction[axis];
    const std::size_t texels = std::size_t{desc.resolution} * desc.resolution;
    gpu::Context& context = gpu::test::context();
    const gpu::Buffer read =
        gpu::test::must(gpu::Buffer::create(context, texels * cascades.count * sizeof(float),
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::Kind::Readback, "cascades"));
    gpu::test::must(gpu::submit_and_wait(context, "reading cascades", [&](VkCommandBuffer commands) {
        const gpu::Image& map = rig.pass.map(0);
        gpu::transition(context, commands, map, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, cascades.count},
                                     .imageExtent = {desc.resolution, desc.resolution, 1}};
        context.vk.CmdCopyImageToBuffer(commands, map.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, read.handle, 1,
                                        &copy);
    }));
    for (std::uint32_t cascade = 0; cascade < cascades.count; ++cascade) {
        std::memcpy(out.light.world_to_cascade[cascade].data(), &cascades.world_to_cascade[cascade],
                    sizeof out.light.world_to_cascade[cascade]);
        out.light.splits[cascade] = cascades.splits[cascade];
        std::vector<float>& depths = out.cascades.emplace_back(texels);
        std::memcpy(depths.data(), read.memory.mapped + cascade * texels * sizeof(float), texels * sizeof(float));
    }
    return out;
}

/// The integral along one ray: samples in the middle of equal steps, each metre leaves `decay`.
double integral(const std::vector<Box>& world, const Volumetric& volumetric, const test::CameraRay& ray, int samples) {
    const Double3 direction = test::normalized(ray.direction), light = test::normalized(toward_light);
    const double length = std::min(test::trace(world, ray.from, direction), double{volumetric.max_distance});
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        const double part = (i + 0.5) / samples;
        const Double3 point = test::along(ray.from, direction, part * length);
        if (std::isinf(test::trace(world, point, light))) sum += std::pow(double{volumetric.decay}, part * length);
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

struct Deviation {
    double bias = 0, mean = 0, worst_block = 0;  ///< of the mean and of the brightest block
};
Deviation deviation_of(const ReferenceImage& picture, const ReferenceImage& truth) {
    Deviation out;
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
        const std::vector<ReferenceLight> lights{drawn_light(world, view, {.resolution = 512})};
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
        const Deviation error = deviation_of(out, truth);
        // 32 left sums of a falling transmittance are 1 % too bright; a blur of 5 x 5 half-size pixels, which is 10
        // here, rounds the edges of shafts: that is what single pixels differ by, and blocks much less.
        EXPECT_LT(std::abs(error.bias), 0.03);
        EXPECT_LT(error.mean, 0.1);
        EXPECT_LT(error.worst_block, 0.08);
    }
}

// The depth of the effect's march and the renderer's map meet in no test but this one.
TEST(TruthGpuVolumetric, ClosedRoomsAreDark) {
    for (const double thickness : {0.05, 0.3}) {
        std::vector<Box> world;
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const bool is_high : {false, true}) {
                Box wall{{-3 - thickness, -thickness, -3 - thickness}, {3 + thickness, 3 + thickness, 3 + thickness}};
                const double inside = axis == 1 ? (is_high ? 3 : 0) : (is_high ? 3 : -3);
                (is_high ? wall.low : wall.high)[axis] = inside;
                world.push_back(wall);
            }
        world.push_back({{-50, 3, -50}, {3, 3 + thickness, 50}});
        const View view{"in a corner", {-2, 0.5, -2.5}, {2, 2.5, 0}};
        const Camera camera = test::look_at(view.eye, view.target, 1.0, map_aspect);
        const ReferenceImage depth = test::traced_depth(world, camera, map_width, map_height);
        for (const std::uint32_t resolution : {1024u, 2048u}) {
            const std::vector<ReferenceLight> lights{drawn_light(world, view, {.resolution = resolution})};
            const ReferenceImage out = test::develop(
                [&](Composer& composer) { composer.add(Volumetric{.density = 1000}); },
                {map_width, map_height, {0, 0, 0, 1}}, {.depth = &depth, .camera = camera, .lights = lights});
            double most = 0;
            for (const Rgba& pixel : out.pixels) most = std::max(most, pixel.r);
            EXPECT_EQ(most, 0) << "walls of " << thickness << " m, " << resolution << " texels";
        }
    }
}

}  // namespace
}  // namespace darkroom
