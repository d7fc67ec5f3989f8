// SPDX-License-Identifier: MIT
#include "render/shadow/cascades.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace darkroom::render {

namespace {

using scene::mat4;
using scene::vec2;
using scene::vec3;
using scene::vec4;

/// Clip space with y down and reversed depth, as cameras of scenes have it.
mat4 picture_projection(mat4 projection) {
    mat4 turn(1);
    turn[1][1] = -1;
    turn[2][2] = -1;
    turn[3][2] = 1;
    return turn * projection;
}

struct Lens {
    float field_of_view = 45, aspect = 16.0F / 9, near = 0.1F, far = 1000;
};

scene::CameraState perspective(const mat4& view, const Lens& lens) {
    return {.view = view,
            .projection = picture_projection(
                glm::perspective(glm::radians(lens.field_of_view), lens.aspect, lens.near, lens.far)),
            .position = vec3(glm::inverse(view)[3]),
            .field_of_view = lens.field_of_view,
            .near_distance = lens.near,
            .far_distance = lens.far};
}

scene::CameraState orthographic(const mat4& view, float height, float aspect, float near, float far) {
    const float half = height / 2;
    return {.view = view,
            .projection = picture_projection(glm::ortho(-half * aspect, half * aspect, -half, half, near, far)),
            .kind = scene::Projection::Orthographic,
            .near_distance = near,
            .far_distance = far};
}

class Random {
  public:
    float in(float low, float high) { return std::uniform_real_distribution(low, high)(engine_); }
    vec3 direction() {
        for (;;) {
            const vec3 v(in(-1, 1), in(-1, 1), in(-1, 1));
            if (const float length = glm::length(v); length > 0.1F && length <= 1) return v / length;
        }
    }
    mat4 view() {
        const vec3 eye(in(-300, 300), in(-50, 50), in(-300, 300));
        const vec3 forward = direction();
        const vec3 up = std::abs(forward.y) > 0.99F ? vec3(1, 0, 0) : vec3(0, 1, 0);
        return glm::lookAt(eye, eye + forward, up);
    }

  private:
    std::mt19937 engine_{7};
};

/// A point of the view at a distance along the axis; x, y in [-1, 1] across the picture.
vec3 view_point(const scene::CameraState& camera, float x, float y, float distance) {
    const vec4 clip = camera.projection * vec4(0, 0, -distance, 1);
    const vec4 point = glm::inverse(camera.projection * camera.view) * vec4(x * clip.w, y * clip.w, clip.z, clip.w);
    return vec3(point) / point.w;
}

vec3 row(const mat4& matrix, int number) { return glm::transpose(matrix)[number]; }

/// In texels of the map, and depth.
vec3 map_place(const Cascades& cascades, std::uint32_t cascade, vec3 world, std::uint32_t resolution) {
    const vec4 place = cascades.world_to_cascade[cascade] * vec4(world, 1);
    return {vec2(place.x * 0.5F + 0.5F, place.y * 0.5F + 0.5F) * static_cast<float>(resolution), place.z};
}

void expect_inside(const scene::CameraState& camera, vec3 light, const CascadeDesc& desc, Random& random) {
    const Cascades cascades = fit_cascades(camera, light, desc);
    const auto resolution = static_cast<float>(desc.resolution);
    for (std::uint32_t i = 0; i < cascades.count; ++i) {
        const float before = i < 2 ? camera.near_distance : cascades.splits[i - 2];
        const float start =
            i == 0 ? camera.near_distance : cascades.splits[i - 1] - cascade_blend * (cascades.splits[i - 1] - before);
        ASSERT_GT(cascades.splits[i], start);
        for (int sample = 0; sample < 24; ++sample) {
            const bool is_corner = sample < 8;
            const float x = is_corner ? ((sample & 1) != 0 ? 1.0F : -1.0F) : random.in(-1, 1);
            const float y = is_corner ? ((sample & 2) != 0 ? 1.0F : -1.0F) : random.in(-1, 1);
            const float part = is_corner ? static_cast<float>(sample >> 2) : random.in(0, 1);
            const vec3 point = view_point(camera, x, y, start + (cascades.splits[i] - start) * part);
            const vec3 place = map_place(cascades, i, point, desc.resolution);
            // Four texels for the filter and for what moves receivers; arithmetic may take a hundredth.
            ASSERT_GE(place.x, 4.0F - 0.01F) << i;
            ASSERT_LE(place.x, resolution - 4.0F + 0.01F) << i;
            ASSERT_GE(place.y, 4.0F - 0.01F) << i;
            ASSERT_LE(place.y, resolution - 4.0F + 0.01F) << i;
            ASSERT_GE(place.z, 0) << i;
            ASSERT_LE(place.z, 1) << i;
        }
    }
}

}  // namespace

