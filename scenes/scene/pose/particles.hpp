// SPDX-License-Identifier: MIT
#pragma once
// The particles of an emitter at a time, in closed form: nothing is stepped, so any time can be asked for in any order,
// and the same emitter, seed and time always give the same particles. Births are at k / emission_rate, k = 1, 2, ...;
// a burst is at the start and, if the emitter loops, at every multiple of its duration. While max_particles are alive
// births are skipped; an emitter that does so restarts its history after some 100,000 births, so that no time takes
// long.

#include <cstdint>
#include <functional>

#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {

/// Where the emitter is at a time. Particles in world space keep the matrix of their birth, others follow the emitter.
/// Gravity is a direction of the world for both; scale moves where particles are born, not how fast they fly.
using EmitterPath = std::function<mat4(double time)>;

/// Of one emitter, whatever its file says.
inline constexpr std::uint32_t max_particles = 10000;

/// `previous_time` gives Particle::previous_position of those that were alive then; others did not move.
[[nodiscard]] std::vector<Particle> particles(const ParticleEmitter& emitter, const EmitterPath& path,
                                              std::uint64_t seed, double time, double previous_time);

}  // namespace darkroom::scene
