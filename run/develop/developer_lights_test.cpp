// SPDX-License-Identifier: MIT
// Developing with the lights of a frame and their shadows: from images of the device, from main memory, and by the
// references. The effect that reads them is found by name, since a tree may lack it.

#include <gtest/gtest.h>

#include <darkroom/effects.hpp>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/shadow_map.hpp"
#include "develop/developer.hpp"
#include "develop/reference_chain.hpp"

namespace darkroom {
namespace {

constexpr std::uint32_t frame_width = 48, frame_height = 32;
constexpr double wall = 10;  // metres

/// Stripes of light, `stripe` texels wide and others in each cascade, for a box around the view.
ReferenceLight striped_light(std::uint32_t resolution, std::uint32_t cascades, std::uint32_t stripe) {
    ReferenceLight out{.light = {.direction = {0.2F, 0.4F, -0.8F}, .volumetric_intensity = 3},
                       .resolution = resolution};
    out.light.volumetric_color = {1, 0.5F, 0.25F};
    for (std::uint32_t cascade = 0; cascade < cascades; ++cascade) {
        Matrix& matrix = out.light.world_to_cascade[cascade];
        matrix = {};
        matrix[0] = 1.0F / static_cast<float>(6 + cascade);
        matrix[5] = 1.0F / 5;
        matrix[10] = 1.0F / 40;
        matrix[14] = 0.5F;
        matrix[15] = 1;
        out.light.splits[cascade] = 4 + 90 * static_cast<float>(cascade);
        std::vector<float>& depth = out.cascades.emplace_back();
        for (std::uint32_t texel = 0; texel < resolution * resolution; ++texel)
            depth.push_back((texel % resolution / stripe + cascade) % 2 == 0 ? 0.0F : 1.0F);
    }
    return out;
}

class ComposeDeveloperLights : public testing::Test {
  protected:
    void SetUp() override {
        effect_ = find_effect("volumetric");
        if (effect_ == nullptr) GTEST_SKIP() << "this build has no effect volumetric";
        for (std::uint32_t i = 0; i < frame_width * frame_height; ++i) {
            const float shade = static_cast<float>(i % frame_width) / 64;  // halves, all of them
            color_.insert(color_.end(), {shade, shade / 2, 0.25F, 1});
            depth_.push_back(static_cast<float>(wall) + static_cast<float>(i % 7) / 3);
        }
        camera_ = test::look_at({0, 0, 0}, {0, 0, -1}, 1, double{frame_width} / frame_height);
        // One without shadows lies between those that have some.
        lights_ = {striped_light(16, 3, 2), {.light = {.volumetric_intensity = 9}}, striped_light(5, 1, 1)};
        lights_[2].light.volumetric_color = {0, 1, 0};
        composer_.add(*effect_, nullptr);
        test::set_word(composer_, composer_.entry(0), "samples", 24);
        test::must(composer_.set(composer_.entry(0), "density", 40));
    }
    [[nodiscard]] DevelopInput input(std::span<const ReferenceLight> lights) const {
        return {.extent = {frame_width, frame_height},
                .color = color_,
                .depth = depth_,
                .lights = lights,
                .camera = camera_};
    }
    [[nodiscard]] std::vector<float> developed(std::span<const ReferenceLight> lights) {
        const Result<DevelopedPicture> picture = developer_.develop(composer_, input(lights));
        EXPECT_TRUE(picture) << picture.error().text;
        return picture ? picture->pixels : std::vector<float>{};
    }