TEST(RenderCascades, SplitsAreThePublishedOnes) {
    const auto splits = practical_splits(0.1F, 200, 0.5F, 3);
    EXPECT_NEAR(splits[0], 33.997F, 0.0005F);
    EXPECT_NEAR(splits[1], 74.620F, 0.0005F);
    EXPECT_EQ(splits[2], 200);
    EXPECT_EQ(splits[3], 0);
    const auto uniform = practical_splits(1, 9, 0, 4);
    EXPECT_EQ(uniform, (std::array<float, 4>{3, 5, 7, 9}));
    const auto logarithmic = practical_splits(1, 16, 1, 4);
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_NEAR(logarithmic[i], std::exp2(static_cast<float>(i + 1)), 1e-5F);
    EXPECT_EQ(practical_splits(0.1F, 50, 0.5F, 1)[0], 50);
}

TEST(RenderCascades, SplitsOfTheCameraItself) {
    const mat4 view = glm::lookAt(vec3(1, 2, 3), vec3(0), vec3(0, 1, 0));
    const Cascades far_camera = fit_cascades(perspective(view, {}), glm::normalize(vec3(1, 2, 3)), {});
    EXPECT_EQ(far_camera.count, 3U);
    EXPECT_NEAR(far_camera.splits[0], 33.997F, 0.0005F);
    EXPECT_EQ(far_camera.splits[2], 200) << "shadows end before the camera's view does";
    const Cascades near_camera = fit_cascades(perspective(view, {.far = 40}), vec3(0, 1, 0), {});
    EXPECT_EQ(near_camera.splits[2], 40) << "the camera's view ends before shadows do";
    const Cascades beyond = fit_cascades(perspective(view, {.near = 300}), vec3(0, 1, 0), {});
    EXPECT_GT(beyond.splits[2], 300);
    for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(beyond.world_to_cascade[i][3][2]));
}

