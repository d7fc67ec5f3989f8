// SPDX-License-Identifier: MIT
#include "scene/pose/particles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

namespace darkroom::scene {

namespace {

const EmitterPath at_origin = [](double) { return mat4(1); };

/// Particles that fly straight and live for exactly `lifetime` seconds.
ParticleEmitter steady(float rate, float lifetime) {
    return {.emission_rate = rate,
            .max_particles = 10000,
            .lifetime_min = lifetime,
            .lifetime_max = lifetime,
            .gravity = vec3(0)};
}

ParticleEmitter burst(std::uint32_t count) {
    ParticleEmitter out = steady(0, 100);
    out.burst_count = count;
    return out;
}

std::vector<Particle> at(const ParticleEmitter& emitter, double time, std::uint64_t seed = 1) {
    return particles(emitter, at_origin, seed, time, time);
}

bool are_same(const std::vector<Particle>& a, const std::vector<Particle>& b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](const Particle& one, const Particle& other) {
               return one.position == other.position && one.previous_position == other.previous_position &&
                      one.size == other.size && one.color == other.color && one.uv == other.uv;
           });
}

}  // namespace

TEST(SceneParticles, AreBornAtTheirRate) {
    const ParticleEmitter emitter = steady(100, 2);
    EXPECT_EQ(at(emitter, 0).size(), 0U);
    EXPECT_EQ(at(emitter, 0.995).size(), 99U);
    EXPECT_EQ(at(emitter, 1.005).size(), 100U);
    EXPECT_EQ(at(emitter, 50.005).size(), 200U);  // the last two seconds
    EXPECT_EQ(at(emitter, 1e6 + 0.005).size(), 200U);
}

TEST(SceneParticles, LifetimesAreUniform) {
    ParticleEmitter emitter = steady(2000, 0);
    emitter.lifetime_min = 1;
    emitter.lifetime_max = 3;
    // In equilibrium there are rate * mean lifetime; the deviation of the count is below sqrt(rate).
    EXPECT_NEAR(static_cast<double>(at(emitter, 20).size()), 4000, 5 * std::sqrt(2000.0));
}

TEST(SceneParticles, EmitOnlyWhilePlaying) {
    ParticleEmitter emitter = steady(100, 2);
    emitter.autoplay = false;
    EXPECT_TRUE(at(emitter, 1).empty());
    emitter.is_playing = true;
    EXPECT_FALSE(at(emitter, 1).empty());
    EXPECT_TRUE(at(emitter, -1).empty());
    EXPECT_TRUE(at(emitter, std::nan("")).empty());
    EXPECT_TRUE(at(emitter, std::numeric_limits<double>::infinity()).empty());
}

TEST(SceneParticles, SpeedsAreUniformInsideTheCone) {
    ParticleEmitter emitter = burst(8000);
    emitter.speed_min = 2;
    emitter.speed_max = 4;
    emitter.direction = {0, 0, -5};
    emitter.spread = 20;
    double speed_sum = 0, height_sum = 0;
    vec3 mean(0);
    const double least_height = std::cos(glm::radians(20.0));
    for (const Particle& particle : at(emitter, 1)) {
        const double speed = static_cast<double>(glm::length(particle.position));
        const double height = -static_cast<double>(particle.position.z) / speed;
        EXPECT_GE(speed, 2 - 1e-5);
        EXPECT_LE(speed, 4 + 1e-5);
        EXPECT_GE(height, least_height - 1e-6);
        speed_sum += speed;
        height_sum += height;
        mean += particle.position / 8000.0F;
    }
    EXPECT_NEAR(speed_sum / 8000, 3, 0.03);                         // 5 deviations of the mean: 0.032
    EXPECT_NEAR(height_sum / 8000, (1 + least_height) / 2, 0.001);  // uniform on the cap
    EXPECT_NEAR(mean.x, 0, 0.04);
    EXPECT_NEAR(mean.y, 0, 0.04);
}

