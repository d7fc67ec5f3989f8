// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "render/frame_set.hpp"
#include "render/light/brdf_reference.hpp"
#include "render/light/shading_test_support.hpp"

namespace darkroom::render {
namespace {

using glm::dvec3;
using scene::vec3;
using scene::vec4;

/// Shadow map m lets 0.25 + m / 10 through.
std::string lights_body(const std::string& shade) {
    return test::frame_stand_in() +
           "float shadow_visibility(uint light, vec3 position, vec3 normal, float distance) {\n"
           "    return 0.25 + float(light) * 0.1;\n}\n"
           "const bool lamps_cast_shadows = true;\n"
           "float lamp_visibility(uint tile, uint tiles, vec3 position, vec3 normal, vec3 l) {\n"
           "    return 0.25 + float(tile) * 0.01 + float(tiles) * 0.03;\n}\n" +
           test::brdf_shader() + test::shader_part("light/lights.glsl") + "vec4 shade(Pixel pixel) {\n" + shade + "}\n";
}

// KHR_lights_punctual: max(min(1 - (distance / range)^4, 1), 0) / distance^2, and the square of a straight line between
// the cosines of the cone.
TEST(RenderLights, AttenuationIsThatOfTheExtension) {
    EXPECT_NEAR(reference::distance_attenuation(1, 10), 0.9999, 1e-12);
    EXPECT_NEAR(reference::distance_attenuation(5, 10), 0.0375, 1e-12);
    EXPECT_NEAR(reference::distance_attenuation(9, 10), 0.3439 / 81, 1e-12);
    EXPECT_EQ(reference::distance_attenuation(10, 10), 0);
    EXPECT_EQ(reference::distance_attenuation(11, 10), 0);
    EXPECT_EQ(reference::distance_attenuation(0, 10), 1e4);
    for (const auto& [cosine, light] : {std::pair(0.4, 0.0), {0.5, 0.0}, {0.6, 0.0625}, {0.7, 0.25}, {0.9, 1.0}})
        EXPECT_NEAR(reference::cone_attenuation(cosine, 0.5, 0.9), light, 1e-12) << cosine;
}

TEST(RenderGpuLights, AttenuationAgreesWithTheReference) {
    std::vector<vec4> distances;
    std::vector<dvec3> truth;
    for (int i = 0; i <= 240; ++i) {
        const auto distance = static_cast<float>(i) * 0.05F;
        distances.emplace_back(distance, 10, 0.01F * static_cast<float>(i - 120), 0);
        truth.emplace_back(reference::distance_attenuation(distance, 10),
                           reference::cone_attenuation(distances.back().z, std::cos(0.5), std::cos(0.3)), 0);
    }
    const std::vector<vec4> device = test::evaluate("attenuation", lights_body(R"(
    vec4 given = load(input_0, pixel.texel);
    return vec4(distance_attenuation(given.x * given.x, given.y), cone_attenuation(given.z, cos(0.5), cos(0.3)), 0, 1);
)"),
                                                    {distances});
    // The cosines of the cone differ by 0.0778, so their rounding, 6e-8, weighs 13 times as much.
    test::expect_close(device, truth, 1e-5, 4e-6);
}

TEST(RenderGpuLights, NothingDegenerateBecomesNotANumber) {
    const std::vector<vec4> device = test::evaluate("degenerate lights", lights_body(R"(
    vec4 given = load(input_0, pixel.texel);
    return vec4(distance_attenuation(given.x, given.y), cone_attenuation(given.z, given.w, given.w), 0, 1);
)"),
                                                    {{{0, 0, 1, 1}, {1, 0, 0.9F, 0.5F}, {1, 1e30F, 0.1F, 0.5F}}});
    EXPECT_TRUE(std::isfinite(device[0].x) && std::isfinite(device[0].y));
    EXPECT_EQ(vec4(device[1]), vec4(0, 1, 0, 1));  // no range; a cone with a hard edge, from inside
    EXPECT_EQ(vec4(device[2]), vec4(1, 0, 0, 1));  // endless; from outside
}

TEST(RenderGpuLights, HemisphereGoesFromGroundToSky) {
    const std::vector<vec4> device = test::evaluate("hemisphere", lights_body(R"(
    return vec4(hemisphere(load(input_0, pixel.texel).xyz, vec3(0.12, 0.13, 0.18), vec3(0.06, 0.05, 0.04)), 1);
)"),
                                                    {{{0, 1, 0, 0}, {0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0.5F, 0.5F, 0}}});
    const dvec3 sky(0.12, 0.13, 0.18), ground(0.06, 0.05, 0.04);
    test::expect_close(device, {sky, ground, (sky + ground) * 0.5, ground * 0.25 + sky * 0.75}, 1e-6, 0);
}

/// As many lights of every kind as there may be, as the block holds them.
struct Lights {
    blocks::Lights block{};

    explicit Lights(test::Directions& random) {
        const auto number = [&](double low, double high) {
            return static_cast<float>(low + (high - low) * random.number());
        };
        const auto color = [&](float w) { return vec4(number(0, 3), number(0, 3), number(0, 3), w); };
        const auto position = [&] { return vec4(random.on_sphere() * 3.0, number(2, 6)); };
        for (std::size_t i = 0; i < max_directional_lights; ++i) {
            // The second has shadow map 0 and the fourth shadow map 2.
            block.directional_direction[i] = vec4(random.on_sphere(), i % 2 == 0 ? -1.0 : double(i - 1));
            block.directional_color[i] = color(0);
        }
        for (std::size_t i = 0; i < max_point_lights; ++i) {
            block.point_position[i] = position();
            block.point_color[i] = color(i % 2 == 0 ? -1.0F : 6 * static_cast<float>(i));
        }
        for (std::size_t i = 0; i < max_spot_lights; ++i) {
            block.spot_position[i] = position();
            // Toward the middle, nearly.
            const dvec3 axis = -glm::normalize(dvec3(block.spot_position[i]) + random.on_sphere());
            block.spot_direction[i] = vec4(axis, 0.7);
            block.spot_color[i] = color(0.9F);
            block.spot_tiles[i] = vec4(i % 2 == 0 ? -1.0 : double(i), i % 3 == 0 ? 1 : 6, 0, 0);
        }
    }

