// SPDX-License-Identifier: MIT
#include "render/light/brdf_reference.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "render/light/environment.hpp"
#include "render/light/shading_test_support.hpp"

namespace darkroom::render {
namespace {

using glm::dvec2;
using glm::dvec3;
using reference::Reflectance;
using scene::vec4;

constexpr std::array roughnesses{0.04, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
constexpr std::array cosines{0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0};
const dvec3 up(0, 0, 1);

dvec3 toward(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

/// All that leaves toward `v` of light of radiance 1 from everywhere. Microfacets are placed at the quantiles of their
/// own distribution (Walter et al. 2007, equations 35 and 14), light of the diffuse part at those of the cosine.
dvec3 albedo(const Reflectance& surface, const dvec3& v) {
    constexpr int steps = 64;
    const double alpha = surface.roughness * surface.roughness;
    dvec3 sum(0);
    for (int i = 0; i < steps; ++i) {
        const double u = (i + 0.5) / steps;
        const double cosine = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u));
        const double sine = std::sqrt(1 - cosine * cosine);
        for (int j = 0; j < steps; ++j) {
            const double angle = 2 * std::numbers::pi * (j + 0.5) / steps;
            const dvec3 around(std::cos(angle), std::sin(angle), 0);
            const dvec3 h = around * sine + up * cosine;
            const dvec3 l = h * (2 * glm::dot(v, h)) - v;
            if (glm::dot(v, h) > 0 && l.z > 0) {
                const double density = reference::ggx_distribution(cosine, alpha) * cosine / (4 * glm::dot(v, h));
                sum += reference::brdf(surface, up, v, l).specular * (l.z / density);
            }
            const dvec3 diffuse_light = around * std::sqrt(u) + up * std::sqrt(1 - u);
            sum += reference::brdf(surface, up, v, diffuse_light).diffuse * std::numbers::pi;
        }
    }
    return sum / double(steps * steps);
}

TEST(RenderBrdf, MicrofacetsCoverTheSurfaceExactly) {
    for (const double roughness : roughnesses) {
        const double alpha = roughness * roughness;
        constexpr int steps = 4000;
        double covered = 0;
        for (int i = 0; i < steps; ++i) {
            // tan(angle) = alpha s / (1 - s) puts equally many steps inside the lobe and outside it.
            const double s = (i + 0.5) / steps;
            const double tangent = alpha * s / (1 - s);
            const double cosine = 1 / std::sqrt(1 + tangent * tangent);
            const double angle_step = alpha / ((1 - s) * (1 - s)) * cosine * cosine / steps;
            const double ring = 2 * std::numbers::pi * tangent * cosine * angle_step;
            covered += reference::ggx_distribution(cosine, alpha) * cosine * ring;
        }
        EXPECT_NEAR(covered, 1, 1e-5) << roughness;
    }
}

TEST(RenderBrdf, ShadowingIsAShareThatGrowsWithTheCosine) {
    const auto share = [](double n_dot_v, double n_dot_l, double alpha) {
        return reference::smith_visibility(n_dot_v, n_dot_l, alpha) * 4 * n_dot_v * n_dot_l;
    };
    for (const double roughness : roughnesses) {
        double before = 0;
        for (const double cosine : cosines) {
            const double found = share(cosine, 0.5, roughness * roughness);
            EXPECT_GT(found, before);
            EXPECT_LE(found, 1);
            before = found;
        }
        EXPECT_DOUBLE_EQ(share(1, 1, roughness * roughness), 1);
        EXPECT_EQ(reference::smith_visibility(0, 1, roughness * roughness), 0);
    }
}

// One visibility term: what a light from each direction gives adds up to what the table of the surroundings says.
TEST(RenderBrdf, LightsFromEverywhereAreTheSplitSum) {
    constexpr std::uint32_t size = 16;
    const Picture table = split_sum_table(size);
    for (std::uint32_t y = 2; y < size; y += 3) {
        for (std::uint32_t x = 1; x < size; x += 3) {
            const Reflectance white = reference::reflectance(dvec3(1), 1, (y + 0.5) / size);
            const float* const texel = table.at(x, y);
            // 4e-3 of this quadrature, 0.01 of the table's (TruthEnvironment).
            EXPECT_NEAR(albedo(white, toward((x + 0.5) / size)).x, texel[0] + texel[1], 0.0145) << x << ' ' << y;
        }
    }
}

TEST(RenderBrdf, LightMayGoEitherWay) {
    test::Directions random(1);
    for (int i = 0; i < 1000; ++i) {
        const Reflectance surface = reference::reflectance({0.9, 0.5, 0.2}, random.number(), random.number());
        const dvec3 v = random.around(up);
        const dvec3 l = random.around(up);
        const reference::Brdf one = reference::brdf(surface, up, v, l);
        const reference::Brdf other = reference::brdf(surface, up, l, v);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(one.diffuse[c], other.diffuse[c], 1e-12);
            EXPECT_NEAR(one.specular[c], other.specular[c], 1e-9 * (1 + one.specular[c]));
        }
    }
}

// The quadrature is off by 4e-3 at most, seen by quadrupling its steps; where it comes near 1, by 1e-4.
TEST(RenderBrdf, MetalInWhiteLightIsNeverBrighterThanWhite) {
    for (const double roughness : roughnesses) {
        const Reflectance white = reference::reflectance(dvec3(1), 1, roughness);
        for (const double cosine : cosines) {
            const double leaves = albedo(white, toward(cosine)).x;
            EXPECT_LE(leaves, 1 + 1e-4) << roughness << ' ' << cosine;
            EXPECT_GT(leaves, 0.01) << roughness << ' ' << cosine;
        }
    }
}

TEST(RenderBrdf, SingleScatteringLosesThisMuchHeadOn) {
    constexpr std::array<std::array<double, 2>, 5> kept{
        {{0.04, 1.0000}, {0.3, 0.9907}, {0.5, 0.9158}, {0.7, 0.6978}, {1.0, 0.3069}}};
    for (const auto& [roughness, share] : kept) {
        const Reflectance white = reference::reflectance(dvec3(1), 1, roughness);
        EXPECT_NEAR(albedo(white, up).x, share, 7e-3) << roughness;
        if (roughness < 0.5) continue;
        // The same by rings of light of equal solid angle, which smooth lobes would slip through.
        constexpr int rings = 2000;
        double sum = 0;
        for (int i = 0; i < rings; ++i) sum += reference::reflected(white, up, up, toward((i + 0.5) / rings)).x;
        EXPECT_NEAR(sum * 2 * std::numbers::pi / rings, share, 1e-4) << roughness;
    }
}

// What enters a matte base and leaves it goes through the layer twice, so that nothing is gained.
TEST(RenderBrdf, DielectricsOfRealAlbedoAreNeverBrighterThanTheLight) {
    for (const double roughness : roughnesses) {
        for (const double cosine : cosines) {
            const Reflectance brightest = reference::reflectance(dvec3(0.89), 0, roughness);
            EXPECT_LE(albedo(brightest, toward(cosine)).x, 1) << roughness << ' ' << cosine;
            const Reflectance white = reference::reflectance(dvec3(1), 0, roughness);
            EXPECT_LE(albedo(white, toward(cosine)).x, 1.002) << roughness << ' ' << cosine;
        }
    }
}

TEST(RenderBrdf, ReflectionInWhiteSurroundingsIsWhite) {
    // Whatever the table holds: what single scattering loses comes back.
    for (const double scale : {0.01, 0.3, 0.7, 0.98}) {
        for (const double bias : {0.0, 0.01, 0.02}) {
            for (const double metallic : {0.0, 1.0}) {
                const Reflectance white = reference::reflectance(dvec3(1), metallic, 0.5);
                const dvec3 leaves = reference::reflected_surroundings(white, dvec3(1), dvec3(1), {scale, bias});
                EXPECT_NEAR(leaves.x, 1, 1e-12) << scale << ' ' << bias << ' ' << metallic;
            }
            const Reflectance grey = reference::reflectance(dvec3(0.5), 0.5, 0.5);
            const dvec3 leaves = reference::reflected_surroundings(grey, dvec3(1), dvec3(1), {scale, bias});
            EXPECT_LT(leaves.x, 1);
        }
    }
}

TEST(RenderGpuBrdf, ShaderAgreesWithTheReference) {
    test::Directions random(2);
    std::vector<std::vector<vec4>> inputs(4);
    std::vector<dvec3> truth;
    for (int i = 0; i < 4096; ++i) {
        const dvec3 n = random.on_sphere();
        const dvec3 v = random.around(n);
        // Half of the light comes from near the mirrored direction: few others meet a highlight.
        const dvec3 mirrored = n * (2 * glm::dot(n, v)) - v;
        dvec3 l = i % 2 == 0 ? random.around(n) : glm::normalize(mirrored + random.on_sphere() * 0.02);
        const dvec3 color(random.number(), random.number(), random.number());
        const vec4 material(color, static_cast<float>(random.number()));
        const auto roughness = static_cast<float>(random.number());
        inputs[0].emplace_back(n, roughness);
        inputs[1].emplace_back(v, 0);
        inputs[2].emplace_back(l, 0);
        inputs[3].push_back(material);
        // The reference starts from the numbers that the shader gets.
        const auto given = [](const vec4& value) { return glm::normalize(dvec3(value)); };
        truth.push_back(reference::reflected(reference::reflectance(dvec3(material), material.w, roughness),
                                             given(inputs[0].back()), given(inputs[1].back()),
                                             given(inputs[2].back())));
    }
    const std::vector<vec4> device = test::evaluate("brdf", test::brdf_shader() + R"(
vec4 shade(Pixel pixel) {
    vec4 n = load(input_0, pixel.texel);
    vec4 material = load(input_3, pixel.texel);
    Reflectance surface = reflectance(material.rgb, material.a, n.w);
    return vec4(reflected(surface, n.xyz, load(input_1, pixel.texel).xyz, load(input_2, pixel.texel).xyz), 1.0);
}
)",
                                                    inputs);
    // Directions are rounded to 6e-8; in the smoothest lobe, 1.6e-3 wide, that alone is 1.5e-4 of its value.
    test::expect_close(device, truth, 5e-4, 1e-6);
}