    Device& device_ = gpu::test::device();
    const EffectInfo* effect_ = nullptr;
    std::vector<float> color_, depth_;
    Camera camera_;
    std::vector<ReferenceLight> lights_;
    Composer composer_{device_, {.frames_in_flight = 1}};
    Developer developer_{device_, {.target = DevelopTarget::SceneLinear}};
};

TEST_F(ComposeDeveloperLights, ThoseOfTheDeviceComeBackAndGiveTheSamePicture) {
    gpu::Context& context = device_.context();
    const auto upload = [&](const std::vector<float>& values, std::size_t channels, VkFormat format) {
        return gpu::test::upload(
            context,
            gpu::test::make_pixels(frame_width, frame_height,
                                   [&](std::uint32_t x, std::uint32_t y) {
                                       std::array<float, 4> texel{0, 0, 0, 1};
                                       std::copy_n(values.begin() +
                                                       static_cast<std::ptrdiff_t>((y * frame_width + x) * channels),
                                                   channels, texel.begin());
                                       return texel;
                                   }),
            format);
    };
    const gpu::test::Picture color = upload(color_, 4, VK_FORMAT_R16G16B16A16_SFLOAT);
    const gpu::test::Picture depth = upload(depth_, 1, VK_FORMAT_R32_SFLOAT);
    std::vector<gpu::Image> maps;
    std::vector<Light> lights;
    for (const ReferenceLight& light : lights_) {
        lights.push_back(light.light);
        if (light.cascades.empty()) continue;
        maps.push_back(test::upload_shadow_map(context, light));
        lights.back().cascades = test::shadow_map_ref(maps.back());
        lights.back().cascade_count = static_cast<std::uint32_t>(light.cascades.size());
    }
    DeviceFrame frame{.frame = {.color = test::image_ref(color),
                                .depth = test::image_ref(depth),
                                .camera = camera_,
                                .lights = lights},
                      .color_usage = color.image.info.usage};
    FrameLayers layers;
    for (int i = 0; i < 2; ++i) {  // again, since the first one must leave the images as they were
        const Result<DevelopedPicture> picture = developer_.develop(composer_, frame, &layers);
        ASSERT_TRUE(picture) << picture.error().text;
        ASSERT_EQ(layers.lights.size(), 3U);
        for (std::size_t light = 0; light < 3; ++light) {
            EXPECT_EQ(layers.lights[light].cascades, lights_[light].cascades) << light;
            EXPECT_EQ(layers.lights[light].resolution, lights_[light].resolution);
            EXPECT_EQ(layers.lights[light].light.splits, lights_[light].light.splits);
            EXPECT_EQ(layers.lights[light].light.world_to_cascade, lights_[light].light.world_to_cascade);
            EXPECT_EQ(layers.lights[light].light.volumetric_color, lights_[light].light.volumetric_color);
        }
        EXPECT_EQ(developed(layers.lights), picture->pixels);
    }
    const Result<FrameLayers> read = read_layers(device_, frame.frame, {});
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_EQ(read->lights[0].cascades, lights_[0].cascades);
}

TEST_F(ComposeDeveloperLights, AreTheReferencesLight) {
    const std::vector<float> dark = developed({});
    ASSERT_EQ(developer_.plan().left_out.size(), 1U);
    EXPECT_EQ(developer_.plan().left_out[0], "volumetric: needs shadows, which the frame does not have");
    const auto picture_of = [](const std::vector<float>& values, std::size_t channels) {
        ReferenceImage out(frame_width, frame_height);
        for (std::size_t i = 0; i < out.pixels.size(); ++i)
            out.pixels[i] = channels == 1 ? Rgba{values[i]} : Rgba{values[i * 4], values[i * 4 + 1], values[i * 4 + 2]};
        return out;
    };
    const ReferenceImage color = picture_of(color_, 4), depth = picture_of(depth_, 1);
    const auto reference = [&](std::span<const ReferenceLight> lights) {
        return test::must(run_reference(composer_, {.color = &color,
                                                    .images = {{FrameImage::Depth, &depth}},
                                                    .lights = lights,
                                                    .camera = camera_,
                                                    .target_domain = Domain::SceneLinear}));
    };
    EXPECT_EQ(reference({}).left_out, developer_.plan().left_out);
    // Other numbers of lights, and sizes, one after the other: nothing of the last one is left over.
    const std::vector<ReferenceLight> other{striped_light(9, 2, 3)};
    for (const std::vector<ReferenceLight>& lights : {lights_, other, lights_}) {
        const std::vector<float> lit = developed(lights);
        EXPECT_TRUE(developer_.plan().left_out.empty());
        const ReferenceChainOutput expected = reference(lights);
        double brightest = 0, worst = 0, sum = 0;
        for (std::size_t i = 0; i < frame_width * frame_height; ++i) {
            const Rgba& p = expected.picture.pixels[i];
            std::size_t channel = 0;
            for (const double value : {p.r, p.g, p.b}) {
                const double got = double{lit[i * 4 + channel]};
                brightest = std::max(brightest, got - double{dark[i * 4 + channel]});
                worst = std::max(worst, std::abs(got - value));
                sum += std::abs(got - value);
                ++channel;
            }
        }
        EXPECT_GT(brightest, 0.5);
        // As the effect's own: single precision finds another texel at the edge of a stripe here and there.
        EXPECT_LT(worst, brightest * 0.01);
        EXPECT_LT(sum / (frame_width * frame_height * 3), brightest * 0.001);
    }
}

TEST_F(ComposeDeveloperLights, WrongCascadesAreRefused) {
    const auto refusal = [&](const auto& change) {
        std::vector<ReferenceLight> lights = lights_;
        change(lights[2]);
        const Result<DevelopedPicture> picture = developer_.develop(composer_, input(lights));
        return picture ? "accepted" : picture.error().text;
    };
    EXPECT_EQ(refusal([](ReferenceLight&) {}), "accepted");
    EXPECT_EQ(refusal([](ReferenceLight& light) { light.cascades.resize(5); }),
              "light 2: 5 cascades, at most 4 are allowed");
    EXPECT_EQ(refusal([](ReferenceLight& light) { light.cascades[0].pop_back(); }),
              "light 2: a cascade of 24 numbers, 5x5 texels need 25");
    EXPECT_NE(refusal([](ReferenceLight& light) { light.resolution = 0; }).find("light 2: cascades of 0 texels a side"),
              std::string::npos);
    EXPECT_NE(refusal([](ReferenceLight& light) { light.resolution = 1u << 20; }).find("1048576 texels a side"),
              std::string::npos);
}

}  // namespace
}  // namespace darkroom
