// SPDX-License-Identifier: MIT
#pragma once
// For tests only: five scenes of boxes and spheres that a lens of f/2 is hard put to, each lit by a sun and the sky.

#include <cmath>
#include <string>
#include <utility>

#include "render/renderer_test_support.hpp"

namespace darkroom::test {

struct LensScene {
    std::string name;
    float focus_distance = 0;  ///< metres
    scene::Snapshot snapshot;
};

/// One model: a sphere of radius 1.
inline scene::Assets lens_scene_assets() {
    constexpr std::uint32_t around = 48, down = 24;
    scene::Primitive sphere;
    for (std::uint32_t j = 0; j <= down; ++j)
        for (std::uint32_t i = 0; i <= around; ++i) {
            const float turn = 6.2831853F * static_cast<float>(i) / around,
                        tilt = 3.1415927F * static_cast<float>(j) / down;
            const scene::vec3 at(std::sin(tilt) * std::cos(turn), std::cos(tilt), -std::sin(tilt) * std::sin(turn));
            sphere.vertices.push_back({.position = at, .normal = at});
        }
    for (std::uint32_t j = 0; j < down; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t a = j * (around + 1) + i, b = a + around + 1;
            sphere.indices.insert(sphere.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    scene::Assets assets;
    assets.models.resize(1);
    assets.models[0].meshes.push_back({.primitives = {sphere}});
    return assets;
}

/// Makes snapshots: the camera stands 1.5 m over the ground and looks along -z with a 30 degree field of view.
class LensSceneMaker {
  public:
    LensSceneMaker(std::string name, float focus_distance, float aspect) {
        out_.name = std::move(name);
        out_.focus_distance = focus_distance;
        scene::CameraState& camera = out_.snapshot.camera;
        camera.projection = glm::perspective(glm::radians(30.0F), aspect, 200.0F, 0.1F);
        camera.projection[1] *= -1.0F;
        camera.previous_projection = camera.projection;
        camera.near_distance = 0.1F;
        camera.far_distance = 200;
        camera.field_of_view = 30;
        out_.snapshot.lights.push_back({.light = {.color = {1, 0.94F, 0.82F}, .intensity = 2.2F, .casts_shadow = false},
                                        .name = "sun",
                                        .direction = glm::normalize(scene::vec3(0.5F, 0.8F, 0.6F))});
    }
    LensSceneMaker& box(scene::vec3 low, scene::vec3 high, scene::vec3 color) {
        render::test::add_box(out_.snapshot, low, high, surface(color));
        return *this;
    }
    LensSceneMaker& ball(scene::vec3 center, float radius, scene::vec3 color, scene::vec3 emissive = scene::vec3(0)) {
        scene::SnapshotMaterial material = surface(color);
        material.surface.emissive = emissive;
        scene::Instance& added = render::test::add_box(out_.snapshot, center - radius, center + radius, material);
        added.mesh = {0, 0, 0};
        added.world = added.previous_world = glm::scale(glm::translate(scene::mat4(1), center), scene::vec3(radius));
        return *this;
    }
    /// Bricks of many colours, across the view.
    LensSceneMaker& bricks(scene::vec3 low, scene::vec3 high, int across, int up, scene::vec3 color) {
        const scene::vec3 step = (high - low) / scene::vec3(across, up, 1);
        for (int j = 0; j < up; ++j)
            for (int i = 0; i < across; ++i) {
                const scene::vec3 at = low + step * scene::vec3(i, j, 0);
                box(at, at + scene::vec3(step.x * 0.96F, step.y * 0.94F, high.z - low.z), color * shade());
            }
        return *this;
    }
    LensSceneMaker& floor(float from, float to, float half_width, float tile) {
        int row = 0;
        for (float z = from; z < to; z += tile, ++row)
            for (int i = 0; static_cast<float>(i) * tile < 2 * half_width; ++i) {
                const float x = static_cast<float>(i) * tile - half_width;
                box({x, -1.6F, -z - tile}, {x + tile, -1.5F, -z},
                    scene::vec3((i + row) % 2 == 0 ? 0.6F : 0.2F) * shade());
            }
        return *this;
    }
    [[nodiscard]] LensScene done() { return std::move(out_); }

  private:
    static scene::SnapshotMaterial surface(scene::vec3 color) {
        scene::SnapshotMaterial out;
        out.surface.base_color = scene::vec4(color, 1);
        out.surface.metallic = 0;
        out.surface.roughness = 0.7F;
        return out;
    }
    /// Of bricks and tiles, the same in every run.
    scene::vec3 shade() {
        const auto next = [this] {
            random_ = random_ * 1664525 + 1013904223;
            return 0.4F + 0.9F * static_cast<float>(random_ >> 8) / 16777216;
        };
        const float grey = next();
        return {grey * (0.8F + 0.2F * next()), grey * (0.8F + 0.2F * next()), grey * (0.8F + 0.2F * next())};
    }

    LensScene out_;
    std::uint32_t random_ = 7;
};

inline LensScene street_of_columns(float aspect) {
    LensSceneMaker maker("street of columns", 3.5F, aspect);
    maker.floor(1, 20, 3, 1).bricks({-4, -1.5F, -21}, {4, 2.5F, -20.5F}, 14, 12, {0.7F, 0.4F, 0.3F});
    for (int i = 0; i < 7; ++i) {
        const float z = -1.7F - 1.9F * static_cast<float>(i);
        for (const float side : {-1.0F, 1.0F}) {
            const float x = side * (0.75F + 0.08F * static_cast<float>(i));
            maker.box({x - 0.12F, -1.5F, z - 0.24F}, {x + 0.12F, 1.6F, z}, {0.75F, 0.72F, 0.65F});
            for (int band = 0; band < 6; ++band) {
                const float y = -1.2F + 0.4F * static_cast<float>(band);
                maker.box({x - 0.14F, y, z - 0.26F}, {x + 0.14F, y + 0.06F, z + 0.02F},
                          {0.3F, 0.1F + 0.1F * static_cast<float>(band), 0.5F});
            }
        }
    }
    return maker.done();
}

inline LensScene post_before_a_wall(float aspect) {
    LensSceneMaker maker("post before a far wall", 2.5F, aspect);
    maker.floor(2, 12, 4, 1).bricks({-5, -1.5F, -12.5F}, {5, 3, -12}, 18, 14, {0.8F, 0.8F, 0.7F});
    maker.box({-0.15F, -1.5F, -2.6F}, {0.05F, 1.2F, -2.4F}, {0.7F, 0.1F, 0.08F});
    for (int band = 0; band < 8; ++band) {
        const float y = -0.6F + 0.17F * static_cast<float>(band);
        maker.box({-0.16F, y, -2.61F}, {0.06F, y + 0.05F, -2.39F}, scene::vec3(0.9F));
    }
    return maker.box({0.3F, -1.5F, -2.55F}, {0.33F, 0.4F, -2.5F}, {0.1F, 0.3F, 0.8F}).done();
}

inline LensScene near_fence(float aspect) {
    LensSceneMaker maker("near fence", 4, aspect);
    maker.floor(2, 12, 4, 1).bricks({-3, -1.5F, -7}, {3, 2.5F, -6.5F}, 12, 12, {0.5F, 0.7F, 0.5F});
    maker.bricks({-0.6F, -0.8F, -4.3F}, {0.6F, 0.5F, -4}, 8, 10, {0.9F, 0.7F, 0.3F});
    for (int i = -4; i <= 4; ++i) {
        const float at = 0.11F * static_cast<float>(i);
        maker.box({at - 0.008F, -0.5F, -1.01F}, {at + 0.008F, 0.5F, -1}, {0.15F, 0.15F, 0.17F});
    }
    for (const float y : {-0.17F, 0.12F})
        maker.box({-0.7F, y, -1.02F}, {0.7F, y + 0.018F, -1.01F}, {0.4F, 0.25F, 0.15F});
    return maker.done();
}

inline LensScene balls_with_highlights(float aspect) {
    LensSceneMaker maker("balls with highlights", 3, aspect);
    maker.floor(1.5F, 14, 5, 1).bricks({-5, -1.5F, -14.5F}, {5, 3, -14}, 12, 10, {0.25F, 0.3F, 0.45F});
    for (int i = 0; i < 7; ++i) {
        const float z = -1.6F - 0.9F * static_cast<float>(i),
                    x = 0.22F * static_cast<float>((i * 5) % 7 - 3) * -z / 2.5F;
        const scene::vec3 center(x, -0.35F + 0.1F * static_cast<float>(i % 3), z);
        maker.ball(center, 0.22F, {0.2F + 0.1F * static_cast<float>(i), 0.5F, 0.9F - 0.1F * static_cast<float>(i)});
        maker.ball(center + scene::vec3(0.09F, 0.12F, 0.19F), 0.012F, scene::vec3(0), scene::vec3(40));
    }
    for (int i = 0; i < 14; ++i) {
        const float t = static_cast<float>(i);
        maker.ball({-3 + 0.45F * t, 0.9F + 0.5F * std::sin(2.3F * t), -11 - std::cos(t)}, 0.03F, scene::vec3(0),
                   i % 2 == 0 ? scene::vec3(40, 24, 10) : scene::vec3(12, 20, 40));
    }
    return maker.done();
}

inline LensScene figure_in_a_room(float aspect) {
    LensSceneMaker maker("figure", 2.5F, aspect);
    maker.floor(1.5F, 8, 3, 0.8F).bricks({-3, -1.5F, -8.2F}, {3, 2.5F, -8}, 10, 12, {0.8F, 0.65F, 0.5F});
    const scene::vec3 skin(0.8F, 0.55F, 0.42F), cloth(0.15F, 0.25F, 0.5F);
    maker.ball({0.05F, 0.42F, -2.5F}, 0.13F, skin).ball({0.05F, 0.47F, -2.53F}, 0.135F, {0.15F, 0.08F, 0.05F});
    for (const float side : {-1.0F, 1.0F})
        maker.ball({0.05F + side * 0.045F, 0.44F, -2.38F}, 0.018F, scene::vec3(0.05F));
    maker.box({-0.13F, -0.35F, -2.62F}, {0.23F, 0.26F, -2.42F}, cloth)
        .box({0, 0.24F, -2.56F}, {0.1F, 0.34F, -2.46F}, skin);
    // One arm toward the camera, one away from it.
    for (int i = 0; i < 12; ++i) {
        const float t = static_cast<float>(i) / 11;
        maker.ball({-0.18F - 0.2F * t, 0.2F - 0.25F * t, -2.5F + 0.9F * t}, 0.055F - 0.015F * t, i < 8 ? cloth : skin);
        maker.ball({0.28F + 0.15F * t, 0.2F - 0.3F * t, -2.5F - 0.5F * t}, 0.055F - 0.015F * t, i < 8 ? cloth : skin);
    }
    maker.box({0.9F, -1.5F, -5}, {1.5F, 0.1F, -4.4F}, {0.5F, 0.3F, 0.2F})
        .ball({1.2F, 0.35F, -4.7F}, 0.25F, {0.2F, 0.6F, 0.2F});
    return maker.box({-0.75F, -0.5F, -1.2F}, {-0.5F, -0.2F, -1.1F}, {0.6F, 0.2F, 0.2F}).done();
}

}  // namespace darkroom::test