TEST(RenderCascades, SlicesAreInside) {
    Random random;
    for (int round = 0; round < 200; ++round) {
        const CascadeDesc desc{.count = 1U + round % 4,
                               .resolution = 256U << (round % 4),
                               .split_lambda = random.in(0, 1),
                               .far_distance = random.in(5, 300)};
        const Lens lens{.field_of_view = random.in(5, 120),
                        .aspect = std::exp(random.in(-1.5F, 1.5F)),
                        .near = random.in(0.01F, 2),
                        .far = random.in(20, 2000)};
        expect_inside(perspective(random.view(), lens), random.direction(), desc, random);
        const float height = random.in(0.5F, 100);
        expect_inside(orthographic(random.view(), height, lens.aspect, random.in(-5, 5), lens.far), random.direction(),
                      desc, random);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
}

TEST(RenderCascades, VerticalLight) {
    Random random;
    for (const vec3& light : {vec3(0, 1, 0), vec3(0, -1, 0), glm::normalize(vec3(1e-4F, 1, -1e-4F)),
                              glm::normalize(vec3(0.14F, 1, 0.0F)), glm::normalize(vec3(0.15F, 1, 0.0F))}) {
        const scene::CameraState camera = perspective(random.view(), {});
        expect_inside(camera, light, {}, random);
        // The three axes stay at right angles, and depth falls toward the light.
        const mat4 matrix = fit_cascades(camera, light, {}).world_to_cascade[0];
        const scene::mat3 axes = glm::transpose(scene::mat3(matrix));
        EXPECT_NEAR(glm::dot(glm::normalize(axes[0]), glm::normalize(axes[1])), 0, 1e-6F);
        EXPECT_NEAR(glm::dot(glm::normalize(axes[2]), light), -1, 1e-6F);
        EXPECT_GT(glm::dot(glm::cross(axes[0], axes[1]), axes[2]), 0) << "y goes down: front faces keep their side";
    }
}

TEST(RenderCascades, SplitsEndWhereTheSceneDoes) {
    const scene::CameraState camera = perspective(glm::lookAt(vec3(0, 2, 0), vec3(0, 2, -1), vec3(0, 1, 0)), {});
    const auto end = [&](vec3 low, vec3 high) {
        return fit_cascades(camera, vec3(0, 1, 0), {}, {.bounds = {low, high}}).splits[2];
    };
    EXPECT_EQ(end(vec3(-1, 0, -8), vec3(1, 4, 3)), 8) << "what is behind the camera does not count";
    EXPECT_FLOAT_EQ(end(vec3(-1, 0, -8.1F), vec3(1, 4, 3)), 8 * std::sqrt(2.0F)) << "in coarse steps";
    EXPECT_EQ(end(vec3(-300), vec3(300)), 200);
    EXPECT_LT(end(vec3(500, 0, -8), vec3(501, 4, 100)), 1) << "nothing is in view";
    EXPECT_NEAR(farthest_in_view(camera, {vec3(-1, 0, -8.1F), vec3(1, 4, 3)}), 8.1, 1e-5);
    const std::array splits = practical_splits(0.1F, 8, 0.5F, 3);
    EXPECT_EQ(fit_cascades(camera, vec3(0, 1, 0), {}, {.bounds = {vec3(-1, 0, -8), vec3(1, 4, 3)}}).splits, splits);
}

TEST(RenderCascades, FarthestInViewIsThatOfPointsOfTheBox) {
    Random random;
    for (int round = 0; round < 100; ++round) {
        const scene::CameraState camera = perspective(random.view(), {.field_of_view = random.in(20, 100)});
        scene::Box box;
        box.add(camera.position + vec3(random.in(-20, 20), random.in(-20, 20), random.in(-20, 20)));
        box.add(camera.position + vec3(random.in(-20, 20), random.in(-20, 20), random.in(-20, 20)));
        const auto found = static_cast<float>(farthest_in_view(camera, box));
        float truth = 0;
        int seen = 0;
        for (int sample = 0; sample < 20000; ++sample) {
            const vec3 part(random.in(0, 1), random.in(0, 1), random.in(0, 1));
            const vec4 clip = camera.projection * camera.view * vec4(glm::mix(box.low, box.high, part), 1);
            if (std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) continue;
            truth = std::max(truth, clip.w);
            ++seen;
        }
        EXPECT_GE(found * 1.0001F, truth) << round;
        // Of a sliver in view hardly one sample tells.
        if (seen < 20) continue;
        EXPECT_LE(found, truth + 5) << round << ": samples miss corners, but not by much";
    }
}

TEST(RenderCascades, DepthReachesBehindTheView) {
    Random random;
    const scene::Box bounds{vec3(-60, -4, -60), vec3(60, 45, 60)};
    for (int round = 0; round < 100; ++round) {
        const vec3 eye(random.in(-30, 30), random.in(0, 20), random.in(-30, 30));
        const mat4 view = glm::lookAt(eye, eye + random.direction(), vec3(0.01F, 1, 0.02F));
        const vec3 light = random.direction();
        for (const bool holds_casters : {false, true}) {
            const scene::CameraState camera = perspective(view, {});
            const Cascades cascades = fit_cascades(camera, light, {}, {bounds, holds_casters});
            for (std::uint32_t i = 0; i < 3; ++i) {
                for (int sample = 0; sample < 24; ++sample) {
                    const vec3 part(random.in(0, 1), random.in(0, 1), random.in(0, 1));
                    const vec3 point = glm::mix(bounds.low, bounds.high, part);
                    const vec3 place = map_place(cascades, i, point, 2048);
                    if (holds_casters) {
                        EXPECT_GE(place.z, 0) << "the whole scene is within the range";
                    }
                    const vec4 clip = camera.projection * camera.view * vec4(point, 1);
                    const float before = i == 0 ? camera.near_distance : cascades.splits[i - 1];
                    const bool is_seen = std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.w >= before &&
                                         clip.w <= cascades.splits[i];
                    if (!is_seen) continue;
                    EXPECT_GT(place.z, 0);
                    EXPECT_LE(place.z, 1.0F + 1e-5F);
                    EXPECT_GE(std::min(place.x, place.y), 4 - 0.01F);
                    EXPECT_LE(std::max(place.x, place.y), 2044 + 0.01F);
                    EXPECT_LT(map_place(cascades, i, point + light * 10.0F, 2048).z, place.z);
                }
            }
        }
    }
}

TEST(RenderCascades, TexelsAndDepthsAreThoseOfTheScene) {
    const scene::CameraState camera = perspective(glm::lookAt(vec3(0, 2, 0), vec3(1, 2, 0), vec3(0, 1, 0)), {});
    const vec3 light = glm::normalize(vec3(0.4F, 0.6F, 0.05F));
    const Cascades room = fit_cascades(camera, light, {}, {.bounds = {vec3(-4, 0, -4), vec3(4, 3, 4)}});
    const Cascades all = fit_cascades(camera, light, {});
    EXPECT_LT(room.texel[0], all.texel[0] / 4);
    for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_LT(room.texel[i] * 2048, 16) << "a room of 8 m";
        EXPECT_LT(1 / glm::length(row(room.world_to_cascade[i], 2)), 16) << "metres of depth";
    }
}