// The same motion in 100,000 steps of the midpoint rule.
TEST(SceneParticles, FallAsTheIntegratedMotion) {
    for (const float damping : {0.0F, 1e-4F, 0.7F, 5.0F}) {
        ParticleEmitter emitter = burst(1);
        emitter.spread = 0;
        emitter.direction = {1, 1, 0};
        emitter.speed_min = emitter.speed_max = 6;
        emitter.gravity = {0, -9.81F, 0.5F};
        emitter.damping = damping;
        glm::dvec3 position(0), velocity = glm::normalize(glm::dvec3(1, 1, 0)) * 6.0;
        const glm::dvec3 gravity(emitter.gravity);
        constexpr int steps = 100000;
        constexpr double step = 3.0 / steps;
        for (int i = 0; i < steps; ++i) {
            const glm::dvec3 middle = velocity + (gravity - static_cast<double>(damping) * velocity) * (step / 2);
            position += middle * step;
            velocity += (gravity - static_cast<double>(damping) * middle) * step;
        }
        const std::vector<Particle> found = at(emitter, 3);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_LT(glm::length(glm::dvec3(found[0].position) - position), 1e-4) << "damping " << damping;
    }
}

TEST(SceneParticles, ShapesHoldTheirVolume) {
    ParticleEmitter emitter = burst(8000);
    emitter.speed_min = emitter.speed_max = 0;
    emitter.shape_radius = 2;
    emitter.shape_extents = {1, 2, 3};
    emitter.shape = EmitterShape::Sphere;
    int inner = 0;
    for (const Particle& particle : at(emitter, 1)) {
        EXPECT_LE(glm::length(particle.position), 2.0001F);
        inner += glm::length(particle.position) < 1 ? 1 : 0;
    }
    EXPECT_NEAR(inner, 1000, 150);  // an eighth of the volume
    emitter.shape = EmitterShape::Box;
    vec3 farthest(0);
    for (const Particle& particle : at(emitter, 1)) farthest = glm::max(farthest, glm::abs(particle.position));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(farthest[axis], emitter.shape_extents[axis]);
        EXPECT_GE(farthest[axis], emitter.shape_extents[axis] * 0.99F);
    }
    emitter.shape = EmitterShape::Point;
    EXPECT_EQ(at(emitter, 1)[17].position, vec3(0));
}

TEST(SceneParticles, ConesWidenFromTheirDisc) {
    ParticleEmitter emitter = burst(4000);
    emitter.shape = EmitterShape::Cone;
    emitter.shape_radius = 2;
    emitter.shape_angle = 40;
    emitter.spread = 0;
    emitter.speed_min = emitter.speed_max = 3;
    const std::vector<Particle> born = at(emitter, 0), later = at(emitter, 1);
    int inner = 0;
    float widest = 0;
    for (std::size_t i = 0; i < born.size(); ++i) {
        const vec3 from = born[i].position, way = later[i].position - from;
        const float part = glm::length(from) / 2;
        EXPECT_NEAR(from.y, 0, 1e-6F);
        EXPECT_LE(part, 1.0001F);
        inner += part < 0.5F ? 1 : 0;
        const float angle = glm::degrees(std::acos(std::min(way.y / 3, 1.0F)));
        EXPECT_NEAR(angle, 40 * part, 0.05F);
        if (part > 0.01F) {
            EXPECT_GT(glm::dot(from, way), 0);
        }
        widest = std::max(widest, angle);
    }
    EXPECT_NEAR(inner, 1000, 150);  // a quarter of the disc
    EXPECT_GT(widest, 39);
    emitter.spread = 10;
    widest = 0;
    const std::vector<Particle> spread = at(emitter, 1);
    for (std::size_t i = 0; i < born.size(); ++i)
        widest = std::max(widest, glm::degrees(std::acos((spread[i].position - born[i].position).y / 3)));
    EXPECT_GT(widest, 45);
    EXPECT_LE(widest, 50.1F);
}

TEST(SceneParticles, BurstOnceACycle) {
    ParticleEmitter emitter = burst(10);
    emitter.lifetime_min = emitter.lifetime_max = 0.5F;
    EXPECT_EQ(at(emitter, 0).size(), 10U);
    EXPECT_EQ(at(emitter, 2.1).size(), 0U) << "without a duration there is one cycle";
    emitter.duration = 2;
    EXPECT_EQ(at(emitter, 0).size(), 10U);
    EXPECT_EQ(at(emitter, 1).size(), 0U);
    EXPECT_EQ(at(emitter, 2).size(), 10U);
    EXPECT_EQ(at(emitter, 4.25).size(), 10U);
    EXPECT_FALSE(are_same(at(emitter, 0), at(emitter, 2)) && are_same(at(emitter, 0.25), at(emitter, 2.25)));
    emitter.is_looping = false;
    EXPECT_EQ(at(emitter, 2).size(), 0U);
}

