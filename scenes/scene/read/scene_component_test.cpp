// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "scene/read/scene_test_text.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene {
namespace {

TEST(SceneComponent, ReadsMaterials) {
    const Material material = *entity_of(R"(
[entities.a.material]
texture = "wood.png"
color = [0.5, 1, 0.25, 0.5]
metallic = 1
roughness = 0.25
opacity = 0.75
blend_mode = "additive"
emissive = [2, 1.8, 0.6]
emissive_strength = 4
alpha_cutoff = 0.25
write_mask = "alpha"
)")
                                   .material;
    EXPECT_EQ(material.texture, "wood.png");
    EXPECT_EQ(material.color, vec3(0.5F, 1, 0.25F));
    EXPECT_EQ(material.alpha, 0.5F);
    EXPECT_EQ(material.metallic, 1);
    EXPECT_EQ(material.roughness, 0.25F);
    EXPECT_EQ(material.opacity, 0.75F);
    EXPECT_EQ(material.blend, SurfaceBlend::Additive);
    EXPECT_EQ(material.emissive, vec3(2, 1.8F, 0.6F));
    EXPECT_EQ(material.emissive_strength, 4);
    EXPECT_EQ(material.alpha_cutoff, 0.25F);
    EXPECT_EQ(material.writes, Writes::Alpha);
    const Material none = *entity_of("[entities.a.material]\n").material;
    EXPECT_FALSE(none.color || none.metallic || none.roughness || none.blend || none.emissive || none.alpha);
}

TEST(SceneComponent, ReadsEveryBlendModeAndBaseColorAsColor) {
    for (const auto& [name, blend] :
         {std::pair{"opaque", SurfaceBlend::Opaque}, std::pair{"mask", SurfaceBlend::Mask},
          std::pair{"alpha", SurfaceBlend::Alpha}, std::pair{"multiply", SurfaceBlend::Multiply}}) {
        const Material material =
            *entity_of("[entities.a.material]\nbase_color = {r=1, g=0, b=0, a=0.5}\nblend_mode = \"" +
                       std::string(name) + "\"\n")
                 .material;
        EXPECT_EQ(material.blend, blend);
        EXPECT_EQ(material.color, vec3(1, 0, 0));
        EXPECT_EQ(material.alpha, 0.5F);
    }
}

TEST(SceneComponent, BaseColorsComeFromTheParents) {
    const Scene scene = scene_of(R"(
[entities.wheel]
parent = "kart"
[entities.wheel.model]
asset = "wheel"
[entities.wheel.material]
base_color_g = 0.5
[entities.team.material]
base_color_r = 1
base_color_g = 0
base_color_a = 0.25
[entities.kart]
parent = "team"
[entities.kart.model]
asset = "kart"
[entities.box]
parent = "team"
[entities.box.bounds]
min = [0, 0, 0]
max = [1, 1, 1]
)");
    const Material& wheel = *scene.entities[0].material;
    EXPECT_EQ(wheel.color, vec3(1, 0.5F, 1)) << "its own green, the team's red, and 1 where nobody says";
    EXPECT_EQ(wheel.alpha, 0.25F);
    EXPECT_EQ(scene.entities[2].material->color, vec3(1, 0, 1));
    EXPECT_FALSE(scene.entities[3].material) << "models only";
}

TEST(SceneComponent, ReadsModels) {
    const ModelReference model = *entity_of(R"(
[entities.a.model]
asset = "fox"
animation = "Run"
animated = false
animation_speed = 2
light_scale = 0.5
)")
                                      .model;
    EXPECT_EQ(model.asset, "fox");
    EXPECT_EQ(model.animation, "Run");
    EXPECT_FALSE(model.is_animated);
    EXPECT_EQ(model.animation_speed, 2);
    EXPECT_EQ(model.light_scale, 0.5F);
    EXPECT_EQ(entity_of("[entities.a.model]\nasset = \"fox\"\nanimation = 2\n").model->animation, "2");
}

TEST(SceneComponent, ReadsLights) {
    const Light light = *entity_of(R"(
[entities.a.light]
type = "spot"
color = [1, 0.5, 0]
intensity = 6
direction = [0, -2, 0]
radius = 4
inner_angle = 0.25
outer_angle = 1
casts_shadow = false
volumetric_intensity = 2
volumetric_color = { r = 1, g = 1, b = 0 }
)")
                             .light;
    EXPECT_EQ(light.type, LightType::Spot);
    EXPECT_EQ(light.color, vec3(1, 0.5F, 0));
    EXPECT_EQ(light.intensity, 6);
    EXPECT_EQ(light.direction, vec3(0, -2, 0));
    EXPECT_EQ(light.range, 4);
    EXPECT_EQ(light.inner_angle, 0.25F);
    EXPECT_EQ(light.outer_angle, 1);
    EXPECT_FALSE(light.casts_shadow);
    EXPECT_EQ(light.volumetric_intensity, 2);
    EXPECT_EQ(light.volumetric_color, vec3(1, 1, 0));
    const Light usual = *entity_of("[entities.a.light]\n").light;
    EXPECT_EQ(usual.type, LightType::Directional);
    EXPECT_EQ(usual.range, 10);
    EXPECT_EQ(usual.inner_angle, 0.3F);
    EXPECT_EQ(usual.outer_angle, 0.5F);
    EXPECT_FALSE(usual.volumetric_color);
    EXPECT_EQ(entity_of("[entities.a.light]\nrange = 3\n").light->range, 3);
}

TEST(SceneComponent, ReadsSprites) {
    const Sprite sprite = *entity_of(R"(
[entities.a.sprite]
texture = "tree.png"
width = 2
height = 3
frame = 5
frames_x = 3
frames_y = 2
anchor_y = 0.5
fullbright = true
visible = false
)")
                               .sprite;
    EXPECT_EQ(sprite.texture, "tree.png");
    EXPECT_EQ(sprite.width, 2);
    EXPECT_EQ(sprite.height, 3);
    EXPECT_EQ(sprite.frame, 5U);
    EXPECT_EQ(sprite.frames_x, 3U);
    EXPECT_EQ(sprite.frames_y, 2U);
    EXPECT_EQ(sprite.anchor_y, 0.5F);
    EXPECT_FALSE(sprite.is_visible);
}

TEST(SceneComponent, ReadsEveryFieldOfAnEmitter) {
    const ParticleEmitter emitter = *entity_of(R"(
[entities.a.particle_emitter]
emission_rate = 100
burst_count = 5
max_particles = 10000
lifetime_min = 0.5
lifetime_max = 3
speed_min = 2
speed_max = 4
direction = [1, 0, 0]
spread = 30
gravity = [0, 1, 0]
damping = 0.5
size_start = 1
size_end = 2
color_start = [1, 0.5, 0]
color_end = [1, 0, 0, 0.5]
texture = "smoke.png"
frames_x = 4
frames_y = 2
animate_frames = true
blend_mode = "additive"
shape = "cone"
shape_radius = 1
shape_angle = 45
shape_extents = [1, 2, 3]
world_space = false
duration = 4
looping = false
playing = true
autoplay = false
)")
                                         .emitter;
    EXPECT_EQ(emitter.emission_rate, 100);
    EXPECT_EQ(emitter.burst_count, 5U);
    EXPECT_EQ(emitter.max_particles, 10000U);
    EXPECT_EQ(emitter.lifetime_min, 0.5F);
    EXPECT_EQ(emitter.lifetime_max, 3);
    EXPECT_EQ(emitter.speed_min, 2);
    EXPECT_EQ(emitter.speed_max, 4);
    EXPECT_EQ(emitter.direction, vec3(1, 0, 0));
    EXPECT_EQ(emitter.spread, 30);
    EXPECT_EQ(emitter.gravity, vec3(0, 1, 0));
    EXPECT_EQ(emitter.damping, 0.5F);
    EXPECT_EQ(emitter.size_start, 1);
    EXPECT_EQ(emitter.size_end, 2);
    EXPECT_EQ(emitter.color_start, vec4(1, 0.5F, 0, 1));
    EXPECT_EQ(emitter.color_end, vec4(1, 0, 0, 0.5F));
    EXPECT_EQ(emitter.texture, "smoke.png");
    EXPECT_EQ(emitter.frames_x, 4U);
    EXPECT_EQ(emitter.frames_y, 2U);
    EXPECT_TRUE(emitter.animates_frames);
    EXPECT_EQ(emitter.blend, SurfaceBlend::Additive);
    EXPECT_EQ(emitter.shape, EmitterShape::Cone);
    EXPECT_EQ(emitter.shape_radius, 1);
    EXPECT_EQ(emitter.shape_angle, 45);
    EXPECT_EQ(emitter.shape_extents, vec3(1, 2, 3));
    EXPECT_FALSE(emitter.is_world_space);
    EXPECT_EQ(emitter.duration, 4);
    EXPECT_FALSE(emitter.is_looping);
    EXPECT_TRUE(emitter.is_playing);
    EXPECT_FALSE(emitter.autoplay);
}

TEST(SceneComponent, EmittersHaveTheDocumentedDefaults) {
    const ParticleEmitter emitter = *entity_of("[entities.a.particle_emitter]\n").emitter;
    EXPECT_EQ(emitter.emission_rate, 10);
    EXPECT_EQ(emitter.max_particles, 256U);
    EXPECT_EQ(emitter.gravity, vec3(0, -9.81F, 0));
    EXPECT_EQ(emitter.color_end, vec4(1, 1, 1, 0));
    EXPECT_TRUE(emitter.is_world_space && emitter.is_looping && emitter.autoplay);
    EXPECT_FALSE(emitter.is_playing);
}

}  // namespace
}  // namespace darkroom::scene