    /// As the stand-in for shadows has it.
    [[nodiscard]] static double lamp_visibility(float tile, float tiles) {
        return tile < 0 ? 1 : 0.25 + double(tile) * 0.01 + double(tiles) * 0.03;
    }

    /// Sum over all lights in double precision.
    [[nodiscard]] dvec3 reflected(const reference::Reflectance& surface, const dvec3& position, const dvec3& n,
                                  const dvec3& v) const {
        dvec3 sum(0);
        for (std::size_t i = 0; i < max_directional_lights; ++i) {
            const vec4 direction = block.directional_direction[i];
            const double visibility = direction.w < 0 ? 1 : 0.25 + direction.w * 0.1;
            sum +=
                reference::reflected(surface, n, v, dvec3(direction)) * dvec3(block.directional_color[i]) * visibility;
        }
        for (std::size_t i = 0; i < max_point_lights; ++i) {
            const dvec3 to_light = dvec3(block.point_position[i]) - position;
            sum += reference::reflected(surface, n, v, glm::normalize(to_light)) * dvec3(block.point_color[i]) *
                   reference::distance_attenuation(glm::length(to_light), block.point_position[i].w) *
                   lamp_visibility(block.point_color[i].w, 6);
        }
        for (std::size_t i = 0; i < max_spot_lights; ++i) {
            const dvec3 to_light = dvec3(block.spot_position[i]) - position;
            const double cosine = glm::dot(dvec3(block.spot_direction[i]), -glm::normalize(to_light));
            sum += reference::reflected(surface, n, v, glm::normalize(to_light)) * dvec3(block.spot_color[i]) *
                   reference::distance_attenuation(glm::length(to_light), block.spot_position[i].w) *
                   reference::cone_attenuation(cosine, block.spot_direction[i].w, block.spot_color[i].w) *
                   lamp_visibility(block.spot_tiles[i].x, block.spot_tiles[i].y);
        }
        return sum;
    }

    /// The members one after the other, as the shader of the test reads them.
    [[nodiscard]] std::vector<vec4> row(std::size_t length) const {
        std::vector<vec4> out;
        const auto add = [&](const auto& member) { out.insert(out.end(), std::begin(member), std::end(member)); };
        add(block.directional_direction);
        add(block.directional_color);
        add(block.point_position);
        add(block.point_color);
        add(block.spot_position);
        add(block.spot_direction);
        add(block.spot_color);
        add(block.spot_tiles);
        out.resize(length);
        return out;
    }
};

TEST(RenderGpuLights, AllLightsTogetherAgreeWithTheReference) {
    test::Directions random(7);
    const Lights lights(random);
    constexpr std::size_t count = 1024;
    std::vector<std::vector<vec4>> inputs(3);
    std::vector<dvec3> truth;
    const dvec3 color(0.8, 0.5, 0.2);
    for (std::size_t i = 0; i < count; ++i) {
        const dvec3 n = random.on_sphere();
        const dvec3 v = random.around(n);
        inputs[0].emplace_back(n, random.number());
        inputs[1].emplace_back(v, random.number());
        const dvec3 position = random.on_sphere();
        inputs[2].emplace_back(position, 0);
        truth.push_back(lights.reflected(reference::reflectance(color, inputs[1].back().w, inputs[0].back().w),
                                         dvec3(inputs[2].back()), dvec3(inputs[0].back()), dvec3(inputs[1].back())));
    }
    inputs.push_back(lights.row(count));
    const std::vector<vec4> device = test::evaluate("lights", lights_body(R"(
    frame.light_counts = uvec4(4u, 16u, 8u, 0u);
    for (int i = 0; i < 4; ++i) {
        lights.directional_direction[i] = load(input_3, ivec2(i, 0));
        lights.directional_color[i] = load(input_3, ivec2(4 + i, 0));
    }
    for (int i = 0; i < 16; ++i) {
        lights.point_position[i] = load(input_3, ivec2(8 + i, 0));
        lights.point_color[i] = load(input_3, ivec2(24 + i, 0));
    }
    for (int i = 0; i < 8; ++i) {
        lights.spot_position[i] = load(input_3, ivec2(40 + i, 0));
        lights.spot_direction[i] = load(input_3, ivec2(48 + i, 0));
        lights.spot_color[i] = load(input_3, ivec2(56 + i, 0));
        lights.spot_tiles[i] = load(input_3, ivec2(i, 1));
    }
    vec4 n = load(input_0, pixel.texel);
    vec4 v = load(input_1, pixel.texel);
    Reflectance surface = reflectance(vec3(0.8, 0.5, 0.2), v.w, n.w);
    return vec4(reflected_lights(surface, load(input_2, pixel.texel).xyz, n.xyz, n.xyz, v.xyz, 1.0, true), 1);
)"),
                                                    inputs);
    // As for one light: directions are rounded, and the smoothest lobe is 1.6e-3 wide.
    test::expect_close(device, truth, 1e-3, 1e-5);
}

}  // namespace
}  // namespace darkroom::render