TEST(SceneParticles, StopAfterTheirDuration) {
    ParticleEmitter emitter = steady(10, 100);
    emitter.duration = 2;
    EXPECT_EQ(at(emitter, 90).size(), 900U);
    emitter.is_looping = false;
    EXPECT_EQ(at(emitter, 90).size(), 20U);
    EXPECT_EQ(at(emitter, 101).size(), 10U);
    EXPECT_EQ(at(emitter, 103).size(), 0U);
}

TEST(SceneParticles, SkipBirthsWhileFull) {
    ParticleEmitter emitter = steady(100, 1);
    emitter.max_particles = 30;
    emitter.speed_min = emitter.speed_max = 1;
    emitter.spread = 0;
    // Births 1 to 30, at 0.01 to 0.30, fill it; those after are skipped until the first dies, at 1.01.
    EXPECT_EQ(at(emitter, 0.205).size(), 20U);
    EXPECT_EQ(at(emitter, 0.9).size(), 30U);
    EXPECT_NEAR(at(emitter, 0.9).back().position.y, 0.6F, 1e-5F);
    const std::vector<Particle> refilled = at(emitter, 1.105);
    EXPECT_EQ(refilled.size(), 30U);
    EXPECT_NEAR(refilled.back().position.y, 0.005F, 1e-5F);
    EXPECT_NEAR(refilled.front().position.y, 0.995F, 1e-5F);
    emitter.max_particles = 0;
    EXPECT_TRUE(at(emitter, 1).empty());
}

TEST(SceneParticles, AFullEmitterKeepsItsHistory) {
    ParticleEmitter emitter = steady(400, 1);
    emitter.lifetime_min = 0.5F;
    emitter.lifetime_max = 2;
    emitter.max_particles = 50;
    std::size_t kept = 0, total = 0;
    for (double time = 3; time < 5; time += 0.01) {
        const std::vector<Particle> now = particles(emitter, at_origin, 1, time, time - 0.01);
        EXPECT_LE(now.size(), 50U);
        EXPECT_GE(now.size(), 45U) << "a place is free for 2.5 ms at most";
        for (const Particle& particle : now) kept += particle.position != particle.previous_position ? 1 : 0;
        total += now.size();
    }
    // One of 125 dies in 10 ms and makes room for another.
    EXPECT_GT(static_cast<double>(kept) / static_cast<double>(total), 0.98);
    const std::vector<Particle> before = at(emitter, 10);
    const std::vector<Particle> after = particles(emitter, at_origin, 1, 10.001, 10);
    std::size_t found = 0;
    for (const Particle& particle : after)
        found += std::any_of(before.begin(), before.end(),
                             [&](const Particle& other) { return other.position == particle.previous_position; })
                     ? 1
                     : 0;
    EXPECT_GE(found, 45U) << "living particles stay themselves";
}

TEST(SceneParticles, AreTheSameInAnyOrder) {
    ParticleEmitter emitter = steady(300, 1);
    emitter.lifetime_max = 3;
    emitter.max_particles = 200;
    emitter.burst_count = 40;
    emitter.duration = 0.7F;
    const std::vector<Particle> first = at(emitter, 5), second = at(emitter, 2);
    EXPECT_TRUE(are_same(second, at(emitter, 2)));
    EXPECT_TRUE(are_same(first, at(emitter, 5)));
    EXPECT_FALSE(are_same(first, at(emitter, 5, 2))) << "another seed";
}

TEST(SceneParticles, MoveOnByTheirOwnPath) {
    const ParticleEmitter emitter = steady(50, 2);
    const std::vector<Particle> now = particles(emitter, at_origin, 1, 4, 3.9), before = at(emitter, 3.9);
    // The oldest 5 have died since, as many were born and did not move.
    ASSERT_EQ(now.size(), before.size());
    for (std::size_t i = 0; i + 5 < now.size(); ++i) EXPECT_EQ(now[i].previous_position, before[i + 5].position);
    EXPECT_EQ(now.back().previous_position, now.back().position);
}