TEST(RenderGpuBrdf, NothingDegenerateBecomesNotANumber) {
    std::vector<std::vector<vec4>> inputs(3);
    const std::array<vec4, 4> directions{vec4(0, 1, 0, 0), vec4(0, -1, 0, 0), vec4(1, 0, 0, 0), vec4(-1, 0, 0, 0)};
    for (const float roughness : {0.0F, 0.5F, 1.0F}) {
        for (const vec4& v : directions) {
            for (const vec4& l : directions) {
                inputs[0].emplace_back(0, 1, 0, roughness);
                inputs[1].push_back(v);
                inputs[2].push_back(l);
            }
        }
    }
    const std::vector<vec4> device = test::evaluate("degenerate", test::brdf_shader() + R"(
vec4 shade(Pixel pixel) {
    vec4 n = load(input_0, pixel.texel);
    Reflectance surface = reflectance(vec3(1.0), 0.5, n.w);
    return vec4(reflected(surface, n.xyz, load(input_1, pixel.texel).xyz, load(input_2, pixel.texel).xyz), 1.0);
}
)",
                                                    inputs);
    for (std::size_t i = 0; i < device.size(); ++i) {
        EXPECT_TRUE(device[i].x >= 0 && device[i].x < 1e6F) << i << ": " << device[i].x;
        if (inputs[2][i].y <= 0) {
            EXPECT_EQ(device[i].x, 0) << i;
        }
    }
}

