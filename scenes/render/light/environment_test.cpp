// SPDX-License-Identifier: MIT
#include "render/light/environment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

#include "image/frame/frame_file.hpp"

namespace darkroom::render {
namespace {

using scene::vec2;
using scene::vec3;

constexpr double pi = std::numbers::pi;

Picture make_sky(std::uint32_t width, const std::function<vec3(vec3)>& light) {
    Picture sky(width, width / 2);
    for (std::uint32_t y = 0; y < sky.height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const vec3 color =
                light(uv_to_direction({(static_cast<float>(x) + 0.5F) / static_cast<float>(width),
                                       (static_cast<float>(y) + 0.5F) / static_cast<float>(sky.height)}));
            for (int channel = 0; channel < 3; ++channel) sky.at(x, y)[channel] = color[channel];
            sky.at(x, y)[3] = 1;
        }
    }
    return sky;
}

vec3 pixel(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    const float* const at = picture.at(x, y);
    return {at[0], at[1], at[2]};
}

/// The sum of the harmonics, as shaders/light/environment.glsl has it.
vec3 irradiance(const std::array<vec3, 9>& c, vec3 n) {
    return c[0] * 0.282095F + (c[1] * n.y + c[2] * n.z + c[3] * n.x) * 0.488603F +
           (c[4] * n.x * n.y + c[5] * n.y * n.z + c[7] * n.x * n.z) * 1.092548F +
           c[6] * 0.315392F * (3 * n.z * n.z - 1) + c[8] * 0.546274F * (n.x * n.x - n.y * n.y);
}

const std::array directions{vec3(1, 0, 0),
                            vec3(0, 1, 0),
                            vec3(0, 0, 1),
                            vec3(-1, 0, 0),
                            vec3(0, -1, 0),
                            vec3(0, 0, -1),
                            glm::normalize(vec3(1, 2, -3))};

/// Calls body(direction, solid angle) for a grid over the sphere.
void over_sphere(std::uint32_t rows, const std::function<void(vec3, double)>& body) {
    for (std::uint32_t y = 0; y < rows; ++y) {
        const double v = (y + 0.5) / rows;
        for (std::uint32_t x = 0; x < 2 * rows; ++x) {
            const double u = (x + 0.5) / (2 * rows);
            body(uv_to_direction({static_cast<float>(u), static_cast<float>(v)}),
                 std::sin(v * pi) * pi * pi / rows / rows);
        }
    }
}

TEST(RenderEnvironment, DirectionsFollowTheTable) {
    EXPECT_NEAR(direction_to_uv({0, 0, -1}).x, 0.5, 1e-6);
    EXPECT_NEAR(direction_to_uv({1, 0, 0}).x, 0.75, 1e-6);
    EXPECT_NEAR(direction_to_uv({-1, 0, 0}).x, 0.25, 1e-6);
    EXPECT_NEAR(std::abs(direction_to_uv({0, 0, 1}).x - 0.5), 0.5, 1e-6);
    EXPECT_NEAR(direction_to_uv({0, 1, 0}).y, 0, 1e-6);
    EXPECT_NEAR(direction_to_uv({0, -1, 0}).y, 1, 1e-6);
    EXPECT_NEAR(direction_to_uv({0, 0, -1}).y, 0.5, 1e-6);
}

TEST(RenderEnvironment, UvToDirectionInvertsTheTable) {
    for (float u = 0.01F; u < 1; u += 0.07F) {
        for (float v = 0.01F; v < 1; v += 0.07F) {
            const vec3 direction = uv_to_direction({u, v});
            EXPECT_NEAR(glm::length(direction), 1, 1e-6);
            const vec2 back = direction_to_uv(direction);
            EXPECT_NEAR(back.x, u, 2e-5) << u << " " << v;
            EXPECT_NEAR(back.y, v, 2e-5) << u << " " << v;
        }
    }
}

// OpenEXR's own convention has +z in the middle of the picture and +x at its left: ours, turned by half a circle and
// not mirrored. The file draws an axis from each face's centre toward the next one's, and one upward.
TEST(RenderEnvironment, LabelsOfALatLongFileReadTheRightWayRound) {
    const char* const data = std::getenv("DARKROOM_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
    const Result<FrameFile> file = read_frame(std::filesystem::path(data) / "env/OrientationLatLong.exr");
    ASSERT_TRUE(file) << file.error().text;
    const auto is_dark = [&](vec3 in_file) {
        const vec2 uv = direction_to_uv(glm::normalize(vec3(-in_file.x, in_file.y, -in_file.z)));
        float least = 1;
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx) {
                const int x = static_cast<int>(uv.x * static_cast<float>(file->color.width)) + dx;
                const int y = static_cast<int>(uv.y * static_cast<float>(file->color.height)) + dy;
                least = std::min(least, pixel(file->color, static_cast<std::uint32_t>(x) % file->color.width,
                                              static_cast<std::uint32_t>(y))
                                            .g);
            }
        return least < 0.2F;
    };
    EXPECT_TRUE(is_dark({1, 0, 0.25F})) << "the z axis on face +x";
    EXPECT_FALSE(is_dark({1, 0, -0.25F}));
    EXPECT_TRUE(is_dark({0.25F, 0, 1})) << "the x axis on face +z";
    EXPECT_FALSE(is_dark({-0.25F, 0, 1}));
    EXPECT_TRUE(is_dark({-1, 0, 0.25F})) << "the z axis on face -x";
    EXPECT_FALSE(is_dark({-1, 0, -0.25F}));
    EXPECT_TRUE(is_dark({1, 0.15F, 0})) << "the y axis on face +x";
    EXPECT_FALSE(is_dark({1, -0.25F, 0}));
}

TEST(RenderEnvironment, ConstantSkyHasConstantIrradiance) {
    const std::array<vec3, 9> harmonics = irradiance_harmonics(make_sky(10, [](vec3) { return vec3(3, 0.5F, 7000); }));
    for (const vec3& n : directions) {
        const vec3 light = irradiance(harmonics, n);
        EXPECT_NEAR(light.r, 3, 3e-6);
        EXPECT_NEAR(light.g, 0.5, 1e-6);
        EXPECT_NEAR(light.b, 7000, 7e-3);
    }
}

TEST(RenderEnvironment, ResamplingKeepsTheLightOfTheSphere) {
    Picture sky(30, 14);
    for (std::size_t i = 0; i < sky.pixels.size(); ++i) sky.pixels[i] = static_cast<float>((i * 7919) % 101);
    const auto total = [](const Picture& picture) {
        double sum = 0;
        for (std::uint32_t y = 0; y < picture.height; ++y) {
            const double band = std::cos(y * pi / picture.height) - std::cos((y + 1) * pi / picture.height);
            for (std::uint32_t x = 0; x < picture.width; ++x) sum += picture.at(x, y)[1] * band / picture.width;
        }
        return sum;
    };
    for (const auto& [width, height] : {std::pair{7U, 5U}, {1U, 1U}, {30U, 14U}, {64U, 32U}})
        EXPECT_NEAR(total(resampled(sky, width, height)), total(sky), 1e-4) << width << "x" << height;
    EXPECT_EQ(resampled(sky, 30, 14), sky);
}

TEST(RenderEnvironment, PrefilteringKeepsAConstantSky) {
    const std::vector<Picture> levels = prefilter(make_sky(64, [](vec3) { return vec3(1, 200, 0.25F); }), 32, 5);
    ASSERT_EQ(levels.size(), 5U);
    for (std::size_t i = 0; i < levels.size(); ++i) {
        EXPECT_EQ(levels[i].width, 32U >> i);
        EXPECT_EQ(levels[i].height, std::max(1U, 16U >> i));
        for (std::uint32_t y = 0; y < levels[i].height; ++y)
            for (std::uint32_t x = 0; x < levels[i].width; ++x) {
                EXPECT_NEAR(pixel(levels[i], x, y).r, 1, 1e-5) << i;
                EXPECT_NEAR(pixel(levels[i], x, y).g, 200, 2e-3) << i;
            }
    }
}

TEST(RenderEnvironment, ASmallSunBecomesASmoothLobeAroundItself) {
    Picture sky(256, 128);
    sky.at(100, 40)[0] = 60000;
    const std::vector<Picture> levels = prefilter(sky, 64, 6);
    for (std::size_t i = 1; i < levels.size(); ++i) {
        const Picture& level = levels[i];
        // Along its row, light falls with distance from the sun on both sides.
        const std::uint32_t row = 40 * level.height / 128, peak = 100 * level.width / 256;
        for (std::uint32_t step = 0; step + 1 < level.width / 2; ++step) {
            const auto at = [&](std::uint32_t offset) { return pixel(level, (peak + offset) % level.width, row).r; };
            EXPECT_GE(at(step) * 1.0001F, at(step + 1)) << i << " " << step;
            EXPECT_GE(at(level.width - step) * 1.0001F, at(level.width - step - 1)) << i << " " << step;
        }
        EXPECT_GT(pixel(level, peak, row).r, 0);
    }
}

TEST(RenderEnvironment, NoMoreLightLeavesAMirrorThanReachesIt) {
    const Picture table = split_sum_table(16);
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            const float white = table.at(x, y)[0] + table.at(x, y)[1];
            EXPECT_LE(white, 1.0005F) << x << " " << y;
            EXPECT_GE(white, y < 2 ? 0.95F : 0.3F) << x << " " << y;
            EXPECT_GE(table.at(x, y)[1], 0);
        }
    // Rougher surfaces lose more light to the second bounce.
    EXPECT_GT(table.at(8, 0)[0] + table.at(8, 0)[1], table.at(8, 15)[0] + table.at(8, 15)[1] + 0.05F);
    // Schlick at grazing angles: the bias grows where the view grazes.
    EXPECT_GT(table.at(0, 1)[1], table.at(15, 1)[1] + 0.5F);
}

