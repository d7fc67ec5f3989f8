// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "render/light/shading_test_support.hpp"
#include "render/pass/sky_pass_test_support.hpp"

namespace darkroom::render {
namespace {

using gpu::test::download;
using gpu::test::must;
using gpu::test::Pixels;
using scene::vec2;
using scene::vec3;
using scene::vec4;

Picture colorful_sky(std::uint32_t width, std::uint32_t height) {
    Picture sky(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const vec3 d = uv_to_direction({(static_cast<float>(x) + 0.5F) / static_cast<float>(width),
                                            (static_cast<float>(y) + 0.5F) / static_cast<float>(height)});
            const vec4 value(3 + d.x + d.x * d.y, 4 + 2 * std::sin(9 * d.z) + d.y * d.z, std::exp(4 * d.y + d.x * d.z),
                             1);
            std::copy_n(&value.x, 4, sky.at(x, y));
        }
    return sky;
}

/// What a linear sampler reads that repeats u, or not, and clamps v.
vec4 sampled(const Picture& picture, vec2 uv, bool repeats) {
    const vec2 place = uv * vec2(picture.width, picture.height) - 0.5F, whole = glm::floor(place);
    const auto texel = [&](int dx, int dy) {
        const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
        int x = static_cast<int>(whole.x) + dx;
        x = repeats ? (x + width) % width : std::clamp(x, 0, width - 1);
        const int y = std::clamp(static_cast<int>(whole.y) + dy, 0, height - 1);
        const float* const at = picture.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
        return vec4(at[0], at[1], at[2], at[3]);
    };
    const vec2 part = place - whole;
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x), glm::mix(texel(0, 1), texel(1, 1), part.x), part.y);
}

vec4 texel(const Pixels& pixels, std::uint32_t x, std::uint32_t y) {
    const auto [r, g, b, a] = pixels.at(x, y);
    return {r, g, b, a};
}

constexpr VkExtent2D extent{32, 16};
constexpr float sky_roughness = 0.3F;

/// Pixels are directions as in a skybox, and n.v and roughness of the table.
struct Lookups {
    explicit Lookups(const Picture& sky)
        : stage(extent, sky,
                {.color = VK_FORMAT_R32G32B32A32_SFLOAT,
                 .normals = VK_FORMAT_R32G32B32A32_SFLOAT,
                 .velocity = VK_FORMAT_R32G32_SFLOAT}) {
        stage.frame.environment_settings.x = 3;
        const std::string main =
            "layout(location = 0) in vec2 clip_place;\nlayout(location = 0) out vec4 irradiance;\nlayout(location = 1) "
            "out vec4 reflection;\n"
            "layout(location = 2) out vec2 brdf;\nvoid main() {\n"
            "vec2 uv = clip_place * 0.5 + 0.5;\nvec2 angles = (uv - 0.5) * 3.14159265 * vec2(2, -1);\n"
            "vec3 n = vec3(cos(angles.y) * sin(angles.x), sin(angles.y), -cos(angles.y) * cos(angles.x));\n"
            "irradiance = vec4(environment_irradiance(n), 1);\n"
            "reflection = vec4(environment_reflection(n, 0.3), 1);\nvec2 place = (uv - 0.5) * 1.05 + 0.5;\nbrdf = "
            "environment_brdf(place.x, place.y);\n}\n";
        const gpu::Pipeline pipeline = must(gpu::Pipeline::create(
            stage.context, {.name = "environment lookups",
                            .vertex = shader_text("sky_vertex.glsl"),
                            .fragment = shader_text("frame.glsl") + test::shader_part("light/environment.glsl") + main,
                            .sets = {stage.setup().frame_layout},
                            .colors = stage.formats.colors({}, TargetFormats::Layers::Written),
                            .depth = stage.formats.depth}));
        stage.render([&](VkCommandBuffer commands, VkDescriptorSet set) {
            const gpu::Dispatch& vk = stage.context.vk;
            vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
            vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 0, 1, &set, 0,
                                     nullptr);
            vk.CmdDraw(commands, 3, 1, 0, 0);
        });
    }
    test::Stage stage;
};

vec2 place_of(std::uint32_t x, std::uint32_t y) {
    return {(static_cast<float>(x) + 0.5F) / extent.width, (static_cast<float>(y) + 0.5F) / extent.height};
}