TEST(RenderGpuBrdf, SurroundingsAgreeWithTheReference) {
    test::Directions random(3);
    std::vector<std::vector<vec4>> inputs(4);
    std::vector<dvec3> truth;
    for (int i = 0; i < 1024; ++i) {
        const auto number = [&] { return static_cast<float>(random.number()); };
        inputs[0].emplace_back(number(), number(), number(), number());
        inputs[1].emplace_back(number(), number(), number(), 0.9F * number());
        inputs[2].emplace_back(number(), number(), number(), 0.1F * number());
        inputs[3].emplace_back(number(), 0, 0, 0);
        truth.push_back(reference::reflected_surroundings(
            reference::reflectance(dvec3(inputs[0].back()), inputs[0].back().w, inputs[3].back().x),
            dvec3(inputs[1].back()), dvec3(inputs[2].back()), dvec2(inputs[1].back().w, inputs[2].back().w)));
    }
    const std::vector<vec4> device = test::evaluate("surroundings", test::brdf_shader() + R"(
vec4 shade(Pixel pixel) {
    vec4 color = load(input_0, pixel.texel);
    vec4 irradiance = load(input_1, pixel.texel);
    vec4 reflection = load(input_2, pixel.texel);
    Reflectance surface = reflectance(color.rgb, color.a, load(input_3, pixel.texel).x);
    return vec4(reflected_surroundings(surface, irradiance.rgb, reflection.rgb,
                                       vec2(irradiance.a, reflection.a)), 1.0);
}
)",
                                                    inputs);
    // A dozen operations of single precision.
    test::expect_close(device, truth, 2e-6, 1e-6);
}

}  // namespace
}  // namespace darkroom::render