TEST(SceneParticles, StayBehindInWorldSpaceAlone) {
    ParticleEmitter emitter = steady(10, 1);
    emitter.speed_min = emitter.speed_max = 0;
    const EmitterPath path = [](double time) { return glm::translate(mat4(1), vec3(static_cast<float>(time), 0, 0)); };
    const std::vector<Particle> behind = particles(emitter, path, 1, 5.05, 5.05);
    ASSERT_EQ(behind.size(), 10U);
    for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(behind[i].position.x, 4.1F + 0.1F * static_cast<float>(i), 1e-5F);
    for (const Particle& particle : particles(emitter, path, 1, 5.05, 5.0))
        EXPECT_EQ(particle.previous_position, particle.position) << "nobody moves it";
    emitter.is_world_space = false;
    std::size_t moved = 0;
    for (const Particle& particle : particles(emitter, path, 1, 5.05, 5.0)) {
        EXPECT_NEAR(particle.position.x, 5.05F, 1e-5F);
        if (particle.position == particle.previous_position) continue;
        EXPECT_NEAR(particle.previous_position.x, 5, 1e-5F);
        ++moved;
    }
    EXPECT_GE(moved, 9U) << "all but the one that may be born at 5 s";
}

TEST(SceneParticles, TurnWithTheEmitterButFallDown) {
    ParticleEmitter emitter = burst(1);
    emitter.spread = 0;
    emitter.speed_min = emitter.speed_max = 2;
    emitter.gravity = {0, -2, 0};
    const mat4 world = glm::scale(glm::rotate(mat4(1), -glm::half_pi<float>(), vec3(0, 0, 1)), vec3(3));
    for (const bool is_world_space : {true, false}) {
        emitter.is_world_space = is_world_space;
        const std::vector<Particle> found = particles(
            emitter, [&](double) { return world; }, 1, 1, 1);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_LT(glm::length(found[0].position - vec3(2, -1, 0)), 1e-5F);
    }
}

TEST(SceneParticles, AgeInSizeColorAndFrame) {
    ParticleEmitter emitter = burst(1);
    emitter.lifetime_min = emitter.lifetime_max = 4;
    emitter.size_start = 1;
    emitter.size_end = 3;
    emitter.color_start = {1, 0, 0, 1};
    emitter.color_end = {0, 1, 0, 0};
    emitter.frames_x = 4;
    emitter.frames_y = 2;
    Particle particle = at(emitter, 2.6).at(0);
    EXPECT_NEAR(particle.size, 2.3F, 1e-6F);
    EXPECT_LT(glm::length(particle.color - vec4(0.35F, 0.65F, 0, 0.35F)), 1e-6F);
    EXPECT_EQ(particle.uv, vec4(0, 0, 0.25F, 0.5F));
    emitter.animates_frames = true;
    particle = at(emitter, 2.6).at(0);  // 0.65 of 8 frames: number 5, second row
    EXPECT_EQ(particle.uv, vec4(0.25F, 0.5F, 0.5F, 1));
    EXPECT_EQ(at(emitter, 3.999).at(0).uv, vec4(0.75F, 0.5F, 1, 1));
}

// Whatever is asked for, an answer comes soon; under a sanitizer as well.
TEST(SceneParticles, NoTimeOrRateTakesLong) {
    const std::clock_t begin = std::clock();
    std::vector<ParticleEmitter> emitters(7, steady(10000, 1));
    emitters[1].lifetime_min = 0;
    emitters[1].lifetime_max = 1e9F;
    emitters[2].max_particles = 3;
    emitters[2].lifetime_min = emitters[2].lifetime_max = 1e-12F;
    emitters[3].burst_count = 4000000000;
    emitters[3].duration = 1e-30F;
    emitters[4] = emitters[3];
    emitters[4].lifetime_min = 0;
    emitters[4].lifetime_max = 1e-12F;
    emitters[5].lifetime_min = emitters[5].lifetime_max = 0;
    emitters[5].burst_count = 4000000000;
    emitters[6].emission_rate = 1e30F;
    emitters[6].lifetime_min = 0;
    for (const ParticleEmitter& emitter : emitters)
        for (const double time : {1e3, 1e6}) EXPECT_LE(at(emitter, time).size(), emitter.max_particles);
    EXPECT_LT((std::clock() - begin) / CLOCKS_PER_SEC, 10);
}

}  // namespace darkroom::scene