TEST(RenderGpuEnvironment, ShadersReadWhatWasMade) {
    const Picture sky = colorful_sky(64, 32);
    const Lookups lookups(sky);
    const Pixels irradiance = download(lookups.stage.context, lookups.stage.color);
    const Pixels reflection = download(lookups.stage.context, lookups.stage.normals);
    const Pixels brdf = download(lookups.stage.context, lookups.stage.velocity);
    const std::array<vec3, 9> c = irradiance_harmonics(sky);
    const std::vector<Picture> levels = prefilter(sky, 64, lookups.stage.environment.levels);
    const Picture table = split_sum_table(64);
    const float level = sky_roughness * static_cast<float>(levels.size() - 1);
    const auto low = static_cast<std::size_t>(level);
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x) {
            const vec2 uv = place_of(x, y);
            const vec3 n = uv_to_direction(uv);
            const vec3 light = c[0] * 0.282095F + (c[1] * n.y + c[2] * n.z + c[3] * n.x) * 0.488603F +
                               (c[4] * n.x * n.y + c[5] * n.y * n.z + c[7] * n.x * n.z) * 1.092548F +
                               c[6] * 0.315392F * (3 * n.z * n.z - 1) + c[8] * 0.546274F * (n.x * n.x - n.y * n.y);
            const vec4 mirror =
                glm::mix(sampled(levels[low], uv, true), sampled(levels[low + 1], uv, true), level - std::floor(level));
            for (int channel = 0; channel < 3; ++channel) {
                EXPECT_NEAR(texel(irradiance, x, y)[channel], 3 * std::max(light[channel], 0.0F), 1e-2)
                    << x << ", " << y << ", " << channel;
                // Weights of texels have eight bits on many devices, and texels are half floats.
                EXPECT_NEAR(texel(reflection, x, y)[channel], 3 * mirror[channel], 0.02 * 3 * mirror[channel])
                    << x << ", " << y << ", " << channel;
            }
            const vec2 beyond = (uv - 0.5F) * 1.05F + 0.5F;  // a little over the table's edges, too
            for (int channel = 0; channel < 2; ++channel)
                EXPECT_NEAR(texel(brdf, x, y)[channel], sampled(table, beyond, false)[channel], 5e-3)
                    << x << ", " << y << ", " << channel;
        }
}

TEST(RenderGpuEnvironment, NothingIsDarkerThanBlack) {
    Picture sky(64, 32);
    for (std::uint32_t x = 0; x < 4; ++x) sky.at(x, 3)[1] = 5000;
    const Lookups lookups(sky);
    const Pixels irradiance = download(lookups.stage.context, lookups.stage.color);
    float least = 1, most = 0;
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x) {
            least = std::min(least, texel(irradiance, x, y).g);
            most = std::max(most, texel(irradiance, x, y).g);
        }
    EXPECT_EQ(least, 0);
    EXPECT_GT(most, 10);
}

TEST(RenderGpuEnvironment, ASunTooBrightForHalfIsKept) {
    Picture sky(2, 1);
    sky.at(1, 0)[0] = 1e6F;
    EXPECT_EQ(must(GpuEnvironment::create(gpu::test::context(), sky)).skybox.info.format,
              VK_FORMAT_R32G32B32A32_SFLOAT);
    sky.at(1, 0)[0] = 65504;
    EXPECT_EQ(must(GpuEnvironment::create(gpu::test::context(), sky)).skybox.info.format,
              VK_FORMAT_R16G16B16A16_SFLOAT);
}

TEST(RenderGpuEnvironment, ASkyWiderThanTheDeviceAllowsIsMadeSmaller) {
    gpu::Context& context = gpu::test::context();
    const std::uint32_t most = context.traits.max_image_dimension;
    Picture sky(most + 2, 1);
    std::ranges::fill(sky.pixels, 3.0F);
    const GpuEnvironment environment = must(GpuEnvironment::create(context, sky));
    EXPECT_EQ(environment.skybox.info.extent.width, most);
    EXPECT_NEAR(environment.irradiance[0].r * 0.282095, 3, 1e-4);
}

TEST(RenderGpuEnvironment, WithoutASkyboxThereIsBlack) {
    const GpuEnvironment environment = must(GpuEnvironment::create(gpu::test::context(), std::nullopt));
    EXPECT_FALSE(environment.is_given);
    EXPECT_EQ(environment.levels, 1U);
    for (const gpu::Image* image : {&environment.prefiltered, &environment.skybox, &environment.split_sum})
        EXPECT_EQ(image->info.extent.width, 1U);
    for (const vec3& harmonic : environment.irradiance) EXPECT_EQ(harmonic, vec3(0));
}

}  // namespace
}  // namespace darkroom::render