// A sky of harmonics up to the second order is what the nine numbers hold exactly; the integral is done directly.
TEST(TruthEnvironment, IrradianceOfASmoothSkyIsItsIntegral) {
    const auto light = [](vec3 d) {
        return vec3(1 + d.x + 0.6F * d.x * d.z, 2 - 0.5F * d.y + d.z * d.z,
                    1 + d.x * d.y - 0.7F * d.y * d.z + 0.3F * d.x * d.x);
    };
    const std::array<vec3, 9> harmonics = irradiance_harmonics(make_sky(256, light));
    for (const vec3& n : directions) {
        glm::dvec3 sum(0);
        over_sphere(128, [&](vec3 d, double solid_angle) {
            sum += glm::dvec3(light(d)) * (std::max(0.0F, glm::dot(n, d)) * solid_angle / pi);
        });
        const vec3 found = irradiance(harmonics, n);
        for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(found[channel], sum[channel], 1e-3);
    }
}

TEST(TruthEnvironment, PrefilteredLevelsAreTheIntegralOfTheLobe) {
    const vec3 sun = glm::normalize(vec3(0.3F, 0.6F, -0.5F));
    const auto light = [&](vec3 d) {
        const float glow = std::exp(40 * (glm::dot(d, sun) - 1));
        return vec3(0.2F + 0.8F * std::max(0.0F, d.y), 50 * glow, std::sin(6 * d.x) + 1.5F);
    };
    constexpr std::uint32_t count = 5;
    const std::vector<Picture> levels = prefilter(make_sky(512, light), 64, count);
    for (std::uint32_t level = 1; level < count; ++level) {
        const double roughness = static_cast<double>(level) / (count - 1), a2 = std::pow(roughness, 4);
        const Picture& picture = levels[level];
        for (const auto& [x, y] : {std::pair{0U, 0U},
                                   {picture.width / 2, picture.height / 3},
                                   {picture.width - 1, picture.height / 2},
                                   {picture.width / 4, picture.height - 1}}) {
            const vec3 n = uv_to_direction({(static_cast<float>(x) + 0.5F) / static_cast<float>(picture.width),
                                            (static_cast<float>(y) + 0.5F) / static_cast<float>(picture.height)});
            glm::dvec3 sum(0);
            double weight = 0;
            over_sphere(256, [&](vec3 l, double solid_angle) {
                const double n_dot_l = glm::dot(n, l);
                if (n_dot_l <= 0) return;
                const double n_dot_h = glm::dot(n, glm::normalize(n + l));
                const double d = a2 / (pi * std::pow(n_dot_h * n_dot_h * (a2 - 1) + 1, 2));
                sum += glm::dvec3(light(l)) * (d * n_dot_l * solid_angle);
                weight += d * n_dot_l * solid_angle;
            });
            for (int channel = 0; channel < 3; ++channel) {
                const double expected = sum[channel] / weight;
                EXPECT_NEAR(pixel(picture, x, y)[channel], expected, 0.01 * expected + 2e-3)
                    << "level " << level << ", " << x << ", " << y << ", channel " << channel;
            }
        }
    }
}