TEST(RenderCascades, ResolutionIsThatOfTheTexels) {
    const scene::CameraState camera = perspective(glm::lookAt(vec3(3), vec3(0), vec3(0, 1, 0)), {});
    for (const std::uint32_t resolution : {64U, 1000U, 1024U, 2048U, 4096U}) {
        const Cascades cascades = fit_cascades(camera, vec3(0, 1, 0), {.resolution = resolution});
        for (std::uint32_t i = 0; i < 3; ++i) {
            const float across = 2 / glm::length(row(cascades.world_to_cascade[i], 0));
            EXPECT_NEAR(across / cascades.texel[i], static_cast<float>(resolution), 0.01F);
        }
    }
    for (const std::uint32_t resolution : {1U, 2U, 16U}) {
        const Cascades cascades = fit_cascades(camera, vec3(0, 1, 0), {.resolution = resolution});
        EXPECT_TRUE(std::isfinite(cascades.texel[0]));
        EXPECT_GT(cascades.texel[0], 0);
    }
}

TEST(RenderCascades, EdgesStandStill) {
    Random random;
    const CascadeDesc desc{.resolution = 1024};
    const vec3 light = random.direction();
    const vec3 still(12.3F, 1.7F, -45.6F);
    const Cascades first = fit_cascades(perspective(random.view(), {}), light, desc);
    for (int round = 0; round < 200; ++round) {
        const Cascades moved = fit_cascades(perspective(random.view(), {}), light, desc);
        for (std::uint32_t i = 0; i < 3; ++i) {
            ASSERT_EQ(moved.texel[i], first.texel[i]) << "turning and moving change no size";
            const vec3 before = map_place(first, i, still, desc.resolution);
            const vec3 after = map_place(moved, i, still, desc.resolution);
            const vec2 apart = vec2(after) - vec2(before);
            // Cameras are up to 600 m apart: what single precision leaves of a texel there.
            ASSERT_NEAR(apart.x, std::round(apart.x), 0.02F) << "cascade " << i << ", round " << round;
            ASSERT_NEAR(apart.y, std::round(apart.y), 0.02F) << "cascade " << i << ", round " << round;
        }
    }
}

TEST(RenderCascades, ZoomingChangesTexelsInSteps) {
    const mat4 view = glm::lookAt(vec3(3), vec3(0), vec3(0, 1, 0));
    float before = 0;
    int changes = 0;
    for (int step = 0; step < 200; ++step) {
        const Lens lens{.field_of_view = 45 + 0.01F * static_cast<float>(step)};
        const float texel = fit_cascades(perspective(view, lens), vec3(0, 1, 0), {}).texel[0];
        EXPECT_GE(texel, before);
        if (texel != before) ++changes;
        before = texel;
    }
    EXPECT_LE(changes, 4);
}

}  // namespace darkroom::render
