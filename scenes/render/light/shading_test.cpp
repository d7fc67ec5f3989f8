// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/light/brdf_reference.hpp"
#include "render/light/shading_test_bench.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom::render {
namespace {

using glm::dvec3;
using scene::vec3;
using scene::vec4;

using test::FragmentBench;
using test::Range;
using test::Shape;
using test::Switches;
using Pixels = gpu::test::Pixels;

constexpr std::uint32_t last = FragmentBench::size - 1;
constexpr std::uint32_t middle = FragmentBench::size / 2;

void set_directional(FragmentBench& bench, const dvec3& toward_light, const vec3& color) {
    bench.frame.light_counts.x = 1;
    bench.lights.directional_direction[0] = vec4(toward_light, -1);
    bench.lights.directional_color[0] = vec4(color, 0);
}

reference::Reflectance reflectance_of(const FragmentBench& bench) {
    return reference::reflectance(dvec3(bench.material.base_color), bench.material.factors.x, bench.material.factors.y);
}

/// Everywhere on the plane, every third pixel; `truth(position)` is dvec3.
template <class Truth>
void expect_plane(FragmentBench& bench, double relative, double absolute, Truth truth) {
    const Pixels color = bench.draw({}).color;
    std::vector<vec4> values;
    std::vector<dvec3> truths;
    for (std::uint32_t y = 0; y <= last; y += 3) {
        for (std::uint32_t x = 0; x <= last; x += 3) {
            const auto [r, g, b, a] = color.at(x, y);
            values.emplace_back(r, g, b, a);
            truths.push_back(truth(bench.position(x, y)));
            EXPECT_EQ(a, 1);
        }
    }
    test::expect_close(values, truths, relative, absolute);
}

void expect_color(const Pixels& pixels, std::uint32_t x, std::uint32_t y, const vec4& truth, double tolerance = 1e-5) {
    const auto value = pixels.at(x, y);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(value[c], truth[c], tolerance) << x << ' ' << y << ' ' << c;
}

TEST(RenderGpuShading, PlaneUnderADirectionalLight) {
    FragmentBench bench(Shape::Plane);
    bench.material.base_color = vec4(0.8, 0.5, 0.2, 1);
    set_directional(bench, {0, 1, 0}, {2, 3, 4});
    // Straight from above and back: all but the 0.04 that is mirrored enters, and 21 / 20 of the mean of what leaves in
    // all directions leaves there; the widest lobe has 1 / pi in all directions.
    const double specular = 0.04 / (std::numbers::pi * 4);
    const dvec3 overhead = dvec3(2, 3, 4) * (dvec3(0.8, 0.5, 0.2) * 0.96 * 1.05 / std::numbers::pi + specular);
    expect_plane(bench, 1e-5, 0, [&](const dvec3&) { return overhead; });

    const dvec3 slanted = glm::normalize(dvec3(1, 0.5, -2));
    set_directional(bench, slanted, {2, 3, 4});
    bench.material.factors.y = 0.4F;
    expect_plane(bench, 1e-5, 0, [&](const dvec3&) {
        return dvec3(2, 3, 4) * reference::reflected(reflectance_of(bench), {0, 1, 0}, {0, 1, 0}, slanted);
    });
    set_directional(bench, -slanted, {2, 3, 4});
    expect_plane(bench, 0, 1e-30, [](const dvec3&) { return dvec3(0); });
}

TEST(RenderGpuShading, PointAndSpotLightsFallOffOverThePlane) {
    FragmentBench bench(Shape::Plane);
    const dvec3 place(0.25, 0.5, -0.125);
    const auto from_light = [&](const dvec3& position, double range) {
        const dvec3 to_light = place - position;
        return dvec3(5, 4, 3) * reference::distance_attenuation(glm::length(to_light), range) *
               reference::reflected(reflectance_of(bench), {0, 1, 0}, {0, 1, 0}, glm::normalize(to_light));
    };
    bench.frame.light_counts.y = 1;
    bench.lights.point_position[0] = vec4(place, 1.5);
    bench.lights.point_color[0] = vec4(5, 4, 3, 0);
    expect_plane(bench, 2e-5, 1e-6, [&](const dvec3& position) { return from_light(position, 1.5); });

    bench.frame.light_counts = scene::uvec4(0, 0, 1, 0);
    bench.lights.spot_position[0] = vec4(place, 4);
    bench.lights.spot_direction[0] = vec4(0, -1, 0, std::cos(0.5));
    bench.lights.spot_color[0] = vec4(5, 4, 3, std::cos(0.3));
    int lit = 0;
    expect_plane(bench, 5e-5, 1e-5, [&](const dvec3& position) {
        const dvec3 to_light = place - position;
        const double cosine = to_light.y / glm::length(to_light);
        lit += cosine > std::cos(0.5);
        return from_light(position, 4) * reference::cone_attenuation(cosine, std::cos(0.5), std::cos(0.3));
    });
    EXPECT_GT(lit, 10);  // 0.5 * tan(0.5) of the plane's half width
    EXPECT_LT(lit, 40);
}

TEST(RenderGpuShading, SphereUnderADirectionalLight) {
    FragmentBench bench(Shape::Sphere);
    bench.material.base_color = vec4(0.6, 0.4, 0.9, 1);
    bench.material.factors.y = 0.35F;
    const dvec3 eye(0, 0, 1), light = glm::normalize(dvec3(1, 1, 0.5));
    set_directional(bench, light, vec3(3));
    const Pixels color = bench.draw({}).color;
    std::vector<vec4> values;
    std::vector<dvec3> truth;
    const auto reflected_at = [&](double x, double y) {
        return 3.0 * reference::reflected(reflectance_of(bench), bench.position_at(x, y), eye, light);
    };
    Range brightest_shown;
    dvec3 brightest(0);
    double most = 0;
    for (std::uint32_t y = 0; y <= last; ++y) {
        for (std::uint32_t x = 0; x <= last; ++x) {
            const dvec3 n = bench.position(x, y);
            if (n.z < 0.3) continue;  // facets miss the outline
            const auto [r, g, b, a] = color.at(x, y);
            values.emplace_back(r, g, b, a);
            const Range shown = test::around_center(x, y, reflected_at);
            truth.push_back(glm::clamp(dvec3(r, g, b), shown.low, shown.high));
            if (g > most) {
                most = g;
                brightest = n;
                brightest_shown = shown;
            }
        }
    }
    // 96 facets around: between them a direction is off by up to (pi / 96)^2 / 8 over the cosine to the eye.
    test::expect_close(values, truth, 4e-3, 2e-3);
    // The highlight is where the normal halves the angle, within a pixel: 2 / 64.
    EXPECT_NEAR(glm::length(brightest - glm::normalize(light + eye)), 0, 2.0 / 64);
    EXPECT_NEAR(most / std::clamp(most, brightest_shown.low.y, brightest_shown.high.y), 1, 4e-3);
}

TEST(RenderGpuShading, SurroundingsOfWhiteMakeWhite) {
    FragmentBench bench(Shape::Sphere);
    bench.environment = FragmentBench::one(vec4(1));
    bench.scale_and_bias = vec4(0.8, 0.05, 0, 0);
    bench.frame.environment_settings.x = 1;
    bench.frame.irradiance[0] = vec4(1 / 0.28209479F);
    for (const float metallic : {0.0F, 1.0F}) {
        bench.material.factors = vec4(metallic, 0.5, 1, 1);
        const Pixels color = bench.draw({.has_environment = 1}).color;
        for (std::uint32_t y = 0; y <= last; ++y) {
            for (std::uint32_t x = 0; x <= last; ++x) {
                if (bench.position(x, y).z > 0.1) expect_color(color, x, y, vec4(1), 2e-6);
            }
        }
    }
}

TEST(RenderGpuShading, SurroundingsAreSeenByNormalAndMirrored) {
    FragmentBench bench(Shape::Sphere);
    bench.frame.environment_settings.x = 1;
    bench.frame.irradiance[0] = vec4(0.5F / 0.28209479F);
    bench.frame.irradiance[1] = vec4(0.5F / 0.48860251F);
    constexpr std::uint32_t rows = 64;
    bench.environment = gpu::test::make_pixels(1, rows, [](std::uint32_t, std::uint32_t y) {
        const double height = std::sin((0.5 - (y + 0.5) / rows) * std::numbers::pi);
        const auto value = static_cast<float>(0.5 + 0.5 * height);
        return std::array{value, value, value, 1.0F};
    });
    for (const float metallic : {0.0F, 1.0F}) {
        bench.material.factors.x = metallic;
        // A table of nothing leaves the diffuse part alone; one of F0 itself makes white metal a mirror.
        bench.scale_and_bias = vec4(metallic, 0, 0, 0);
        const Pixels color = bench.draw({.has_environment = 1}).color;
        for (const std::uint32_t y : {10U, 20U, middle, 50U}) {
            const dvec3 n = bench.position(middle, y);
            const double mirrored = 2 * n.z * n.y;
            expect_color(color, middle, y, vec4(dvec3(0.5 + 0.5 * (metallic == 0 ? n.y : mirrored)), 1), 4e-3);
        }
    }
}

TEST(RenderGpuShading, HemisphereIsByHeightOfTheNormalAndOccludedAlone) {
    FragmentBench bench(Shape::Sphere);
    const dvec3 sky(0.12, 0.13, 0.18), ground(0.06, 0.05, 0.04);
    bench.frame.ambient_sky = vec4(sky, 0);
    bench.frame.ambient_ground = vec4(ground, 0);
    bench.material.base_color = vec4(0.5, 1, 1, 1);
    bench.material.factors = vec4(0, 1, 1, 0.5);
    bench.material.emissive = vec4(0.5, 0.25, 0, 0);
    bench.textures[3] = FragmentBench::one({0.2F, 0.9F, 0.9F, 1});
    set_directional(bench, {0, 0, 1}, vec3(1));
    const Pixels lit = bench.draw({.has_textures = 1}).color;
    bench.frame.light_counts.x = 0;
    const Pixels unoccluded = bench.draw({}).color;
    for (const std::uint32_t y : {8U, middle, 56U}) {
        const dvec3 n = bench.position(middle, y);
        const dvec3 ambient = dvec3(0.5, 1, 1) * reference::hemisphere(n, sky, ground);
        const dvec3 glow(0.5, 0.25, 0);
        const dvec3 direct = reference::reflected(reflectance_of(bench), n, {0, 0, 1}, {0, 0, 1});
        expect_color(unoccluded, middle, y, vec4(ambient + glow, 1), 1e-3);
        expect_color(lit, middle, y, vec4(ambient * 0.6 + direct + glow, 1), 1e-3);
    }
}

TEST(RenderGpuShading, ColorsMultiplyAndEmissionAdds) {
    FragmentBench bench(Shape::Plane);
    bench.vertex.color = vec4(0.5, 1, 0.25, 0.5);
    bench.material.base_color = vec4(0.8, 0.5, 1, 0.5);
    bench.material.emissive = vec4(4, 2, 1, 0);
    bench.material.flags.x = 0;
    bench.textures[4] = FragmentBench::one({0.5F, 0.25F, 2, 1});
    // In the second set u and v are exchanged; the transform then takes u from the right to the left.
    bench.textures[0] = gpu::test::make_pixels(2, 2, [](std::uint32_t x, std::uint32_t y) {
        return std::array{x == 1 ? 1.0F : 0.5F, y == 1 ? 1.0F : 0.5F, 1.0F, 1.0F};
    });
    const Pixels glowing = bench.draw({.has_textures = 1}).color;
    expect_color(glowing, 5, 9, vec4(2, 0.5, 2, 1));
    const Pixels untextured = bench.draw({}).color;
    expect_color(untextured, 5, 9, vec4(4, 2, 1, 1));

    bench.material.flags = scene::uvec4(1, 1, 0, 0);  // unlit
    const vec4 plain(0.4, 0.5, 0.25, 1);
    Pixels color = bench.draw({.has_textures = 1}).color;
    expect_color(color, 0, 0, plain * vec4(0.5, 0.5, 1, 1));
    expect_color(color, last, 0, plain * vec4(1, 0.5, 1, 1));
    bench.material.flags.z = 1;
    color = bench.draw({.has_textures = 1}).color;
    expect_color(color, last, 0, plain * vec4(0.5, 1, 1, 1));
    bench.material.uv_rows[0] = vec4(-1, 0, 1, 0);
    color = bench.draw({.has_textures = 1, .is_transparent = 1}).color;
    expect_color(color, last, 0, vec4(0.4, 0.5, 0.25, 0.25));
    expect_color(color, last, last, vec4(0.2, 0.5, 0.25, 0.25));
}

TEST(RenderGpuShading, NormalsAreMappedByTangentsGivenOrNot) {
    const auto mapped = [](FragmentBench& bench, const vec3& texel) {
        bench.textures[2] = FragmentBench::one(vec4(texel * 0.5F + 0.5F, 1));
        bench.material.flags.y = 4;
        const auto [x, y, z, w] = bench.draw({.has_textures = 1}).normal.at(20, 40);
        EXPECT_EQ(w, 1);
        return vec3(x, y, z);
    };
    const auto expect_near = [](const vec3& normal, const vec3& truth) {
        EXPECT_LT(glm::length(normal - truth), 1e-5) << normal.x << ' ' << normal.y << ' ' << normal.z;
    };
    // u is along x and v along z, so the texel's y, which points up in the picture, is along -z.
    FragmentBench bench(Shape::Plane);
    for (const vec4& tangent : {vec4(0), vec4(2, 0, 0, 1)}) {
        bench.vertex.tangent = tangent;
        expect_near(mapped(bench, {0.6F, 0, 0.8F}), {0.6F, 0.8F, 0});
        expect_near(mapped(bench, {0, 0.6F, 0.8F}), {0, 0.8F, -0.6F});
    }
    bench.vertex.tangent = vec4(1, 1, 0, -1);  // mirrored, and leaning
    expect_near(mapped(bench, {0, 0.6F, 0.8F}), {0, 0.8F, 0.6F});
    bench.vertex = {.uv = vec4(-1, 1, 0, 0)};
    expect_near(mapped(bench, {0.6F, 0, 0.8F}), {-0.6F, 0.8F, 0});
    expect_near(mapped(bench, {0, 0.6F, 0.8F}), {0, 0.8F, -0.6F});
    bench.vertex.uv = vec4(0);  // nothing to go by
    expect_near(mapped(bench, {0.6F, 0, 0.8F}), {0, 1, 0});
    bench.vertex = {};
    bench.material.factors.z = 0.5F;
    expect_near(mapped(bench, {0.6F, 0, 0.8F}), glm::normalize(vec3(0.3F, 0.8F, 0)));

    // Seen from behind, a bump is a dent.
    FragmentBench back(Shape::PlaneFromBack);
    expect_near(mapped(back, {0.6F, 0, 0.8F}), {0.6F, 0.8F, 0});
    back.material.flags.x = 4;
    expect_near(mapped(back, {0.6F, 0, 0.8F}), {-0.6F, -0.8F, 0});
}

TEST(RenderGpuShading, MasksDiscardBelowTheirCutoff) {
    FragmentBench bench(Shape::Plane);
    bench.material.flags.x = 1 | 2;
    bench.material.base_color.a = 0.8F;
    bench.material.emissive.w = 0.3F;
    bench.textures[0] = gpu::test::make_pixels(2, 1, [](std::uint32_t x, std::uint32_t) {
        return std::array{1.0F, 1.0F, 1.0F, x == 0 ? 0.35F : 0.4F};
    });
    const Pixels color = bench.draw({.has_textures = 1, .is_masked = 1}).color;
    expect_color(color, 0, middle, vec4(0));
    expect_color(color, last, middle, vec4(1));
}

TEST(RenderGpuShading, DebugViewsAreDisplayValues) {
    FragmentBench bench(Shape::Plane);
    bench.material.base_color = vec4(0.5, 0.25, 2, 0.5);
    bench.material.factors = vec4(0.75, 0.25, 1, 1);
    bench.material.emissive = vec4(9);
    const auto view = [&](DebugView debug) {
        return bench.draw({.output = 1, .debug = static_cast<std::uint32_t>(debug), .is_tone_mapped = 1}).color;
    };
    expect_color(view(DebugView::Wireframe), 3, 4, vec4(1));
    expect_color(view(DebugView::Normals), 3, 4, vec4(0.5, 1, 0.5, 1));
    expect_color(view(DebugView::MetalRough), 3, 4, vec4(0.75, 0.25, 0, 1));
    bench.textures[1] = FragmentBench::one({0.9F, 0.5F, 0.25F, 1});  // green: roughness; blue: metallic
    const auto metal_rough = static_cast<std::uint32_t>(DebugView::MetalRough);
    expect_color(bench.draw({.has_textures = 1, .output = 1, .debug = metal_rough}).color, 3, 4,
                 vec4(0.1875, 0.125, 0, 1));
    expect_color(view(DebugView::Unlit), 3, 4, vec4(0.735357, 0.537099, 1, 1));
    // Ten metres away, between 1 and 100: the middle of a logarithmic scale.
    expect_color(view(DebugView::Depth), 3, 4, vec4(0.5, 0.5, 0.5, 1));
    bench.vertex.uv = vec4(1, 1, 2, -1);
    expect_color(view(DebugView::Uv), 3, 4, vec4(3.5 / 64, 4.5 / 64, 0, 1));
}

TEST(RenderGpuShading, DisplayIsTheHdrPictureFinished) {
    FragmentBench bench(Shape::Sphere);
    set_directional(bench, glm::normalize(dvec3(1, 1, 1)), vec3(4, 3, 2));
    const Pixels hdr = bench.draw({}).color;
    const Pixels plain = bench.draw({.output = 1}).color;
    const Pixels mapped = bench.draw({.output = 1, .is_tone_mapped = 1}).color;
    for (std::size_t i = 0; i < hdr.rgba.size(); ++i) {
        const double x = hdr.rgba[i];
        if (i % 4 == 3) continue;
        EXPECT_NEAR(plain.rgba[i], srgb_encoded(std::min(x, 1.0)), 1e-5);
        EXPECT_NEAR(mapped.rgba[i], srgb_encoded(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)), 1e-5);
    }
}

TEST(RenderGpuShading, LayersHoldNormalsAndMotion) {
    FragmentBench bench(Shape::Sphere);
    const FragmentBench::Targets targets = bench.draw({});
    for (const std::uint32_t x : {10U, middle, 50U}) {
        expect_color(targets.normal, x, 20, vec4(bench.position(x, 20), 1), 2e-3);
        // Half a clip unit to the right and a quarter down, a moment ago.
        expect_color(targets.velocity, x, 20, vec4(16, 8, 0, 1));
    }
    expect_color(targets.normal, 0, 0, vec4(0));
}

TEST(RenderGpuShading, BrokenMaterialsStayFinite) {
    FragmentBench bench(Shape::Plane);
    bench.material.emissive = vec4(std::nanf(""), INFINITY, -5, 0);
    expect_color(bench.draw({}).color, 1, 1, vec4(0, 65504, 0, 1));
}

}  // namespace
}  // namespace darkroom::render