// The hemisphere is integrated in the light's direction, the table in the half vector's.
TEST(TruthEnvironment, SplitSumTableIsTheIntegralOfTheBrdf) {
    constexpr std::uint32_t size = 8;
    const Picture table = split_sum_table(size);
    for (std::uint32_t y = 2; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; x += 2) {
            const double n_dot_v = (x + 0.5) / size, a2 = std::pow((y + 0.5) / size, 4);
            const glm::dvec3 v(std::sqrt(1 - n_dot_v * n_dot_v), n_dot_v, 0);
            double scale = 0, bias = 0;
            over_sphere(256, [&](vec3 direction, double solid_angle) {
                const glm::dvec3 l(direction), h = glm::normalize(v + l);
                if (l.y <= 0) return;
                const double d = a2 / (pi * std::pow(h.y * h.y * (a2 - 1) + 1, 2));
                const auto lambda = [&](double cosine) {
                    return (std::sqrt(1 + a2 * (1 - cosine * cosine) / (cosine * cosine)) - 1) / 2;
                };
                const double masking = 1 / (1 + lambda(l.y) + lambda(n_dot_v));
                const double specular = d * masking / (4 * l.y * n_dot_v) * l.y * solid_angle;
                const double fresnel = std::pow(1 - glm::dot(v, h), 5);
                scale += (1 - fresnel) * specular;
                bias += fresnel * specular;
            });
            EXPECT_NEAR(table.at(x, y)[0], scale, 0.01) << x << " " << y;
            EXPECT_NEAR(table.at(x, y)[1], bias, 0.01) << x << " " << y;
        }
    }
}

}  // namespace
}  // namespace darkroom::render
